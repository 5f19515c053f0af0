#pragma once

#include <string>
#include <vector>

#include "analysis/records/raw_series.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::identification_commands {

/// The options that say what the columns of a record are, `--column`, `--separator`, `--sample-time`, and
/// which times are masked, `--exclude`.
std::vector<command_line::OptionSpec> column_options();

/// Sets the choices of these options. Refuses those that contradict each other, or the other choices.
void set_columns(const command_line::Arguments& arguments, records::SeriesChoice& choice);

/// The kind of a file with records.
enum class RecordFile { table, datasets, results };

/// By its signature, or by its name (the signature may be damaged). An HDF5 file holds datasets if columns
/// are chosen, and is a results file otherwise.
/// @throws Failure (bad_input) for a MAT file before version 7.3.
RecordFile record_file(const std::string& path, const records::SeriesChoice& choice);

/// The intervals of `--exclude`. Refuses anything but "FROM:TO".
std::vector<records::ExcludedTime> excluded_times(const command_line::Arguments& arguments);

/// Masks the intervals of `--exclude` in all series. Refuses an interval without a sample of any of them.
void exclude_times(const command_line::Arguments& arguments, std::vector<records::RawSeries>& series);

/// The series of a table or of a file of datasets.
std::vector<records::RawSeries> read_series(const std::string& path, const records::SeriesChoice& choice);

}  // namespace zerocount::identification_commands
