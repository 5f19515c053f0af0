#pragma once

#include <vector>

#include "results/reading/export.hpp"

namespace zerocount::iso230 {

/// The tables of /repeatability as CSV: repeatability_trials.csv, repeatability_trial_targets.csv (a row per
/// trial and target), repeatability_points.csv and repeatability_point_targets.csv. Columns have the paths of
/// the datasets in their table, with _ for / and the unit in brackets. None where the file has no such group.
std::vector<reading::ExportedTable> repeatability_exports(const reading::StudyFile& file);

}  // namespace zerocount::iso230
