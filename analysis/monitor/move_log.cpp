#include "analysis/monitor/move_log.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/text/text.hpp"
#include "core/failure/failure.hpp"
#include "core/text/number_text.hpp"

namespace zerocount::monitor {
namespace {

constexpr double never = std::numeric_limits<double>::quiet_NaN();

std::string_view bare(std::string_view text) {
  const auto is_around = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_around(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_around(text.back())) text.remove_suffix(1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

std::vector<std::string_view> cells_in(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t at = 0; at <= line.size(); ++at) {
    if (at < line.size() && line[at] == '"') quoted = !quoted;
    if (at < line.size() && (quoted || line[at] != separator)) continue;
    cells.push_back(bare(line.substr(begin, at - begin)));
    begin = at + 1;
  }
  return cells;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return lower;
}

/// The number in a cell; nothing if there is none.
std::optional<double> number_in(std::string_view cell, char separator) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  std::string text = lower_case(cell);
  if (separator != ',' && text.find('.') == std::string::npos) std::ranges::replace(text, ',', '.');
  return text::parse_number<double>(text);
}

/// Likewise, or the value that a word stands for.
std::optional<double> value_in(std::string_view cell, char separator, const MonitoredMeasure& measure) {
  const std::string text = lower_case(cell);
  if (text.empty() || text == "na" || text == "null" || text == "none") return never;
  for (const layout::FlagMeaning& flag : measure.row->field.column.flags)
    if (flag.word == text) return static_cast<double>(flag.value);
  if (measure.quality && measure.name != "outcome") {
    if (text == "true" || text == "1.0") return 1.0;
    if (text == "false" || text == "0.0") return 0.0;
  }
  return number_in(cell, separator);
}

/// Whether the measure can have the value. A log need not round what is counted to whole numbers.
bool is_possible(double value, const MonitoredMeasure& measure) {
  if (std::isnan(value)) return !measure.quality;
  if (measure.quality && measure.name != "outcome") return value == 0.0 || value == 1.0;
  const layout::ValidValues& valid = measure.row->field.valid;
  if (measure.name == "outcome")
    return value >= valid.low && value <= valid.high && std::rint(value) == value;
  if (valid.expected.empty()) return true;
  return value >= valid.low && (value <= valid.high || std::isinf(value));
}

std::string expected_of(const MonitoredMeasure& measure) {
  if (measure.name == "outcome") {
    std::vector<std::string> words;
    for (const layout::FlagMeaning& flag : measure.row->field.column.flags) words.push_back(flag.word);
    return fmt::format("one of {}", fmt::join(words, ", "));
  }
  if (measure.quality) return "0 or 1";
  const std::string_view expected = measure.row->field.valid.expected;
  return expected.empty() ? "a number, or nothing" : std::string(expected);
}

}  // namespace

std::size_t MoveLog::read(std::string_view text) {
  std::size_t done = 0;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n', done)) {
    read_line(text.substr(done, end - done));
    done = end + 1;
  }
  return done;
}

void MoveLog::read_last(std::string_view line) {
  if (!line.empty()) read_line(line);
}

void MoveLog::require_header() const {
  if (!has_header())
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: is empty; expected a header with names of measures, such as settling_time, "
                    "and a row for each move",
                    name_));
}

const MoveLog::Column* MoveLog::find(std::string_view measure) const {
  const auto found =
      std::ranges::find_if(columns_, [&](const Column& column) { return column.measure.name == measure; });
  return found == columns_.end() ? nullptr : &*found;
}

void MoveLog::read_line(std::string_view line) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  ++line_;
  if (line_ == 1 && line.starts_with(byte_order_mark)) line.remove_prefix(byte_order_mark.size());
  while (line.ends_with('\r')) line.remove_suffix(1);
  if (!has_header()) require_line_feeds(line);
  // A tab that separates cells is no blank: a line of such tabs is a row of empty cells.
  const std::string_view blanks = has_header() && separator_ == '\t' ? " " : " \t";
  const std::size_t begin = line.find_first_not_of(blanks);
  if (begin == std::string_view::npos) {
    if (heads_.size() == 1) ++blank_lines_;
    return;
  }
  const std::string_view shown = bare(line.substr(begin));
  if (shown.starts_with('#') || shown.starts_with('%')) return;
  if (!has_header()) return read_header(line);
  // In a log of one column a blank line is an empty cell, unless nothing follows.
  for (; blank_lines_ > 0; --blank_lines_) read_row("");
  read_row(line);
}

void MoveLog::require_line_feeds(std::string_view line) const {
  if (line.find('\r') == std::string_view::npos) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("{}:{}: a carriage return stands alone within the line; expected lines that end "
                            "with a line feed, or with both",
                            name_, line_));
}

void MoveLog::refuse_twice(std::string_view column) const {
  throw Failure(ExitCode::bad_input, fmt::format("{}:{}: two columns are named '{}'", name_, line_, column));
}

void MoveLog::read_header(std::string_view line) {
  separator_ = ',';
  for (const char candidate : {'\t', ';', ','})
    if (line.find(candidate) != std::string_view::npos) {
      separator_ = candidate;
      break;
    }
  for (const std::string_view cell : cells_in(line, separator_)) {
    const ColumnHead head = column_head(cell);
    const std::optional<MonitoredMeasure> measure = measure_named(head.name);
    if (!group_.empty() && (head.name == group_ || cell == group_)) {
      if (label_cells_.group) refuse_twice(group_);
      label_cells_.group = heads_.size();
    }
    heads_.emplace_back(cell);
    column_at_.push_back(columns_.size());
    if (!measure) {
      column_at_.back() = std::string::npos;
      if (!cell.empty()) others_.emplace_back(cell);
      note_label(column_at_.size() - 1, head);
      continue;
    }
    if (find(measure->name) != nullptr) refuse_twice(measure->name);
    if (!can_be_in(*measure, head.unit))
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}:{}: {} is in '{}'; expected '{}', or a unit of the same dimension", name_,
                                line_, head.name, text::printable(head.unit), measure->unit));
    columns_.push_back({*measure, head.unit, {}});
  }
  if (!group_.empty() && !label_cells_.group)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}:{}: has no column '{}' (--group); expected one of {}", name_, line_,
                              text::printable(group_),
                              text::printable(fmt::format("{}", fmt::join(heads_, ", ")).substr(0, 200))));
  if (columns_.empty())
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}:{}: no column is named like a measure of moves ({}); expected names such as "
                    "settling_time, band_settling_time[1], overshoot, outcome",
                    name_, line_,
                    text::printable(fmt::format("{}", fmt::join(heads_, ", ")).substr(0, 200))));
}

void MoveLog::read_row(std::string_view line) {
  std::vector<std::string_view> cells = cells_in(line, separator_);
  if (cells.size() == heads_.size() + 1 && cells.back().empty()) cells.pop_back();
  if (cells.size() != heads_.size())
    throw Failure(ExitCode::bad_data, fmt::format("{}:{}: a row of {} cells; expected {}, as the header has",
                                                  name_, line_, cells.size(), heads_.size()));
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    if (column_at_[cell] == std::string::npos) continue;
    Column& column = columns_[column_at_[cell]];
    std::optional<double> value = value_in(cells[cell], separator_, column.measure);
    if (value && !column.unit.empty()) *value *= si_factor(column.unit);
    if (!value || !is_possible(*value, column.measure))
      throw Failure(ExitCode::bad_data,
                    fmt::format("{}:{}: {}: '{}'; expected {}", name_, line_, column.measure.name,
                                text::printable(cells[cell].substr(0, 40)), expected_of(column.measure)));
    column.values.push_back(ranked_value(column.measure, *value));
    if (column.measure.name == "final_error") column.written.push_back(*value);
  }
  read_labels(cells);
  ++moves_;
}

void MoveLog::note_label(std::size_t cell, const ColumnHead& head) {
  const auto note = [&](std::string_view name, std::optional<std::size_t>& place) {
    if (head.name != name) return;
    if (place) refuse_twice(name);
    place = cell;
  };
  note("move", label_cells_.move);
  note("target", label_cells_.target);
  note("trial", label_cells_.trial);
  labels_.numbered = label_cells_.move.has_value();
  labels_.targeted = label_cells_.target.has_value();
  if (label_cells_.target != cell) return;
  labels_.target_unit = head.unit;
  target_factor_ = si_factor(head.unit);
}

void MoveLog::read_labels(const std::vector<std::string_view>& cells) {
  MoveLabel label;
  if (label_cells_.move) {
    // A column of whole numbers with a gap is written as 0.0, 1.0, … by some programs.
    const double number = text::parse_number<double>(cells[*label_cells_.move]).value_or(-1.0);
    const bool is_whole = number >= 0.0 && number < 1e15 && number == std::floor(number);
    numbers_.push_back(is_whole ? static_cast<std::int64_t>(number) : -1);
    if (numbers_.back() >= 0) label.number = numbers_.back();
  }
  std::optional<double> before;
  if (!labels_.moves.empty()) before = labels_.moves.back().target;
  if (label_cells_.trial) {
    if (labels_.moves.empty() || cells[*label_cells_.trial] != trial_) before = 0.0;
    trial_ = cells[*label_cells_.trial];
  }
  if (label_cells_.target) {
    label.target = number_in(cells[*label_cells_.target], separator_);
    if (label.target && !std::isfinite(*label.target)) label.target.reset();  // written NaN for an empty cell
    if (label.target) *label.target *= target_factor_;
    if (label.target && before)
      label.direction = static_cast<int>(*label.target > *before) - static_cast<int>(*label.target < *before);
  }
  if (labels_.numbered || labels_.targeted) labels_.moves.push_back(label);
  if (!label_cells_.group) return;
  const std::string_view group = cells[*label_cells_.group];
  if (group.empty())
    throw Failure(ExitCode::bad_data, fmt::format("{}:{}: {} is empty; expected the group of the move", name_,
                                                  line_, text::printable(group_)));
  groups_.emplace_back(group);
}

}  // namespace zerocount::monitor
