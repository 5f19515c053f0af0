#pragma once

#include <vector>

#include "analysis/point_statistics.hpp"
#include "analysis/summary.hpp"
#include "analysis/theory_prediction.hpp"
#include "experiments/study.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount {

/// The statistics of every design point of a complete results file, [point].
///
/// Reads the file once from beginning to end in blocks. The memory does not grow with the number of trials
/// (see PointAccumulator), only with the number of points.
/// @throws Failure (bad_data) where trials are missing or the file contradicts itself; the message names the
/// trial.
/// @param study the study of the file.
/// @param confidence of all bounds. @param bootstrap whether to find bounds of means by resampling, which
/// takes its time; its random numbers are those of the study's seed.
std::vector<PointSummary> study_statistics(const StudyFile& file, const Study& study,
                                           double confidence = summary_confidence, bool bootstrap = false);

/// What the criteria (6) and (7) say of the trials of every point, [point], from the parameters of each
/// trial.
std::vector<TheoryPrediction> study_predictions(const Study& study);

/// Everything that the results file stores of its statistics: point_columns, prediction_columns, and the
/// levels of an open-loop study. All bounds have 95 %.
/// @param file holds all trials of `study`.
StoredStatistics stored_statistics(const StudyFile& file, const Study& study);

/// The summary of a complete results file. What was observed comes from its manifest, what the criteria say
/// from the columns of its /point: the trials are not drawn again. Every bound is found anew.
/// @throws Failure (bad_input) for a confidence outside (0, 1).
StudySummary summarise(const StudyFile& file, double confidence = summary_confidence, bool bootstrap = false);

}  // namespace zerocount
