#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/benchmarks/peer_agreement.hpp"
#include "tests/benchmarks/workloads.hpp"

namespace zerocount::testing {

/// An engine that simulates whole trials and is timed on one thread.
struct TimedEngine {
  std::string name;
  /// Simulates the trials of the workload, with all their measures. An engine that needs the study instead of
  /// the drawn parameters takes the study's first workload.trials.size() trials.
  std::function<void(const Workload&)> simulate;
  /// The samples of one trial by this engine, which are checked before it is timed; empty for the reference.
  TrialRecorder record;
  /// Number of times that `simulate` runs the trials of the workload. An engine that runs many trials at a
  /// time is timed with as many as a run gives it.
  int copies{1};
};

/// All engines that the program was built with, ours first. A new engine is one more entry in this list.
std::vector<TimedEngine> all_engines();

}  // namespace zerocount::testing
