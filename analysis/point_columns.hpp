#pragma once

#include <span>
#include <vector>

#include "analysis/point_statistics.hpp"
#include "analysis/theory_prediction.hpp"
#include "results/layout/layout.hpp"

namespace zerocount {

/// The statistics of all points as columns of the results file's /point: one for each of statistic_fields(),
/// by flat_name.
std::vector<PointColumn> point_columns(std::span<const PointSummary> points);

/// The shares of trials for which (6) holds and (7) is exceeded, as columns of /point.
std::vector<PointColumn> prediction_columns(std::span<const TheoryPrediction> predictions);

}  // namespace zerocount
