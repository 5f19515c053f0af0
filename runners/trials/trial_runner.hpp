#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "analysis/trials/theory/theory_prediction.hpp"
#include "core/batch/batch.hpp"
#include "experiments/study/study_trial.hpp"
#include "experiments/study/trial_draws.hpp"
#include "results/layout/layout.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::trials {

/// Whether the trials with this number within their design point keep their traces (samples of the whole
/// trial).
bool is_retained(const study::Study& study, std::int64_t index);

/// Engine that runs the trials of the study, as the results file names it. It is the engine that the study
/// asks for. Exception: the reference engine, if the SIMD lanes of the batch engine cannot run any examined
/// trial. Up to 64 trials of each design point in each setting (condition at an age) are examined, some 4096
/// in all. If lanes can run some of these, the batch engine is used, which passes the other trials to the
/// reference engine.
study::Engine engine_that_runs(const study::Study& study);

/// Results of trials with consecutive rows (numbers in the study).
struct TrialBlock {
  /// Results of the trials, in ascending order of rows (numbers in the study).
  std::vector<shards::TrialResult> results;
  /// [design point, starting with that of the first trial] Predictions by theory, summed over the trials.
  std::vector<theory::PointPrediction> predictions;
};

/// Runs trials of a study on one thread with the engine of the study. Returns their data for the results
/// file. Trials with retained traces always run with the reference engine.
class TrialRunner {
 public:
  explicit TrialRunner(const study::Study& study);

  /// Runs the trials of the rows (numbers of trials in the study). If a stop is requested, it returns the
  /// trials before the first one that has not ended; there may be none.
  TrialBlock run_block(layout::RowRange rows, const std::stop_token& stop = {});
  /// Runs the trials of the rows (numbers of trials in the study), without predictions by theory.
  /// @throws trial::Interrupted if a stop is requested before the last trial ends
  std::vector<shards::TrialResult> run(layout::RowRange rows, const std::stop_token& stop = {});
  /// Runs the trials of any rows (numbers of trials in the study), without predictions by theory. The results
  /// have the order of `rows`.
  /// @throws trial::Interrupted if a stop is requested before the last trial ends
  std::vector<shards::TrialResult> run(std::span<const std::int64_t> rows, const std::stop_token& stop = {});

 private:
  using Drawn = std::function<void(std::int64_t row, const study::StudyTrial& trial)>;
  /// Draws the random parameters of the trial of a row into `trial`, then calls drawn(row, trial).
  void draw(std::int64_t row, const Drawn& drawn, study::StudyTrial& trial);
  /// Runs the trial number `result.row` with the reference engine, and sets the other members of `result`.
  void run_alone(shards::TrialResult& result, const Drawn& drawn, const std::stop_token& stop);
  /// Runs the trials of `results`, and sets all members of `results` but the rows, which must be set before.
  /// @throws trial::Interrupted if a stop is requested; then the trials that have not ended have no moves
  void run_results(std::vector<shards::TrialResult>& results, const std::stop_token& stop,
                   const Drawn& drawn);
  std::vector<theory::PointPrediction> predictions_of(std::span<const shards::TrialResult> results);
  void run_in_lanes(const std::stop_token& stop, const Drawn& drawn,
                    std::vector<shards::TrialResult>& results);

  const study::Study* study_;
  study::TrialDrawer drawer_;
  std::unique_ptr<batch::BatchEngine> engine_;
  /// [slot of the batch engine] Parameters of the trials that are running.
  std::vector<study::StudyTrial> drawn_;
};

}  // namespace zerocount::trials
