#pragma once

#include <memory>
#include <vector>

#include "core/batch/batch.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/shard.hpp"

namespace zerocount {

/// Runs trials of a study on one thread with its engine, and returns the data of the results file. Trials
/// with retained traces always run with the reference engine.
class TrialRunner {
 public:
  explicit TrialRunner(const Study& study);

  /// @returns one result per row, in order
  std::vector<TrialResult> run(RowRange rows);

 private:
  std::vector<TrialResult> run_in_lanes(RowRange rows);

  const Study* study_;
  std::unique_ptr<BatchEngine> engine_;
};

}  // namespace zerocount
