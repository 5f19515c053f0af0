#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/controller_code/chain_program.hpp"

namespace zerocount::study_commands {

/// What single precision changes in the trials of a point.
struct PrecisionEffect {
  /// How the trials end with a controller in one precision.
  struct Ends {
    std::int64_t meeting{0};  ///< trials that meet the question of the study
    double median{0.0};       ///< of the time at which their slowest move has settled, s; infinite: never
    double p95{0.0};          ///< likewise
  };
  std::int64_t trials{0};
  std::int64_t judged_otherwise{0};  ///< trials that meet the question in one precision alone
  Ends single_precision, double_precision;
};

/// Simulates trials of the point with the controller in both precisions, the same machines and random numbers
/// in both:
///
///     for evenly spaced trials of the point, as many as some seconds of computing time allow:
///       run the trial with the program in double precision, and with that in single precision
///
/// @throws trial::Interrupted
PrecisionEffect effect_of_single_precision(const study::Study& study, std::int64_t point,
                                           const controller_code::ControllerToWrite& chain,
                                           const std::stop_token& stop);

/// "of 500 trials 499 meet the goal (in double precision 500), …", in lines.
std::vector<std::string> precision_lines(const PrecisionEffect& effect, const study::Study& study);

}  // namespace zerocount::study_commands
