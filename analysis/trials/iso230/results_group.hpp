#pragma once

#include "analysis/trials/iso230/columns.hpp"
#include "experiments/study/study.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/reading/export.hpp"

/// The group /repeatability of a results file, which holds the quantities of ISO 230-2.
/// results/repeatability.md describes it.
namespace zerocount::iso230 {

/// Adds the group /repeatability to a file that holds all trials of a study with a sequence: the quantities
/// of ISO 230-2 of every trial, and their statistics at every design point.
///
/// The trials are processed in blocks. Then one column of one point is held in memory at a time: 8 bytes per
/// trial and target.
/// @throws Failure (bad_data) if the file contradicts the study; machine_failed if it cannot be written.
void write_repeatability(hdf5::File& file, const study::Study& study);

/// The statistics of the ISO 230-2 quantities at every design point, computed from the values of the trials
/// in the file.
/// @throws Failure (bad_data) if the values are missing or do not belong to the study.
RepeatabilitySummary read_repeatability(const hdf5::Group& root, const study::Study& study,
                                        double confidence = statistics::summary_confidence);

/// The statistics of the ISO 230-2 quantities at every design point of a complete results file, as
/// read_repeatability().
RepeatabilitySummary study_repeatability(const reading::AllTrialsFile& file, const study::Study& study,
                                         double confidence = statistics::summary_confidence);

/// The tables of the group /repeatability as CSV: repeatability_trials.csv, repeatability_trial_targets.csv
/// (a row per trial and target), repeatability_points.csv and repeatability_point_targets.csv. Columns have
/// the paths of the datasets in their table, with _ for / and the unit in brackets. Empty if the file has no
/// such group.
std::vector<reading::ExportedTable> repeatability_exports(const reading::ResultsFile& file);

}  // namespace zerocount::iso230
