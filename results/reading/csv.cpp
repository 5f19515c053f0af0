#include "results/reading/csv.hpp"

#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

namespace zerocount::reading {

std::string number_text(double value) {
  return std::isnan(value) ? "nan" : fmt::format("{}", value);  // a NaN's sign means nothing
}

namespace {

/// Whether a spreadsheet reads it as a number, maybe with a percent sign.
bool is_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} &&
         std::string_view(end, text.data() + text.size()).find_first_not_of(" %") == std::string_view::npos;
}

}  // namespace

bool is_formula(std::string_view text) {
  if (text.empty()) return false;
  const bool is_signed = text.front() == '+' || text.front() == '-';
  return text.front() == '=' || text.front() == '@' || (is_signed && !is_number(text.substr(1)));
}

std::string csv_field(std::string_view text) {
  if (is_formula(text)) return csv_field(fmt::format("'{}", text));
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char character : text) {
    if (character == '"') quoted += '"';
    quoted += character;
  }
  return quoted + '"';
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
  row_ += csv_field(text);
}

void CsvFile::end_row() {
  row_ += '\n';
  file_.write(row_);
  row_.clear();
  row_started_ = false;
}

}  // namespace zerocount::reading
