#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/measures/point_accumulator.hpp"
#include "analysis/summary/undecided.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/point_sums.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/trial_result.hpp"

namespace zerocount::summary {

/// All sums over trials of one design point. The sums of two ranges of trials that follow one another, added,
/// equal the sums of both to the bit (docs/scaling.md: up to how many trials).
class SummedPoint {
 public:
  /// @param study, table stay as long as this. @param first_trial index at the point of the first that is
  /// added. @param version of the layout of the file that has the trials
  SummedPoint(const study::Study& study, std::int64_t point, std::int64_t first_trial, std::int64_t version,
              const layout::MeasureTable& table);
  /// For trials with the measures of this program.
  SummedPoint(const study::Study& study, std::int64_t point, std::int64_t first_trial);

  std::int64_t point() const { return point_; }

  /// Adds the next trials, but for what the criteria predict of them.
  /// @throws Failure (bad_data) as PointAccumulator::add does
  void add(std::span<const shards::TrialResult> trials);
  void add(const theory::PointPrediction& prediction) { prediction_ = prediction_ + prediction; }
  /// Adds the trials without what is undecided of their moves: see add_undecided().
  measures::PointAccumulator& trials() { return trials_; }
  /// @param rows of the study. @param moves [trial, move]
  void add_undecided(layout::RowRange rows, std::span<const trial::MoveOutcome> moves);
  SummedPoint& operator+=(const SummedPoint& next);

  layout::PointSums sums() const;
  /// @throws Failure (bad_data) if these cannot be the sums of trials of this point
  void restore(const layout::PointSums& sums);

  measures::PointSummary statistics(double confidence, bool bootstrap) const;
  const theory::PointPrediction& prediction() const { return prediction_; }
  std::int64_t failures() const { return trials_.failures(); }

 private:
  const study::Study* study_;
  std::int64_t point_;
  measures::PointAccumulator trials_;
  UndecidedSums undecided_;
  theory::PointPrediction prediction_;
};

/// The sums of a point of a file.
/// @throws Failure (bad_data) with file and point where they cannot be those of its trials
SummedPoint restored_point(const reading::ResultsFile& file, const study::Study& study, std::int64_t point);

}  // namespace zerocount::summary
