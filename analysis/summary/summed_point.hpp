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

namespace zerocount::summary {

/// All sums over trials of one design point. The sums of two ranges of trials that follow one another, added,
/// equal the sums of both to the bit (docs/scaling.md: up to how many trials).
class SummedPoint {
 public:
  /// @param study stays as long as this. @param first_trial index at the point of the first that is added
  SummedPoint(const study::Study& study, std::int64_t point, std::int64_t first_trial);

  std::int64_t point() const { return point_; }

  /// Adds the next trial, but for what the criteria predict of it.
  /// @throws Failure (bad_data) as PointAccumulator::add does
  void add(std::int64_t row, const trial::TrialOutcome& outcome, std::span<const trial::Jerk> jerks);
  void add(const theory::PointPrediction& prediction) { prediction_ = prediction_ + prediction; }
  SummedPoint& operator+=(const SummedPoint& next);

  layout::PointSums sums() const;
  /// @throws Failure (bad_data) if these cannot be the sums of trials of this point
  void restore(const layout::PointSums& sums);

  measures::PointSummary statistics(double confidence, bool bootstrap) const;
  const theory::PointPrediction& prediction() const { return prediction_; }
  std::int64_t failures() const { return trials_.failures(); }
  measures::UndecidedMoves undecided() const { return undecided_.moves(); }

 private:
  const study::Study* study_;
  std::int64_t point_;
  measures::PointAccumulator trials_;
  UndecidedSums undecided_;
  theory::PointPrediction prediction_;
};

/// The results of StudySums, by point.
struct SummedStudy {
  std::vector<measures::PointSummary> points;        ///< [point, from the first on] if collected
  std::vector<theory::PointPrediction> predictions;  ///< as `points`
  std::vector<measures::UndecidedMoves> undecided;   ///< as `points`
  std::vector<layout::PointSums> sums;               ///< as `points`
};

/// The sums of a point of a file.
/// @throws Failure (bad_data) with file and point where they cannot be those of its trials
SummedPoint restored_point(const reading::ResultsFile& file, const study::Study& study, std::int64_t point);

/// Results that StudySums collects of each point.
enum class Collected {
  statistics,
  sums,  ///< those of a part: rigs without a trial have no statistics
  both
};

/// Adds the sums of files, and gives the statistics of their points. One point at a time is held in the form
/// in which trials can be added.
class StudySums {
 public:
  /// @param study stays as long as this. @param first_point the first that may have trials
  /// @throws Failure (bad_input) for a confidence outside (0, 1).
  StudySums(const study::Study& study, double confidence, bool bootstrap,
            Collected collected = Collected::statistics, std::int64_t first_point = 0);

  /// Adds one point of a file, or all: trials that come after those added before.
  /// @throws Failure (bad_data) where the sums cannot be those of the trials
  void add(const reading::ResultsFile& file, std::int64_t point);
  void add(const reading::ResultsFile& file);
  /// @returns the results of the points up to the last with trials; nothing may be added afterwards
  /// @throws Failure (bad_data) where no statistics follow from the sums
  SummedStudy sum();

 private:
  void begin_point();
  void end_point();
  void add_statistics();

  const study::Study& study_;
  double confidence_;
  bool bootstrap_;
  Collected collected_;
  std::int64_t next_point_;
  SummedStudy sum_;
  std::optional<SummedPoint> point_;
};

}  // namespace zerocount::summary
