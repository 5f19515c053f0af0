#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "results/layout/fields.hpp"
#include "results/reading/results_file.hpp"
#include "results/storage/output_file.hpp"

namespace zerocount::reading {

/// The shortest decimal text that reads back to the same double; "nan", "inf" or "-inf" if the number is not
/// finite.
std::string number_text(double value);

/// The value of a record's field as text: a number, or the word of an enumeration.
template <class Record>
std::string value_text(const layout::RecordField<Record>& field, const Record& record) {
  const double value = layout::value_of(field, record);
  if (field.column.element == hdf5::Element::float64) return number_text(value);
  const auto whole = static_cast<std::int64_t>(value);
  return field.column.element == hdf5::Element::int8 ? layout::value_text(field.column, whole)
                                                     : std::to_string(whole);
}

/// Head of a CSV column: its name with its unit, such as "arrival_time [s]"; the name alone if the unit is
/// "1" or empty.
std::string head_with_unit(std::string_view name, std::string_view unit);

/// A CSV file that is being written (RFC 4180, but lines end in a single line feed). It is an OutputFile: its
/// name is PATH.part until publish(), and it is removed if publish() is never called.
/// @throws Failure (machine_failed) with the path and the reason, from every function.
class CsvFile {
 public:
  explicit CsvFile(const std::filesystem::path& path) : file_(path) {}

  void add(double value);
  void add(std::int64_t value);
  void add(std::string_view text);  ///< Adds a cell with a text, in quotes if it needs them
  template <class... Values>
  requires(sizeof...(Values) > 1) void add(const Values&... values) { (add(values), ...); }
  void end_row();
  /// Finishes the file: brings it to the disk and checks it (OutputFile::finish()). Nothing can be added
  /// afterwards.
  void finish() { file_.finish(); }
  void publish() { file_.publish(); }  ///< Renames the finished file from PATH.part to PATH

 private:
  void separate();

  storage::OutputFile file_;
  std::string row_;
  bool row_started_{false};
};

/// A table of a results file that is exported as a CSV file.
struct ExportedTable {
  std::string name;                                         ///< Name of the CSV file
  std::function<void(const ResultsFile&, CsvFile&)> write;  ///< Function that writes all rows of the table to
                                                            ///< the CSV file
};

/// Treatment of existing files that have the names of files to be written.
enum class ExistingFiles { refuse, replace };

/// Writes the tables of a results file as CSV into `directory`, which is made if need be: points.csv;
/// trials.csv, outcomes.csv (one row per move) and jerks.csv of the trials that the file keeps; profiles.csv
/// where there are profiles, trace.csv where trials are retained, and the CSV files of those
/// statistic_groups() that there are; then `further` ones. Columns have the names of the datasets (inputs
/// without "input/"), followed by the unit in brackets if there is one, such as "arrival_time [s]". The unit
/// of the values in profiles.csv is in a column of its own, because it differs between profiles. Enumerations
/// are written as their labels. Memory is bounded. The files get their names when all of them are complete.
/// @return the files, in that order
/// @throws Failure: bad_input where one of the files exists and is not to be replaced, bad_data where the
/// results are damaged, machine_failed where a file cannot be written.
std::vector<std::filesystem::path> export_csv(const ResultsFile& file, const std::filesystem::path& directory,
                                              const std::vector<ExportedTable>& further = {},
                                              ExistingFiles existing = ExistingFiles::refuse);

}  // namespace zerocount::reading
