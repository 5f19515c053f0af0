#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>

#include "analysis/trials/measures/point_statistics.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/timeline/timeline.hpp"

/// The statistics that a results file stores.
namespace zerocount::summary {

/// The statistics of consecutive design points as a results file stores them: point_columns,
/// prediction_columns, the levels of an open-loop study, and the counts of machines and worlds. All bounds
/// have the confidence 95 %.
/// @param points, predictions [point] statistics and predictions over all trials of the point
layout::StoredStatistics stored_statistics(std::span<const measures::PointSummary> points,
                                           const study::Study& study,
                                           std::span<const theory::PointPrediction> predictions,
                                           const layout::MeasureTable& table);

/// Record of the stages of a computation of statistics, and a request to stop it.
struct StatisticsWork {
  timeline::Timeline* timeline{nullptr};  ///< Receives spans of the stages; may be null.
  std::stop_token stop{};                 ///< Interrupts the work.
};

/// Computes the stored statistics of all design points of a file and passes them to `take`, in blocks that
/// fill a chunk of the file. The memory does not grow with the number of points.
/// @param file holds all trials of `study`.
/// @param predictions see theory::study_predictions
/// @throws Failure (interrupted) if `work.stop` requests it
void take_stored_statistics(const reading::AllTrialsFile& file, const study::Study& study,
                            std::span<const theory::PointPrediction> predictions,
                            const std::function<void(const layout::StoredStatistics&)>& take,
                            const StatisticsWork& work = {});

}  // namespace zerocount::summary
