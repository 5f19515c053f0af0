#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "analysis/theory/theory_prediction.hpp"
#include "core/batch/batch.hpp"
#include "experiments/study/study_trial.hpp"
#include "experiments/study/trial_draws.hpp"
#include "results/layout/layout.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::trials {

/// Whether the trials with this index keep their traces, at every point.
bool is_retained(const study::Study& study, std::int64_t index);

/// Engine that runs the trials of the study, as the results file names it. It is the engine that the study
/// asks for. Exception: the reference engine, if the lanes of the batch engine cannot run any examined trial.
/// Up to 64 trials of each design point in each setting are examined, some 4096 in all. If lanes can run
/// some of these, the batch engine is used, which passes the other trials to the reference engine.
study::Engine engine_that_runs(const study::Study& study);

/// Results of contiguous trials.
struct TrialBlock {
  std::vector<shards::TrialResult> results;          ///< Results in ascending order of rows.
  std::vector<theory::PointPrediction> predictions;  ///< [point, starting with the first trial's point]
};

/// Runs trials of a study on one thread with the engine of the study. Returns their data for the results
/// file. Trials with retained traces always run with the reference engine.
class TrialRunner {
 public:
  explicit TrialRunner(const study::Study& study);

  /// Runs the trials of the rows. If a stop is requested, it returns the trials before the first one that has
  /// not ended; there may be none.
  TrialBlock run_block(layout::RowRange rows, const std::stop_token& stop = {});
  /// Runs the trials of the rows, without predictions.
  /// @throws trial::Interrupted if a stop is requested before the last trial ends
  std::vector<shards::TrialResult> run(layout::RowRange rows, const std::stop_token& stop = {});
  /// Runs the trials of any rows, without predictions. The results have the order of `rows`.
  /// @throws trial::Interrupted if a stop is requested before the last trial ends
  std::vector<shards::TrialResult> run(std::span<const std::int64_t> rows, const std::stop_token& stop = {});

 private:
  using Drawn = std::function<void(std::int64_t row, const study::StudyTrial& trial)>;
  /// Draws the trial of a row into `trial`, then calls drawn(row, trial).
  void draw(std::int64_t row, const Drawn& drawn, study::StudyTrial& trial);
  /// Runs the trial of `result.row` with the reference engine.
  void run_alone(shards::TrialResult& result, const Drawn& drawn, const std::stop_token& stop);
  /// Runs the trials of `results`. Before the call, only the rows of the results are set.
  /// @throws trial::Interrupted if a stop is requested; then the trials that have not ended have no moves
  void run_results(std::vector<shards::TrialResult>& results, const std::stop_token& stop,
                   const Drawn& drawn);
  std::vector<theory::PointPrediction> predictions_of(std::span<const shards::TrialResult> results);
  void run_in_lanes(const std::stop_token& stop, const Drawn& drawn,
                    std::vector<shards::TrialResult>& results);

  const study::Study* study_;
  study::TrialDrawer drawer_;
  std::unique_ptr<batch::BatchEngine> engine_;
  std::vector<study::StudyTrial> drawn_;  ///< [slot of the batch engine] Trials that are running.
};

}  // namespace zerocount::trials
