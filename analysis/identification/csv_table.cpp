#include "analysis/identification/csv_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "analysis/text/text.hpp"
#include "core/failure/failure.hpp"
#include "experiments/yaml/text_file.hpp"

namespace zerocount::identification {
namespace {

constexpr std::size_t max_faults_listed = 5;
constexpr std::size_t max_table_size = std::size_t{1} << 31;  // bytes

/// Removes surrounding blanks and quotation marks.
std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') return text.substr(1, text.size() - 2);
  return text;
}

/// Takes the text up to the next comma from `line`.
std::string_view next_cell(std::string_view& line) {
  const std::size_t comma = line.find(',');
  const std::string_view cell = line.substr(0, comma);
  line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
  return trimmed(cell);
}

std::size_t cells_in(std::string_view line) {
  return static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
}

/// Parses all of `text` as a number; NaN if that fails.
double number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = std::nan("");
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end ? value : std::nan("");
}

}  // namespace

CsvTable::CsvTable(const std::filesystem::path& path)
    : name_(yaml::name_of_text(path)), text_(yaml::read_text(path, max_table_size, "a table")) {
  if (text_.size() > max_table_size) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: the file is too large; expected at most {} bytes", name_, max_table_size));
  }
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::size_t at = text_.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  for (std::size_t number = 1; at < text_.size(); ++number) {
    const std::size_t end = std::min(text_.find('\n', at), text_.size());
    const std::string_view line = std::string_view(text_).substr(at, end - at);
    const std::string_view content = trimmed(line);
    if (!content.empty() && content.front() != '#') {
      if (columns_.empty()) {
        read_header(line);
      } else {
        add_row(line, number);
      }
    }
    at = end + 1;
  }
  if (columns_.empty())
    throw Failure(ExitCode::bad_input, fmt::format("{}: is empty; expected a table", name_));
}

void CsvTable::read_header(std::string_view line) {
  if (line.find('\0') != std::string_view::npos) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: is no text; expected comma-separated values, or a results file", name_));
  }
  const std::size_t cells = cells_in(line);
  if (cells == 1) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: the header has no comma; expected columns separated by commas{}", name_,
                              line.find(';') != std::string_view::npos    ? ", not by semicolons"
                              : line.find('\t') != std::string_view::npos ? ", not by tabs"
                                                                          : ""));
  }
  for (std::size_t i = 0; i < cells; ++i) {
    std::string_view cell = next_cell(line);
    std::string_view unit;
    if (const std::size_t bracket = cell.find('[');
        bracket != std::string_view::npos && cell.ends_with(']')) {
      unit = trimmed(cell.substr(bracket + 1, cell.size() - bracket - 2));
      cell = trimmed(cell.substr(0, bracket));
    }
    columns_.push_back({std::string(cell), std::string(unit)});
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (find(columns_[i].name) == i) continue;
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: two columns are named '{}'", name_, text::printable(columns_[i].name)));
  }
}

void CsvTable::add_row(std::string_view line, std::size_t number) {
  if (const std::size_t cells = cells_in(line); cells != columns_.size()) {
    throw Failure(ExitCode::bad_data, fmt::format("{}:{}: a row of {} cells; expected {}, as the header has",
                                                  name_, number, cells, columns_.size()));
  }
  lines_.push_back(number);
  starts_.push_back(static_cast<std::size_t>(line.data() - text_.data()));
}

std::string CsvTable::columns_text() const {
  std::string text;
  for (const Column& column : columns_) text += (text.empty() ? "" : ", ") + text::printable(column.name);
  return text;
}

std::size_t CsvTable::find(std::string_view column) const {
  const auto found = std::find_if(columns_.begin(), columns_.end(),
                                  [&](const Column& known) { return known.name == column; });
  return static_cast<std::size_t>(found - columns_.begin());
}

std::string_view CsvTable::cell(std::size_t row, std::size_t column) const {
  std::string_view line = std::string_view(text_).substr(starts_[row]);
  line = line.substr(0, line.find('\n'));
  for (std::size_t i = 0; i < column; ++i) next_cell(line);
  return next_cell(line);
}

std::vector<double> CsvTable::numbers(std::string_view column) const {
  const std::size_t at = find(column);
  std::vector<double> values;
  values.reserve(rows());
  std::vector<std::string> faults;
  std::size_t fault_count = 0;
  for (std::size_t row = 0; row < rows(); ++row) {
    values.push_back(number_of(cell(row, at)));
    if (std::isfinite(values.back())) continue;
    if (++fault_count > max_faults_listed) continue;
    const std::string text = text::printable(cell(row, at).substr(0, 40));
    faults.push_back(fmt::format("{}:{}: {}: {} is no finite number", name_, line(row), column,
                                 text.empty() ? "an empty cell" : "'" + text + "'"));
  }
  if (faults.empty()) return values;
  std::string message;
  for (const std::string& fault : faults) message += (message.empty() ? "" : "\n") + fault;
  if (fault_count > faults.size()) message += fmt::format("\nand {} more", fault_count - faults.size());
  throw Failure(ExitCode::bad_data, message);
}

std::vector<bool> CsvTable::equals(std::string_view column, std::string_view word) const {
  const std::size_t at = find(column);
  std::vector<bool> equal(rows());
  for (std::size_t row = 0; row < rows(); ++row) equal[row] = cell(row, at) == word;
  return equal;
}

}  // namespace zerocount::identification
