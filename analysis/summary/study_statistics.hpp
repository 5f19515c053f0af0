#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "analysis/measures/point_accumulator.hpp"
#include "analysis/measures/point_statistics.hpp"
#include "analysis/measures/undecided_moves.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/point_sums.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/trial_columns.hpp"
#include "results/timeline/timeline.hpp"

namespace zerocount::summary {

/// All sums over trials of one design point. The sums of two ranges of trials that follow one another, added,
/// equal the sums of both to the bit (docs/scaling.md: up to how many trials).
class SummedPoint {
 public:
  /// @param study, table stay as long as this. @param first_trial index at the point of the first that is
  /// added
  SummedPoint(const study::Study& study, std::int64_t point, std::int64_t first_trial,
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
  measures::UndecidedSums undecided_;
  theory::PointPrediction prediction_;
};

/// The sums of a point of a file.
/// @throws Failure (bad_data) with file and point where they cannot be those of its trials
SummedPoint restored_point(const reading::ResultsFile& file, const study::Study& study, std::int64_t point);

/// The results that StudyAccumulator is to give for each point.
struct Wanted {
  bool statistics{true};    ///< false for a part of a study: a machine without a trial has none
  bool sums{false};         ///< in the form in which files keep them
  bool undecided{false};    ///< PointSummary::undecided of trials; some of them are drawn again
  bool predictions{false};  ///< of trials, which are drawn again
  double confidence{statistics::summary_confidence};  ///< of all bounds
  /// Bounds of means by resampling, which takes its time; its random numbers are those of the study's seed.
  bool bootstrap{false};
  std::int64_t first_point{0};            ///< the first that may have trials
  timeline::Timeline* timeline{nullptr};  ///< gets spans of the stages; null: none
};

/// A point when all its trials are added.
struct PointResults {
  measures::PointSummary statistics{};
  theory::PointPrediction prediction{};
  layout::PointSums sums{};
};

/// Computes the statistics of the points of a study. The trials come from one results file or several, in
/// order of rows: as rows of outcomes, or as the sums of a file that keeps statistics.
///
///     for each file, for each block of its trials
///       fetch its bytes; in parallel: decode them and sum its trials at each point
///       add the sums to those of the points in order
///       before the next point begins: take the statistics that follow from the sums of a point
///
/// Files are read once, in blocks. The memory does not grow with the number of trials (see PointAccumulator).
class StudyAccumulator {
 public:
  /// @param study stays as long as this. @param take is given the results of each point in order
  /// @throws Failure (bad_input) for a confidence outside (0, 1).
  StudyAccumulator(const study::Study& study, const Wanted& wanted, std::function<void(PointResults&&)> take);

  /// @param rows of the file, which follow those added before
  /// @throws Failure (bad_data) where the file contradicts itself; the message names the trial.
  void add(const reading::AllTrialsFile& file, layout::RowRange rows);
  /// Adds the trials of a point by their sums; they follow those added before.
  /// @throws Failure (bad_data) where the sums cannot be those of the trials
  void add(const reading::ResultsFile& file, std::int64_t point);
  void add(const reading::ResultsFile& file);  ///< all its points

  /// Completes the last point that has trials.
  /// @throws Failure (bad_data) where no statistics follow from the sums
  void finish();

 private:
  /// Adds the sums of a block of a file.
  void add(std::vector<SummedPoint>&& sums, const reading::AllTrialsFile& file);
  SummedPoint& point(std::int64_t number, const layout::MeasureTable& table);

  const study::Study& study_;
  Wanted wanted_;
  std::function<void(PointResults&&)> take_;
  std::int64_t next_point_;
  std::optional<SummedPoint> point_;  ///< the one before next_point_
};

/// @throws Failure (bad_data) unless the file holds all trials of its study
void require_all_trials(const reading::AllTrialsFile& file);

/// The statistics of every design point of a complete results file, [point].
/// @throws Failure (bad_data) where trials are missing or the file contradicts itself; the message names the
/// trial.
std::vector<measures::PointSummary> study_statistics(const reading::AllTrialsFile& file,
                                                     const study::Study& study, const Wanted& wanted = {});

/// The statistics of one of its design points, likewise.
measures::PointSummary point_statistics(const reading::AllTrialsFile& file, const study::Study& study,
                                        std::int64_t point, Wanted wanted);

}  // namespace zerocount::summary
