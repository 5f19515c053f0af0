#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/benchmarks/peer_agreement.hpp"
#include "tests/benchmarks/workloads.hpp"

namespace zerocount::testing {

/// Something that simulates whole trials, to be timed on one thread.
struct TimedEngine {
  std::string name;
  /// Simulates the trials of the workload, with all their measures. Whoever needs the study instead of the
  /// drawn parameters takes its first workload.trials.size() trials.
  std::function<void(const Workload&)> simulate;
  /// The samples of one trial by this engine, which are checked before it is timed; empty for the reference.
  TrialRecorder record;
  /// How often `simulate` runs the trials of the workload: an engine that runs many at a time is timed with
  /// as many as a run gives it.
  int copies{1};
};

/// All engines that this was built with, ours first. Another one is one more entry here.
std::vector<TimedEngine> all_engines();

}  // namespace zerocount::testing
