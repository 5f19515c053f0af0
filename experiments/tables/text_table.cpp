#include "experiments/tables/text_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/text/text.hpp"
#include "core/text/unit.hpp"
#include "experiments/yaml/text_file.hpp"

namespace zerocount::tables {
namespace {

constexpr std::size_t max_faults_listed = 5;
constexpr std::size_t max_table_size = std::size_t{1} << 31;  // bytes

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/// The text without blanks and quotation marks around it.
std::string_view unquoted(std::string_view text) {
  text = text::trimmed(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') return text.substr(1, text.size() - 2);
  return text;
}

bool separates(char c, Separator separator) {
  switch (separator) {
    case Separator::comma:
      return c == ',';
    case Separator::semicolon:
      return c == ';';
    case Separator::tab:
      return c == '\t';
    case Separator::blanks:
      return is_blank(c);
  }
  return false;
}

/// Takes the next cell from the beginning of `line`. If `line` ends with a separator, one more (empty) cell
/// follows: `more` is then set.
std::string_view next_cell(std::string_view& line, Separator separator, bool& more) {
  bool quoted = false;
  int brackets = 0;
  std::size_t end = 0;
  for (; end < line.size(); ++end) {
    const char c = line[end];
    if (c == '"') quoted = !quoted;
    if (separator == Separator::blanks && (c == '[' || c == '(')) ++brackets;
    if (separator == Separator::blanks && (c == ']' || c == ')')) --brackets;
    if (!quoted && brackets <= 0 && separates(c, separator)) break;
  }
  const std::string_view cell = line.substr(0, end);
  more = end < line.size();
  line.remove_prefix(more ? end + 1 : end);
  if (separator == Separator::blanks) line = text::trimmed(line);
  return unquoted(cell);
}

/// The cells of a table's header. If blanks separate the cells, a unit in brackets belongs to the name before
/// it.
std::vector<std::string> header_cells(std::string_view line, Separator separator) {
  std::vector<std::string> cells;
  for (const std::string_view cell : cells_of(line, separator)) {
    const bool is_unit = separator == Separator::blanks && (cell.starts_with('[') || cell.starts_with('('));
    if (is_unit && !cells.empty()) {
      cells.back() += cell;
    } else {
      cells.emplace_back(cell);
    }
  }
  return cells;
}

/// Parses all of `text` as a number; NaN if that fails.
double number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  return text::parse_number<double>(text).value_or(std::nan(""));
}

/// Parses all of `text` as a number; NaN if that fails. A decimal comma is allowed unless commas separate the
/// cells.
double number_of(std::string_view text, Separator separator) {
  if (separator == Separator::comma || text.find(',') == std::string_view::npos ||
      text.find('.') != std::string_view::npos) {
    return number_of(text);
  }
  std::string with_point(text);
  with_point[with_point.find(',')] = '.';
  return number_of(with_point);
}

/// Whether the text is a time of day or a date with time, "12:00:00.125" or "2026-11-26T12:00:00".
bool is_time_stamp(std::string_view text) {
  return std::ranges::count(text, ':') == 2 && std::ranges::all_of(text, [](char c) {
           return (c >= '0' && c <= '9') || std::string_view(":.,-/ TZ+").find(c) != std::string_view::npos;
         });
}

bool all_numbers(const std::vector<std::string_view>& cells, Separator separator) {
  return std::all_of(cells.begin(), cells.end(),
                     [&](std::string_view cell) { return std::isfinite(number_of(cell, separator)); });
}

/// Whether one of the cells has a blank inside; numbers have none.
bool has_blank_inside(const std::vector<std::string_view>& cells) {
  return std::any_of(cells.begin(), cells.end(),
                     [](std::string_view cell) { return cell.find(' ') != std::string_view::npos; });
}

constexpr std::array separators{Separator::tab, Separator::semicolon, Separator::comma, Separator::blanks};

/// The separator that gives a table's header (or first row) and the row below it equally many cells; empty if
/// there is none.
std::optional<Separator> common_separator(std::string_view first, std::string_view second) {
  for (const Separator separator : separators) {
    const std::size_t count = header_cells(first, separator).size();
    const std::vector<std::string_view> below = cells_of(second, separator);
    const bool decimal_commas = separator == Separator::comma && has_blank_inside(below);
    if (count >= 2 && below.size() == count && !decimal_commas) return separator;
  }
  return std::nullopt;
}

Separator separator_of(std::string_view first, std::string_view second) {
  if (const std::optional<Separator> common = common_separator(first, second)) return *common;
  for (const Separator separator : separators) {
    if (cells_of(first, separator).size() >= 2) return separator;
  }
  return Separator::comma;
}

/// Number of cells of a row. One empty cell at its end is not counted if the row has one more than `columns`:
/// loggers may end rows with a separator and the header without.
std::size_t cells_of_row(std::string_view line, Separator separator, std::size_t columns) {
  const std::vector<std::string_view> cells = cells_of(line, separator);
  return cells.size() == columns + 1 && cells.back().empty() ? columns : cells.size();
}

bool has_number(const std::vector<std::string_view>& cells, Separator separator) {
  return std::ranges::any_of(
      cells, [&](std::string_view cell) { return std::isfinite(number_of(cell, separator)); });
}

constexpr std::size_t max_titles = 100;

/// The number of title lines above the header. The header is the first line that has no numbers and as many
/// cells as the line below it and as the last one. 0 if there is no such line.
/// @param first lines of the table, without the last
std::size_t titles_above_header(const std::vector<std::string_view>& first, std::string_view last,
                                std::optional<Separator> given) {
  for (std::size_t i = 0; i < first.size(); ++i) {
    const std::string_view below = i + 1 < first.size() ? first[i + 1] : last;
    const std::optional<Separator> separator = given ? given : common_separator(first[i], below);
    if (!separator) continue;
    const std::size_t columns = header_cells(first[i], *separator).size();
    if (columns < 2 || cells_of_row(below, *separator, columns) != columns ||
        cells_of_row(last, *separator, columns) != columns)
      continue;
    const std::vector<std::string_view> cells = cells_of(first[i], *separator);
    if (all_numbers(cells, *separator)) return 0;  // the first row
    if (!has_number(cells, *separator)) return i;
  }
  return 0;
}

/// A unit without its brackets: "mm" for "[mm]", "(mm)" or "mm".
std::string_view without_brackets(std::string_view unit) {
  const bool bracketed =
      (unit.starts_with('[') && unit.ends_with(']')) || (unit.starts_with('(') && unit.ends_with(')'));
  return bracketed ? text::trimmed(unit.substr(1, unit.size() - 2)) : unit;
}

}  // namespace

std::vector<std::string_view> cells_of(std::string_view line, Separator separator) {
  std::vector<std::string_view> cells;
  if (separator == Separator::blanks) line = text::trimmed(line);
  for (bool more = true; more;) cells.push_back(next_cell(line, separator, more));
  return cells;
}

std::vector<std::string> separator_names() {
  return {"comma", "semicolon", "tab", "blanks"};
}

TableFault::TableFault(ExitCode code, std::string_view table, std::size_t line, std::string what,
                       std::string expected, std::size_t column)
    : Failure(code, fmt::format("{}:{}: {}; expected {}", table, line, what, expected)),
      line_(line),
      column_(column),
      found_(std::move(what)),
      expected_(std::move(expected)) {}

TextTable::TextTable(const std::filesystem::path& path, std::optional<Separator> separator)
    : name_(yaml::name_of_text(path)), text_(yaml::read_text(path, max_table_size, "a table")) {
  if (text_.size() > max_table_size) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: the file is too large; expected at most {} bytes", name_, max_table_size));
  }
  constexpr std::size_t min_columns = 2;  // a quantity and its time, or two quantities
  split(separator, min_columns, "a table");
}

TextTable::TextTable(std::string name, std::string text, std::string_view expected)
    : name_(std::move(name)), text_(std::move(text)) {
  split(std::nullopt, 1, expected);
}

void TextTable::split(std::optional<Separator> separator, std::size_t min_columns,
                      std::string_view expected) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text_.find('\n') == std::string::npos) std::ranges::replace(text_, '\r', '\n');
  std::size_t at = text_.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  std::vector<Line> content;
  std::string_view comment_above;
  for (std::size_t number = 1; at < text_.size(); ++number) {
    const std::size_t end = std::min(text_.find('\n', at), text_.size());
    const std::string_view line = std::string_view(text_).substr(at, end - at);
    const std::string_view shown = text::trimmed(line);
    if (shown.starts_with('#') || shown.starts_with('%')) {
      if (content.empty()) comment_above = text::trimmed(shown.substr(1));
    } else if (!shown.empty()) {
      content.push_back({line.ends_with('\r') ? line.substr(0, line.size() - 1) : line, number});
    }
    at = end + 1;
  }
  if (content.empty())
    throw TableFault(ExitCode::bad_input, name_, 1, "the table is empty", std::string(expected));
  if (content.front().text.find('\0') != std::string_view::npos)
    throw TableFault(ExitCode::bad_input, name_, 1, "the table is not text",
                     "a table of numbers, or a results file");
  std::vector<std::string_view> lines;
  for (std::size_t i = 0; i + 1 < content.size() && i <= max_titles; ++i) lines.push_back(content[i].text);
  const std::size_t titles = titles_above_header(lines, content.back().text, separator);
  content.erase(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(titles));
  if (titles > 0) comment_above = {};
  separator_ = separator.value_or(
      separator_of(content.front().text, content.size() > 1 ? content[1].text : content.front().text));
  read(content, comment_above, min_columns);
}

void TextTable::read(const std::vector<Line>& content, std::string_view comment_above,
                     std::size_t min_columns) {
  header_line_ = content.front().number;
  header_start_ = static_cast<std::size_t>(content.front().text.data() - text_.data());
  header_size_ = content.front().text.size();
  const std::vector<std::string_view> first = cells_of(content.front().text, separator_);
  if (first.size() < min_columns) {
    throw TableFault(ExitCode::bad_input, name_, content.front().number, "one cell only",
                     fmt::format("columns separated by commas, semicolons, tabs or blanks{}",
                                 separator_ == Separator::comma ? "" : ", or another --separator"));
  }
  std::size_t row = 1;
  if (all_numbers(first, separator_)) {
    row = 0;
    named_ = header_cells(comment_above, separator_).size() == first.size();
    if (!named_) columns_.resize(first.size());
    if (named_) read_header({comment_above, 0});
  } else {
    read_header(content.front());
    if (min_columns > 1 && content.size() > 1 && read_units(content[1].text)) row = 2;
  }
  for (; row < content.size(); ++row) add_row(content[row]);
}

void TextTable::read_header(const Line& line) {
  for (const std::string& text : header_cells(line.text, separator_)) {
    std::string_view cell = text;
    std::string_view unit;
    std::pair<std::string_view, std::string_view> perhaps;
    for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
      const std::size_t bracket = cell.find(open);
      if (bracket == std::string_view::npos || !cell.ends_with(close)) continue;
      const std::string_view inside = text::trimmed(cell.substr(bracket + 1, cell.size() - bracket - 2));
      if (open == '(' && !text::unit_named(inside)) {
        perhaps = {text::trimmed(cell.substr(0, bracket)), inside};
        continue;
      }
      unit = inside;
      cell = text::trimmed(cell.substr(0, bracket));
      break;
    }
    columns_.push_back(
        {std::string(cell), std::string(unit), std::string(perhaps.first), std::string(perhaps.second)});
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].name.empty() || find(columns_[i].name) == i) continue;
    throw TableFault(ExitCode::bad_input, name_, line.number,
                     fmt::format("two columns are named '{}'", text::printable_lines(columns_[i].name)),
                     "each once", place_in_header(i));
  }
}

bool TextTable::read_units(std::string_view line) {
  const std::vector<std::string_view> cells = cells_of(line, separator_);
  bool any = false;
  for (const std::string_view cell : cells) {
    const std::string_view unit = without_brackets(cell);
    const bool is_value = std::isfinite(number_of(unit, separator_)) && unit == cell;
    if (is_value && unit != "1") return false;  // 1 is the unit of counts
    any = any || (!is_value && text::unit_named(unit));
  }
  if (!any || cells.size() != columns_.size()) return false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string_view unit = without_brackets(cells[i]);
    if (columns_[i].unit.empty() && unit != "-") columns_[i].unit = unit;
  }
  return true;
}

void TextTable::add_row(const Line& line) {
  const std::size_t cells = cells_of_row(line.text, separator_, columns_.size());
  if (cells != columns_.size())
    throw TableFault(ExitCode::bad_data, name_, line.number, fmt::format("a row of {} cells", cells),
                     fmt::format("{}, as the {} has", columns_.size(), named_ ? "header" : "first row"));
  lines_.push_back(line.number);
  starts_.push_back(static_cast<std::size_t>(line.text.data() - text_.data()));
}

std::string TextTable::columns_text() const {
  if (!named_) return fmt::format("#1 to #{}, without names", columns_.size());
  std::string text;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const std::string& name = columns_[i].name;
    text += (i == 0 ? "" : ", ") + (name.empty() ? fmt::format("#{}", i + 1) : text::printable_lines(name));
  }
  return text;
}

std::string TextTable::unit(std::string_view column) const {
  const Column& found = columns_[find(column)];
  return !found.before_bracket.empty() && found.before_bracket == column ? found.in_bracket : found.unit;
}

std::size_t TextTable::find(std::string_view column) const {
  const auto found = named_ ? std::find_if(columns_.begin(), columns_.end(),
                                           [&](const Column& known) { return known.name == column; })
                            : columns_.end();
  if (found != columns_.end()) return static_cast<std::size_t>(found - columns_.begin());
  if (!column.starts_with('#')) {
    const auto begins = [&](const Column& known) {
      return !known.before_bracket.empty() && known.before_bracket == column;
    };
    const bool unique = std::ranges::count_if(columns_, begins) == 1;
    return unique ? static_cast<std::size_t>(std::ranges::find_if(columns_, begins) - columns_.begin())
                  : columns_.size();
  }
  const auto number = text::parse_number<std::size_t>(column.substr(1));
  return number && *number >= 1 && *number <= columns_.size() ? *number - 1 : columns_.size();
}

std::string_view TextTable::line_of(std::size_t row) const {
  std::string_view line = std::string_view(text_).substr(starts_[row]);
  line = line.substr(0, line.find('\n'));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view TextTable::cell(std::size_t row, std::size_t column) const {
  std::string_view line = line_of(row);
  if (separator_ == Separator::blanks) line = text::trimmed(line);
  bool more = true;
  for (std::size_t i = 0; i < column; ++i) next_cell(line, separator_, more);
  return next_cell(line, separator_, more);
}

double TextTable::number(std::size_t row, std::size_t column) const {
  return number_of(cell(row, column), separator_);
}

std::size_t TextTable::place(std::size_t row, std::size_t column) const {
  return static_cast<std::size_t>(cell(row, column).data() - line_of(row).data()) + 1;
}

std::size_t TextTable::place_in_header(std::size_t column) const {
  return static_cast<std::size_t>(header_cell(column).data() - header().data()) + 1;
}

std::string_view TextTable::header_cell(std::size_t column) const {
  return cells_of(header(), separator_)[column];
}

std::vector<double> TextTable::numbers(std::string_view column) const {
  const std::size_t at = find(column);
  std::vector<double> values;
  values.reserve(rows());
  std::vector<std::string> faults;
  std::size_t fault_count = 0;
  std::optional<std::size_t> point;
  std::optional<std::size_t> comma;
  for (std::size_t row = 0; row < rows(); ++row) {
    const std::string_view text = cell(row, at);
    values.push_back(number_of(text, separator_));
    if (!point && text.find('.') != std::string_view::npos) point = row;
    if (!comma && text.find(',') != std::string_view::npos) comma = row;
    if (std::isfinite(values.back())) continue;
    if (++fault_count > max_faults_listed) continue;
    const std::string shown = text::printable_lines(text.substr(0, 40));
    faults.push_back(fmt::format("{}:{}: {}: {} is not a finite number{}", name_, line(row), column,
                                 shown.empty() ? "an empty cell" : "'" + shown + "'",
                                 is_time_stamp(text) && faults.empty()
                                     ? ", but a time stamp; expected seconds, or --sample-time instead"
                                     : ""));
  }
  if (faults.empty() && point && comma) {
    faults.push_back(fmt::format("{}:{}: {}: a decimal {}; line {} has a decimal {}: expected one kind",
                                 name_, line(std::max(*point, *comma)), column,
                                 *point > *comma ? "point" : "comma", line(std::min(*point, *comma)),
                                 *point > *comma ? "comma" : "point"));
    fault_count = 1;
  }
  if (faults.empty()) return values;
  std::string message;
  for (const std::string& fault : faults) message += (message.empty() ? "" : "\n") + fault;
  if (fault_count > faults.size()) message += fmt::format("\nand {} more", fault_count - faults.size());
  throw Failure(ExitCode::bad_data, message);
}

std::vector<bool> TextTable::equals(std::string_view column, std::string_view word) const {
  const std::size_t at = find(column);
  std::vector<bool> equal(rows());
  for (std::size_t row = 0; row < rows(); ++row) equal[row] = cell(row, at) == word;
  return equal;
}

}  // namespace zerocount::tables
