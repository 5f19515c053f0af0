#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "results/reading/csv.hpp"
#include "results/reading/results_file.hpp"

namespace zerocount::reading {

/// A table as a CSV file.
struct ExportedTable {
  std::string name;                                         ///< of the file
  std::function<void(const ResultsFile&, CsvFile&)> write;  ///< all its rows
};

/// The treatment of files that have the names of tables already.
enum class ExistingFiles { refuse, replace };

/// Writes the tables of a results file as CSV into `directory`, which is made if need be: points.csv;
/// trials.csv, outcomes.csv (one row per move) and jerks.csv of the trials that the file keeps; profiles.csv
/// where there are profiles, trace.csv where trials are retained, and the CSV files of those
/// statistic_groups() that there are; then `further` ones. Columns have the names of the datasets (inputs
/// without "input/"), with the unit in brackets where there is one, such as "settling_time [s]"; the values
/// of profiles.csv have theirs in a column, because it differs from profile to profile. Enumerations are
/// written as their labels. Memory is bounded. The files get their names when all of them are whole.
/// @return the files, in that order
/// @throws Failure: bad_input where one of the files exists and is not to be replaced, bad_data where the
/// results are damaged, machine_failed where a file cannot be written.
std::vector<std::filesystem::path> export_csv(const ResultsFile& file, const std::filesystem::path& directory,
                                              const std::vector<ExportedTable>& further = {},
                                              ExistingFiles existing = ExistingFiles::refuse);

}  // namespace zerocount::reading
