#include "analysis/machine/monitor/move_log.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/machine/monitor/change_test.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "core/failure/failure.hpp"
#include "core/text/text.hpp"
#include "core/text/unit.hpp"
#include "core/trial/move_measures.hpp"
#include "experiments/parameters/study_units.hpp"
#include "experiments/yaml/problems.hpp"

namespace zerocount::monitor {
namespace {

/// Name of a measure, divided at its brackets: stem "band_settling_time" and index 1 for
/// "band_settling_time[1]".
struct Indexed {
  std::string_view stem;
  std::optional<double> index{};
};

std::string_view without_blanks_around(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

Indexed indexed(std::string_view name) {
  const std::size_t bracket = name.find('[');
  if (bracket == std::string_view::npos || !name.ends_with(']')) return {name};
  return {name.substr(0, bracket),
          text::parse_number<double>(name.substr(bracket + 1, name.size() - bracket - 2))};
}

/// Table of the measures of a study with error bands and one tolerance. In it one row stands for all error
/// bands, and one for all tolerances.
const layout::MeasureTable& table_with_both() {
  study::StudyFeatures features;
  features.tolerances.limits[0] = 1.0;
  features.tolerances.count = 1;
  return layout::measure_table(features);
}

/// Name of a measure for the error band or the tolerance given by `index`, such as "band_settling_time[1]";
/// nothing if `index` cannot be one.
/// @param row measure in table_with_both()
/// @param stem its name without brackets
std::optional<std::string> name_with_index(const layout::Measure& row, std::string_view stem, double index) {
  constexpr double largest = 1e15;  // below which all whole numbers are exact
  if (!(std::abs(index) < largest)) return std::nullopt;
  if (!row.band) return layout::name_of_tolerance(stem, index);
  if (std::rint(index) != index) return std::nullopt;
  return layout::name_of_band(stem, static_cast<std::int64_t>(index));
}

Scale scale_of(const layout::Measure& row, bool quality) {
  if (quality || row.field.valid.high <= 1.0) return Scale::proportion;
  const layout::ValidValues& valid = row.field.valid;
  const bool is_whole = row.field.column.element == hdf5::Element::int64 && !valid.expected.empty();
  const bool is_count = row.reduction == layout::MoveReduction::sum || (is_whole && valid.low == 0.0);
  return is_count ? Scale::counts : Scale::plain;
}

using tables::Separator;

constexpr double never = std::numeric_limits<double>::quiet_NaN();
constexpr double nothing_to_measure = -std::numeric_limits<double>::infinity();  // ranked

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return lower;
}

/// The letters and digits of a name, in lower case.
std::string letters_of(std::string_view name) {
  std::string letters = lower_case(name);
  std::erase_if(letters, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return letters;
}

/// Whether the name `whole` contains the name `part`; false if `part` has fewer than five characters.
bool is_within(std::string_view part, std::string_view whole) {
  constexpr std::size_t shortest = 5;  // shorter ones are parts of words by chance
  return part.size() >= shortest && whole.find(part) != std::string_view::npos;
}

/// Hint, for a message, at the first head that is a misspelt name of a measure: "; 'Arrival_Time' looks like
/// arrival_time". Empty if there is none.
std::string misspelling_in(std::span<const std::string> heads) {
  for (const std::string& head : heads)
    if (const std::optional<std::string> measure = misspelt_measure(head))
      return fmt::format("; '{}' looks like {}", text::printable(head), *measure);
  return "";
}

/// The number in a cell of a log; nothing if the cell is not a number. A comma is read as the decimal mark,
/// unless commas separate the cells.
std::optional<double> number_in(std::string_view cell, Separator separator) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  std::string text = lower_case(cell);
  if (separator != Separator::comma && text.find('.') == std::string::npos)
    std::ranges::replace(text, ',', '.');
  return text::parse_number<double>(text);
}

/// The value of the measure in a cell of a log, written as a number or as a word such as "true" or the name
/// of an outcome. NaN if the cell is empty or a word for no value ("na", "null", "none"); nothing if the cell
/// cannot be read.
std::optional<double> value_in(std::string_view cell, Separator separator, const MonitoredMeasure& measure) {
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

/// Whether the measure can have the value. A measure that counts may have a value that is not a whole number
/// here, because a log may have averages.
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

/// Name of the SI unit to which values in `unit` are converted when a log is read: "m" for "mm". A unit that
/// the program does not know stays.
std::string_view si_name(std::string_view unit) {
  using enum text::Dimension;
  const std::optional<text::Unit> known = text::unit_named(unit);
  if (!known) return unit;
  switch (known->dimension) {
    case time:
      return "s";
    case torque:
      return "N m";
    case angle:
      return "rad";
    case force:
      return "N";
    case length:
      return "m";
    case current:
      return "A";
    case voltage:
      return "V";
    case count:
    case proportion:
      break;
  }
  return unit;
}

}  // namespace

std::optional<MonitoredMeasure> measure_named(std::string_view name) {
  const Indexed wanted = indexed(name);
  const bool is_indexed = name.find('[') != std::string_view::npos;
  if (is_indexed && !wanted.index) return std::nullopt;
  for (const layout::Measure& row : table_with_both()) {
    const bool has_index = row.band || row.tolerance;
    if (has_index != is_indexed || indexed(row.field.column.name).stem != wanted.stem) continue;
    const bool quality = layout::is_quality(row);
    const std::optional<std::string> own_name =
        wanted.index ? name_with_index(row, wanted.stem, *wanted.index) : std::string(name);
    if (!own_name) return std::nullopt;
    return MonitoredMeasure{.name = *own_name,
                            .unit = row.field.column.unit,
                            .row = &row,
                            .quality = quality,
                            .scale = scale_of(row, quality),
                            .accumulates = name == "creep" || name == "reversal_depth"};
  }
  return std::nullopt;
}

ColumnHead column_head(std::string_view text) {
  text = without_blanks_around(text);
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const std::size_t bracket = text.rfind(open);
    if (bracket == std::string_view::npos || !text.ends_with(close) || bracket == 0) continue;
    const std::string_view inside = text.substr(bracket + 1, text.size() - bracket - 2);
    const bool is_index = open == '[' && text[bracket - 1] != ' ' && text::parse_number<double>(inside);
    if (is_index) continue;
    return {std::string(without_blanks_around(text.substr(0, bracket))),
            std::string(without_blanks_around(inside))};
  }
  return {std::string(text), {}};
}

std::optional<std::string> resembling_column(std::string_view measure, std::span<const std::string> heads) {
  const std::string wanted = letters_of(measure);
  std::vector<std::string> near;          // letters of the columns that resemble it
  std::vector<const std::string*> whose;  // heads of these columns
  for (const std::string& head : heads) {
    const std::string letters = letters_of(column_head(head).name);
    if (letters == wanted) return head;
    if (!is_within(letters, wanted) && !is_within(wanted, letters) && !yaml::is_near(wanted, letters))
      continue;
    near.push_back(letters);
    whose.push_back(&head);
  }
  if (near.empty()) return std::nullopt;
  // A name that is too long for nearest_name() contains the first of these.
  const auto nearest = std::ranges::find(near, yaml::nearest_name(wanted, near));
  return nearest == near.end() ? *whose.front() : *whose[static_cast<std::size_t>(nearest - near.begin())];
}

std::optional<std::string> misspelt_measure(std::string_view head) {
  const std::string name = column_head(head).name;
  const std::string letters = letters_of(name);
  const std::size_t digits = letters.find_last_not_of("0123456789") + 1;
  for (const layout::Measure& row : table_with_both()) {
    const std::string_view stem = indexed(row.field.column.name).stem;
    const bool has_index = row.band || row.tolerance;
    if (letters_of(stem) != letters.substr(0, has_index ? digits : letters.size())) continue;
    if (!has_index) return std::string(stem);
    const std::string indexed_name = fmt::format("{}[{}]", stem, letters.substr(digits));
    if (measure_named(indexed_name)) return indexed_name;
  }
  return std::nullopt;
}

double si_factor(std::string_view unit) {
  const std::optional<text::Unit> known = text::unit_named(unit);
  return known ? known->si : 1.0;
}

bool have_same_dimension(std::string_view one, std::string_view other) {
  if (one.empty() || other.empty() || one == other) return true;
  using enum text::Dimension;
  const std::optional<text::Unit> a = text::unit_named(one);
  const std::optional<text::Unit> b = text::unit_named(other);
  if (!a || !b) return false;
  const auto is_number = [](const text::Unit& unit) {
    return unit.dimension == count || unit.dimension == proportion;
  };
  return a->dimension == b->dimension || (is_number(*a) && is_number(*b));
}

std::string linear_unit(const MonitoredMeasure& measure) {
  return parameters::unit_on(parameters::AxisKind::linear, measure.unit);
}

bool can_be_in(const MonitoredMeasure& measure, std::string_view unit) {
  const bool is_counted =
      measure.scale != Scale::proportion && (measure.unit == "count" || measure.unit == "1");
  if (is_counted && si_factor(unit) != 1.0) return false;
  return have_same_dimension(unit, measure.unit) || have_same_dimension(unit, linear_unit(measure));
}

double ranked_value(const MonitoredMeasure& measure, double number) {
  if (measure.name == "outcome") return number == 0.0 ? 1.0 : 0.0;
  return measures::ranked_value(measure.row->values, number).value_or(nothing_to_measure);
}

bool is_nothing(const MonitoredMeasure& measure, double ranked) {
  return measure.row->values.missing == layout::Missing::none && ranked == nothing_to_measure;
}

double serial_correlation(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  const double middle = 0.5 * static_cast<double>(values.size());
  std::vector<double> ranks;  // of the values, those of equal ones alike, minus their mean
  for (const double value : values) ranks.push_back(mid_rank(sorted, value) - middle);
  double squares = 0.0;
  double steps = 0.0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    squares += ranks[i] * ranks[i];
    if (i > 0) steps += (ranks[i] - ranks[i - 1]) * (ranks[i] - ranks[i - 1]);
  }
  return squares > 0.0 ? 1.0 - 0.5 * steps / squares : 0.0;
}

double typical_value(const MonitoredMeasure& measure, std::vector<double> values) {
  if (measure.quality)
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  return statistics::upper_median(std::move(values));
}

const Moves::Column* Moves::find(std::string_view measure) const {
  for (const Column& column : columns)
    if (column.measure.name == measure) return &column;
  return nullptr;
}

std::size_t MoveLog::read(std::string_view text) {
  std::size_t done = 0;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n', done)) {
    read_line(text.substr(done, end - done));
    done = end + 1;
  }
  return done;
}

void MoveLog::read_last(std::string_view line) {
  const bool is_blank = line.find_first_not_of(" \t\r") == std::string_view::npos;
  if (line.empty() || (is_blank && heads_.size() == 1)) return;
  read_line(line);
}

void MoveLog::require_header() const {
  if (!has_header())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: is empty; expected a header with names of measures, such as arrival_time, "
                              "and a row for each move",
                              name));
}

void MoveLog::read_line(std::string_view line) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  ++line_;
  if (line_ == 1 && line.starts_with(byte_order_mark)) line.remove_prefix(byte_order_mark.size());
  while (line.ends_with('\r')) line.remove_suffix(1);
  if (!has_header()) require_line_feeds(line);
  // A tab that separates cells is no blank: a line of such tabs is a row of empty cells.
  const std::string_view blanks = has_header() && separator_ == Separator::tab ? " " : " \t";
  const std::size_t begin = line.find_first_not_of(blanks);
  if (begin == std::string_view::npos) {
    if (heads_.size() == 1) read_row("");
    return;
  }
  std::string_view shown = line.substr(begin);
  if (shown.starts_with('"') && shown.ends_with('"')) shown.remove_prefix(1);
  if (shown.starts_with('#') || shown.starts_with('%')) return;
  if (!has_header()) return read_header(line);
  read_row(line);
}

void MoveLog::require_line_feeds(std::string_view line) const {
  if (line.find('\r') == std::string_view::npos) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("{}:{}: a carriage return stands alone within the line; expected lines that end "
                            "with a line feed, or with both",
                            name, line_));
}

void MoveLog::refuse_twice(std::string_view column) const {
  throw Failure(ExitCode::bad_input, fmt::format("{}:{}: two columns are named '{}'", name, line_, column));
}

void MoveLog::read_header(std::string_view line) {
  for (const auto& [mark, separator] :
       {std::pair(',', Separator::comma), {';', Separator::semicolon}, {'\t', Separator::tab}})
    if (line.find(mark) != std::string_view::npos) separator_ = separator;
  for (const std::string_view cell : tables::cells_of(line, separator_)) {
    const ColumnHead head = column_head(cell);
    const std::optional<MonitoredMeasure> measure = measure_named(head.name);
    if (const std::string_view meanings = trial::meanings_of_settling_time(head.name); !meanings.empty())
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}:{}: the column '{}' may mean two measures; expected {}", name, line_,
                                text::printable(cell), meanings));
    if (!group_.empty() && (head.name == group_ || cell == group_)) {
      if (label_cells_.group) refuse_twice(group_);
      label_cells_.group = heads_.size();
    }
    heads_.emplace_back(cell);
    column_at_.push_back(columns.size());
    if (!measure) {
      column_at_.back() = std::string::npos;
      if (!cell.empty()) other_columns.emplace_back(cell);
      note_label(column_at_.size() - 1, head);
      continue;
    }
    if (find(measure->name) != nullptr) refuse_twice(measure->name);
    if (!can_be_in(*measure, head.unit))
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}:{}: {} is in '{}'; expected '{}', or a unit of the same dimension", name,
                                line_, head.name, text::printable(head.unit), measure->unit));
    columns.push_back({*measure, head.unit, {}});
  }
  if (!group_.empty() && !label_cells_.group)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}:{}: has no column '{}' (--group); expected one of {}", name, line_,
                              text::printable(group_),
                              text::printable(fmt::format("{}", fmt::join(heads_, ", ")).substr(0, 200))));
  if (columns.empty())
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}:{}: no column is named like a measure of moves ({}); expected names such as "
                    "arrival_time, band_settling_time[1], overshoot, outcome{}",
                    name, line_, text::printable(fmt::format("{}", fmt::join(heads_, ", ")).substr(0, 200)),
                    misspelling_in(heads_)));
}

void MoveLog::read_row(std::string_view line) {
  std::vector<std::string_view> cells = tables::cells_of(line, separator_);
  if (cells.size() == heads_.size() + 1 && cells.back().empty()) cells.pop_back();
  if (cells.size() != heads_.size())
    throw Failure(ExitCode::bad_data, fmt::format("{}:{}: a row of {} cells; expected {}, as the header has",
                                                  name, line_, cells.size(), heads_.size()));
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    if (column_at_[cell] == std::string::npos) continue;
    Column& column = columns[column_at_[cell]];
    std::optional<double> value = value_in(cells[cell], separator_, column.measure);
    if (value && !column.unit.empty()) *value *= si_factor(column.unit);
    if (!value || !is_possible(*value, column.measure))
      throw Failure(ExitCode::bad_data,
                    fmt::format("{}:{}: {}: '{}'; expected {}", name, line_, column.measure.name,
                                text::printable(cells[cell].substr(0, 40)), expected_of(column.measure)));
    column.values.push_back(ranked_value(column.measure, *value));
    if (column.measure.name == "final_error") column.written.push_back(*value);
  }
  read_labels(cells);
  ++moves;
}

void MoveLog::note_label(std::size_t cell, const ColumnHead& head) {
  const auto note = [&](std::string_view label, std::optional<std::size_t>& place) {
    if (head.name != label) return;
    if (place) refuse_twice(label);
    place = cell;
  };
  note("move", label_cells_.move);
  note("target", label_cells_.target);
  note("trial", label_cells_.trial);
  labels.numbered = label_cells_.move.has_value();
  labels.targeted = label_cells_.target.has_value();
  if (label_cells_.target != cell) return;
  labels.target_unit = si_name(head.unit);
  target_factor_ = si_factor(head.unit);
}

void MoveLog::read_labels(const std::vector<std::string_view>& cells) {
  MoveLabel label;
  if (label_cells_.move) {
    // A column of whole numbers with a gap is written as 0.0, 1.0, … by some programs.
    const double number = text::parse_number<double>(cells[*label_cells_.move]).value_or(-1.0);
    const bool is_whole = number >= 0.0 && number < 1e15 && number == std::floor(number);
    if (is_whole) label.number = static_cast<std::int64_t>(number);
  }
  std::optional<double> before;
  if (!labels.moves.empty()) before = labels.moves.back().target;
  if (label_cells_.trial) {
    if (labels.moves.empty() || cells[*label_cells_.trial] != trial_) before = 0.0;
    trial_ = cells[*label_cells_.trial];
  }
  if (label_cells_.target) {
    label.target = number_in(cells[*label_cells_.target], separator_);
    if (label.target && !std::isfinite(*label.target)) label.target.reset();  // written NaN for an empty cell
    if (label.target) *label.target *= target_factor_;
    if (label.target && before)
      label.direction = static_cast<int>(*label.target > *before) - static_cast<int>(*label.target < *before);
  }
  if (labels.numbered || labels.targeted) labels.moves.push_back(label);
  if (!label_cells_.group) return;
  const std::string_view group = cells[*label_cells_.group];
  if (group.empty())
    throw Failure(ExitCode::bad_data, fmt::format("{}:{}: {} is empty; expected the group of the move", name,
                                                  line_, text::printable(group_)));
  groups.emplace_back(group);
}

}  // namespace zerocount::monitor
