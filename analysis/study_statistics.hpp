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
std::vector<PointSummary> study_statistics(const StudyFile& file, const Study& study);

/// What the criteria (6) and (7) say of the trials of every point, [point], from the parameters of each
/// trial.
std::vector<TheoryPrediction> study_predictions(const Study& study);

/// Everything that the results file stores of its statistics: point_columns, prediction_columns, and the
/// levels of an open-loop study.
/// @param file holds all trials of `study`.
StoredStatistics stored_statistics(const StudyFile& file, const Study& study);

/// The summary of a complete results file. What was observed comes from its manifest, what the criteria say
/// from the columns of its /point: the trials are not drawn again.
StudySummary summarise(const StudyFile& file);

}  // namespace zerocount
