#pragma once

#include "results/layout/layout.hpp"

/// The tables of the group /repeatability of a results file. In those of values, a column for every value of
/// every source, in the order of deviation_sources() and axis_fields() or target_fields(); in those of
/// points, for every statistic of it in the order of value_statistic_fields().
namespace zerocount::iso230 {

/// /repeatability/trial: `evaluated`, then the values of the axis, [trial].
layout::Table trial_table_of_axis();

/// /repeatability/trial_target: `position`, then the values of the targets, [trial, target].
layout::Table trial_table_of_targets();

/// /repeatability/point: point_repeatability_fields(), then the statistics of the axis, [point].
layout::Table point_table_of_axis();

/// /repeatability/point_target: `position_min`, `position_max`, then the statistics of the targets, [point,
/// target].
layout::Table point_table_of_targets();

}  // namespace zerocount::iso230
