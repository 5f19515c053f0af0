#pragma once

#include <memory>
#include <vector>

#include "core/batch/batch.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/shard.hpp"

namespace zerocount {

/// Runs trials of a study by its engine, on one thread, and keeps what the results file keeps of them. The
/// trials whose records the study retains are run by the reference engine in any case.
class TrialRunner {
 public:
  explicit TrialRunner(const Study& study);

  /// @returns one result a row, in order.
  std::vector<TrialResult> run(RowRange rows);

 private:
  std::vector<TrialResult> run_in_lanes(RowRange rows);

  const Study* study_;
  std::unique_ptr<BatchEngine> engine_;
};

}  // namespace zerocount
