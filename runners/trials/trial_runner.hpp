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

/// True if the trials with this index, of all points, keep their traces.
bool is_retained(const study::Study& study, std::int64_t index);

/// The engine that runs the trials of the study, as its file names it: the one asked for; the reference also
/// if the lanes of the batch engine lack a feature of each examined trial: up to 64 of each design point
/// under each condition, some 4096 in all. If lanes can run some of them, it is the batch engine, which
/// passes the other trials to the reference.
study::Engine engine_that_runs(const study::Study& study);

/// Trials that follow one another.
struct TrialBlock {
  std::vector<shards::TrialResult> results;          ///< in order of rows
  std::vector<theory::PointPrediction> predictions;  ///< [point, from that of the first trial]
};

/// Runs trials of a study on one thread with its engine, and returns the data of the results file. Trials
/// with retained traces always run with the reference engine.
class TrialRunner {
 public:
  explicit TrialRunner(const study::Study& study);

  /// The trials of the rows. If a stop is requested, it returns those before the first one that has not
  /// ended, which may be none.
  TrialBlock run_block(layout::RowRange rows, const std::stop_token& stop = {});
  /// The results alone. @throws trial::Interrupted if a stop is requested before the last trial ends
  std::vector<shards::TrialResult> run(layout::RowRange rows, const std::stop_token& stop = {});
  /// Those of any rows, in their order.
  std::vector<shards::TrialResult> run(std::span<const std::int64_t> rows, const std::stop_token& stop = {});

 private:
  using Drawn = std::function<void(std::int64_t row, const study::StudyTrial& trial)>;
  /// Makes `trial` that of the row, and calls drawn(row, trial).
  void draw(std::int64_t row, const Drawn& drawn, study::StudyTrial& trial);
  void run_alone(shards::TrialResult& result, const Drawn& drawn, const std::stop_token& stop);
  /// Runs the trials of `results`, which have their rows alone.
  /// @throws trial::Interrupted if a stop is requested; then the trials that have not ended have no moves
  void run_results(std::vector<shards::TrialResult>& results, const std::stop_token& stop,
                   const Drawn& drawn);
  std::vector<theory::PointPrediction> predictions_of(std::span<const shards::TrialResult> results);
  void run_in_lanes(const std::stop_token& stop, const Drawn& drawn,
                    std::vector<shards::TrialResult>& results);

  const study::Study* study_;
  study::TrialDrawer drawer_;
  std::unique_ptr<batch::BatchEngine> engine_;
  std::vector<study::StudyTrial> drawn_;  ///< [slot] trials in work
};

}  // namespace zerocount::trials
