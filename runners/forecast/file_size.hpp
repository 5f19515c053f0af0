#pragma once

#include <vector>

#include "experiments/study/study_fwd.hpp"
#include "results/shards/trial_result.hpp"

namespace zerocount::forecast {

/// Some trials of a study, from which its sizes are estimated.
struct TrialSample {
  std::vector<shards::TrialResult> trials;  ///< of several places, numbered from 0, without records
  std::vector<shards::TrialResult> traced;  ///< with records; empty where the study retains none
  /// Of one design point, numbered from 0; empty where every trial is kept.
  std::vector<shards::TrialResult> of_point;
  double kept{1.0};  ///< proportion of trials that the file keeps
};

/// Bytes of the results file.
double file_bytes(const study::Study& study, const TrialSample& sample);

}  // namespace zerocount::forecast
