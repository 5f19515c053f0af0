#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "results/layout/fields.hpp"
#include "results/storage/output_file.hpp"

namespace zerocount::reading {

/// The shortest decimal text that reads back to the same double; "nan", "inf" and "-inf" for the others.
std::string number_text(double value);

/// The value of a field: a number, or the word of an enumeration.
template <class Record>
std::string value_text(const layout::RecordField<Record>& field, const Record& record) {
  const double value = layout::value_of(field, record);
  if (field.column.element == hdf5::Element::float64) return number_text(value);
  const auto whole = static_cast<std::int64_t>(value);
  return field.column.element == hdf5::Element::int8 ? layout::value_text(field.column, whole)
                                                     : std::to_string(whole);
}

/// The name of a column with its unit, such as "settling_time [s]"; the name alone where it has none ("1" or
/// nothing).
std::string head_with_unit(std::string_view name, std::string_view unit);

/// A table in the form of RFC 4180, but with lines that end in a single line feed. It is an
/// OutputFile: it stands at PATH.part until publish(), and is removed if that never comes.
/// @throws Failure (machine_failed) with the path and the reason, from every function.
class CsvFile {
 public:
  explicit CsvFile(const std::filesystem::path& path) : file_(path) {}

  void add(double value);
  void add(std::int64_t value);
  void add(std::string_view text);  ///< quoted where it must be
  template <class... Values>
  requires(sizeof...(Values) > 1) void add(const Values&... values) { (add(values), ...); }
  void end_row();
  void finish() { file_.finish(); }    ///< see OutputFile; nothing can be added after it
  void publish() { file_.publish(); }  ///< gives the finished file its name

 private:
  void separate();

  storage::OutputFile file_;
  std::string row_;
  bool row_started_{false};
};

}  // namespace zerocount::reading
