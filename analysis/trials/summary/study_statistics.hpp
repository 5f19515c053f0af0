#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "analysis/trials/measures/point_accumulator.hpp"
#include "analysis/trials/measures/point_statistics.hpp"
#include "analysis/trials/measures/undecided_moves.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/point_sums.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/trial_columns.hpp"
#include "results/timeline/timeline.hpp"

namespace zerocount::summary {

/// All sums over the trials of one design point. Adding the sums of two consecutive ranges of trials gives
/// the sums of the joint range, equal to the bit (docs/scaling.md: up to how many trials).
class SummedPoint {
 public:
  /// @param study, table must outlive this object.
  /// @param point index of the design point
  /// @param first_trial index at the point of the first trial that is added
  SummedPoint(const study::Study& study, std::int64_t point, std::int64_t first_trial,
              const layout::MeasureTable& table);
  /// Sums for a design point without a given table: all measures of this program version are summed.
  SummedPoint(const study::Study& study, std::int64_t point, std::int64_t first_trial);

  std::int64_t point() const { return point_; }

  /// Adds the next trials, without the predictions of the stability criteria.
  /// @throws Failure (bad_data) as PointAccumulator::add does
  void add(std::span<const shards::TrialResult> trials);
  void add(const theory::PointPrediction& prediction) { prediction_ = prediction_ + prediction; }
  /// The accumulator of the trials; trials that are added through it are added without their undecided moves,
  /// see add_undecided().
  measures::PointAccumulator& trials() { return trials_; }
  /// Counts the undecided moves of trials (moves whose end within the hold does not tell success from
  /// failure).
  /// @param rows global rows of the trials in the study
  /// @param moves [trial, move]
  void add_undecided(layout::RowRange rows, std::span<const trial::MoveOutcome> moves);
  SummedPoint& operator+=(const SummedPoint& next);

  layout::PointSums sums() const;
  /// Replaces all sums by stored ones.
  /// @throws Failure (bad_data) if the sums are impossible for this point
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

/// The sums of a design point, read from a file that keeps sums.
/// @throws Failure (bad_data), naming file and point, if the sums are impossible for the trials of the point
SummedPoint restored_point(const reading::ResultsFile& file, const study::Study& study, std::int64_t point);

/// The results that StudyAccumulator computes for each point.
struct Wanted {
  /// Compute statistics; false for a part of a study, where machines may lack trials.
  bool statistics{true};
  bool sums{false};  ///< Return the sums too, in the form in which files keep them.
  bool undecided{
      false};  ///< PointSummary::undecided: why trials are undecided. Draws their parameters again.
  /// Predict stability by the paper's criteria; the parameters of the trials are drawn again for it.
  bool predictions{false};
  double confidence{statistics::summary_confidence};  ///< Confidence of all bounds.
  /// Compute bounds of means by resampling, which is slow. The random numbers follow from the seed of the
  /// study.
  bool bootstrap{false};
  std::int64_t first_point{0};  ///< Index of the first design point that may have trials.
  /// Measures that are summed from rows of outcomes; they outlive the results. Null: all measures of the
  /// file.
  const layout::MeasureTable* measures{nullptr};
  timeline::Timeline* timeline{nullptr};  ///< Receives spans of the stages; may be null.
  std::stop_token stop{};                 ///< Interrupts the work when a stop is requested.
};

/// The results of a design point, after all its trials were added.
struct PointResults {
  measures::PointSummary statistics{};
  theory::PointPrediction prediction{};
  layout::PointSums sums{};
};

/// Computes the statistics of the points of a study. The trials come from one results file or several, in
/// order of rows: as rows of outcomes, or as the sums of a file that keeps statistics.
///
///     for each file, for each block of trials
///       fetch the bytes of the block; in parallel: decode them and sum the trials at each point
///       add the sums to those of the points, in order
///       before the next point begins: compute the statistics of the complete point and pass them to `take`
///
/// Files are read once, in blocks. The memory does not grow with the number of trials (see PointAccumulator).
class StudyAccumulator {
 public:
  /// @param study must outlive this object.
  /// @param take receives the results of each point, in order of points
  /// @throws Failure (bad_input) for a confidence outside (0, 1).
  StudyAccumulator(const study::Study& study, const Wanted& wanted, std::function<void(PointResults&&)> take);

  /// Adds trials of a file.
  /// @param rows global rows, which follow those added before
  /// @throws Failure (bad_data) if the file contradicts itself; the message names the trial. Failure
  /// (interrupted) if Wanted::stop requests it; so do the functions below.
  void add(const reading::AllTrialsFile& file, layout::RowRange rows);
  /// Adds the trials of a point by their sums. The trials follow those added before.
  /// @throws Failure (bad_data) if the sums are impossible for the trials
  void add(const reading::ResultsFile& file, std::int64_t point);
  void add(const reading::ResultsFile& file);  ///< Adds all points of a file that keeps sums.

  /// Completes the last design point that has trials, and passes its results on.
  /// @throws Failure (bad_data) if the sums allow no statistics
  void finish();

 private:
  /// Adds the sums of a block of a file.
  void add(std::vector<SummedPoint>&& sums, const reading::AllTrialsFile& file);
  SummedPoint& point(std::int64_t number, const layout::MeasureTable& table);

  const study::Study& study_;
  Wanted wanted_;
  std::function<void(PointResults&&)> take_;
  std::int64_t next_point_;
  /// Sums of the point that is not complete yet; its index is next_point_ − 1. Empty: there is none.
  std::optional<SummedPoint> point_;
};

/// Checks that a file is complete.
/// @throws Failure (bad_data) unless it holds all trials of its study
void require_all_trials(const reading::AllTrialsFile& file);

/// The statistics of every design point of a complete results file, [point].
/// @throws Failure (bad_data) if trials are missing or the file contradicts itself; the message names the
/// trial.
std::vector<measures::PointSummary> study_statistics(const reading::AllTrialsFile& file,
                                                     const study::Study& study, const Wanted& wanted = {});

/// The statistics of one design point of a complete results file.
/// @throws Failure as study_statistics()
measures::PointSummary point_statistics(const reading::AllTrialsFile& file, const study::Study& study,
                                        std::int64_t point, Wanted wanted);

}  // namespace zerocount::summary
