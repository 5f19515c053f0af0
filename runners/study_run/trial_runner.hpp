#pragma once

#include <memory>
#include <stop_token>
#include <vector>

#include "analysis/measures/theory_prediction.hpp"
#include "core/batch/batch.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::study_run {

/// True if the trials with this index, of all points, keep their traces.
bool is_retained(const study::Study& study, std::int64_t index);

/// Runs trials of a study on one thread with its engine, and returns the data of the results file. Trials
/// with retained traces always run with the reference engine.
class TrialRunner {
 public:
  explicit TrialRunner(const study::Study& study);

  /// @returns one result per row, in order
  /// @throws trial::Interrupted if a stop is requested before the last trial ends
  std::vector<shards::TrialResult> run(layout::RowRange rows, const std::stop_token& stop = {});

  /// [point] what the criteria predict of the trials run so far.
  const std::vector<measures::TheoryPrediction>& predictions() const { return predictions_; }

 private:
  study::StudyTrial next_trial(std::int64_t row);
  std::vector<shards::TrialResult> run_in_lanes(layout::RowRange rows, const std::stop_token& stop);

  const study::Study* study_;
  std::unique_ptr<batch::BatchEngine> engine_;
  std::vector<measures::TheoryPrediction> predictions_;
};

}  // namespace zerocount::study_run
