#pragma once

#include "experiments/study/study.hpp"

namespace zerocount::forecast {

/// Computing time of a study.
struct StudyCost {
  double samples{0.0};             ///< of all trials together
  double seconds_per_sample{0.0};  ///< of one core, measured on trials of the study
  int cores{1};                    ///< of this machine

  double seconds() const { return samples * seconds_per_sample / cores; }  ///< with all cores
};

/// Measures the cost of the batch engine on trials spread over the study, for about a twentieth of a second.
/// Trials are cut at 200 000 samples, or less if those would take longer.
StudyCost measure_cost(const study::Study& study);

}  // namespace zerocount::forecast
