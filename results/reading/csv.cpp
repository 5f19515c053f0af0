#include <cmath>

#include <fmt/format.h>

#include "core/text/text.hpp"
#include "results/reading/export.hpp"

namespace zerocount::reading {

std::string number_text(double value) {
  return std::isnan(value) ? "nan" : fmt::format("{}", value);  // a NaN's sign means nothing
}

std::string head_with_unit(std::string_view name, std::string_view unit) {
  return unit.empty() || unit == "1" ? std::string(name) : fmt::format("{} [{}]", name, unit);
}

void CsvFile::separate() {
  if (row_started_) row_ += ',';
  row_started_ = true;
}

void CsvFile::add(double value) {
  separate();
  row_ += number_text(value);
}

void CsvFile::add(std::int64_t value) {
  separate();
  row_ += std::to_string(value);
}

void CsvFile::add(std::string_view text) {
  separate();
  row_ += text::csv_field(text);
}

void CsvFile::end_row() {
  row_ += '\n';
  file_.write(row_);
  row_.clear();
  row_started_ = false;
}

}  // namespace zerocount::reading
