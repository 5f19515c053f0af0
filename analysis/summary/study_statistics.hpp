#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "analysis/measures/point_accumulator.hpp"
#include "analysis/measures/point_statistics.hpp"
#include "analysis/summary/summary.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount::summary {

/// Takes the trials of a study from one results file or several, in order of rows, and gives the statistics
/// of its design points. Files are read once, in blocks. The memory does not grow with the number of trials
/// (see PointAccumulator), only with the number of points.
class StudyAccumulator {
 public:
  /// @param study stays as long as this. @param confidence of all bounds.
  /// @param bootstrap whether to find bounds of means by resampling, which takes its time; its random numbers
  /// are those of the study's seed.
  /// @throws Failure (bad_input) for a confidence outside (0, 1).
  /// @param take is given the statistics of each point when it is complete; without it they are collected.
  StudyAccumulator(const study::Study& study, double confidence, bool bootstrap,
                   std::function<void(measures::PointSummary&&)> take = {});

  /// @param rows of the file, which follow those added before
  /// @throws Failure (bad_data) where the file contradicts itself; the message names the trial.
  void add(const reading::StudyFile& file, layout::RowRange rows);

  /// Completes the last point that has trials.
  void finish();
  /// [point], up to the last that has trials. Ends the adding.
  std::vector<measures::PointSummary> statistics();

 private:
  void begin_point(const measures::MoveKind& kind, const layout::MeasureTable& table);
  void end_point();

  const study::Study& study_;
  double confidence_;
  bool bootstrap_;
  std::function<void(measures::PointSummary&&)> take_;
  std::int64_t complete_{0};                         ///< points
  std::vector<measures::PointSummary> points_;       ///< those that are complete, unless they are taken
  std::optional<measures::PointAccumulator> point_;  ///< the one after them, once it has begun
};

/// The statistics of every design point of a complete results file, [point]; see StudyAccumulator.
/// @throws Failure (bad_data) where trials are missing or the file contradicts itself; the message names the
/// trial.
/// @param study the study of the file.
/// @param confidence of all bounds. @param bootstrap whether to find bounds of means by resampling, which
/// takes its time; its random numbers are those of the study's seed.
std::vector<measures::PointSummary> study_statistics(const reading::StudyFile& file,
                                                     const study::Study& study,
                                                     double confidence = statistics::summary_confidence,
                                                     bool bootstrap = false);

/// The statistics of one of its design points; as above.
measures::PointSummary point_statistics(const reading::StudyFile& file, const study::Study& study,
                                        std::int64_t point, double confidence, bool bootstrap);

/// Everything that a results file stores of its statistics: point_columns, prediction_columns, and the
/// levels of an open-loop study. All bounds have 95 %.
/// @param points, predictions [point] of all trials of consecutive points of `study`, which stays as long as
/// the result. @param first the first of them
layout::StoredStatistics stored_statistics(std::span<const measures::PointSummary> points,
                                           const study::Study& study,
                                           std::span<const theory::PointPrediction> predictions,
                                           const layout::MeasureTable& table, std::int64_t first = 0);
/// Those of all points, in blocks: the memory does not grow with the number of points.
/// @param file holds all trials of `study`, and stays as long as the result, like this
/// @param predictions see theory::study_predictions
layout::StoredStatistics stored_statistics(const reading::StudyFile& file, const study::Study& study,
                                           std::span<const theory::PointPrediction> predictions = {});

}  // namespace zerocount::summary
