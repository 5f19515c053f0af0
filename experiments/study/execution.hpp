#pragma once

#include <cstdint>

namespace zerocount::study {

/// The engine that runs the trials. Their results agree to the tolerances in core/batch/README.md, not
/// bitwise.
enum class Engine {
  batch,     ///< many trials at a time in SIMD lanes
  reference  ///< one after the other
};

/// Sequential stopping (`stop`): after each block of trials the study ends if the bounds of the success rate
/// are narrow enough at every point. The bounds are a confidence sequence, which allows repeated tests.
struct StoppingRule {
  double success_rate_halfwidth{
      0.1};                    ///< half-width of the bounds (see analysis/statistics/confidence_sequence.hpp)
  double confidence{0.95};     ///< of the bounds of one point
  std::int64_t block{1};       ///< trials per point between two tests
  std::int64_t min_trials{1};  ///< trials per point before the study may end
  std::int64_t max_trials{1};  ///< trials per point at which the study ends in any case
};

/// The trials that a results file keeps beside the statistics.
enum class Retention {
  trials,     ///< all
  failures,   ///< those that did not succeed in all their moves
  statistics  ///< none
};

}  // namespace zerocount::study
