#pragma once

#include <string>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::testing {

/// Trials to be timed: the first ones of a study.
struct Workload {
  std::string name;                            ///< name of the workload: W1, W2, W3
  study::Study study;                          ///< study with one design point
  std::vector<trial::TrialParameters> trials;  ///< [trial] parameters, drawn beforehand
  double samples{0.0};                         ///< number of samples of all trials together
};

/// The study of the manifest experiments/<name>.yaml, with these overrides ("key=value").
study::Study workload_study(const std::string& name, const std::vector<std::string>& overrides = {});

/// The workloads W1, W2 and W3, from experiments/bench-transient.yaml, bench-creep.yaml and
/// bench-marginal.yaml. Each has enough trials that the slowest engine needs one or two seconds.
std::vector<Workload> all_workloads();

}  // namespace zerocount::testing
