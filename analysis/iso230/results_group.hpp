#pragma once

#include "analysis/iso230/columns.hpp"
#include "experiments/study/study.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/reading/export.hpp"

/// The group /repeatability of a results file, described in results/repeatability.md.
namespace zerocount::iso230 {

/// Adds the group to a file that holds all trials of a study with a sequence: the values of ISO 230-2 of
/// every trial, and their statistics at every design point.
///
/// The trials go by in blocks; then, of each point, one column is held at a time, 8 bytes a trial and target.
/// @throws Failure (bad_data) where the file contradicts the study; machine_failed where it cannot be
/// written.
void write_repeatability(hdf5::File& file, const study::Study& study);

/// The statistics of every design point from the values of the trials in the file.
/// @throws Failure (bad_data) if the values are missing or do not belong to the study.
RepeatabilitySummary read_repeatability(const hdf5::Group& root, const study::Study& study,
                                        double confidence = statistics::summary_confidence);

/// read_repeatability() for a complete results file.
RepeatabilitySummary study_repeatability(const reading::AllTrialsFile& file, const study::Study& study,
                                         double confidence = statistics::summary_confidence);

/// The tables of the group as CSV: repeatability_trials.csv, repeatability_trial_targets.csv (a row per trial
/// and target), repeatability_points.csv and repeatability_point_targets.csv. Columns have the paths of the
/// datasets in their table, with _ for / and the unit in brackets. None where the file has no such group.
std::vector<reading::ExportedTable> repeatability_exports(const reading::ResultsFile& file);

}  // namespace zerocount::iso230
