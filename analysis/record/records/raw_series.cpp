#include "analysis/record/records/raw_series.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/record/records/dataset_file.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::records {
namespace {

/// A column of a source, and the conversion of its numbers to a quantity.
struct FoundColumn {
  Quantity quantity;
  std::string column;
  text::Unit unit;
  double factor{1.0};  ///< Factor from the numbers in the column to the quantity's SI unit.
  bool has_factor{false};
};

const ColumnMapping* mapping_of(const SeriesChoice& choice, std::initializer_list<Quantity> quantities) {
  for (const ColumnMapping& mapping : choice.columns) {
    if (std::find(quantities.begin(), quantities.end(), mapping.quantity) != quantities.end())
      return &mapping;
  }
  return nullptr;
}

[[noreturn]] void refuse_column(const tables::ColumnSource& source, const std::string& reason) {
  throw Failure(ExitCode::bad_input, fmt::format("{}: {}", source.name(), reason));
}

/// The unit of a column as the file states it; `usual` if the file states none.
text::Unit unit_in_file(const tables::ColumnSource& source, const std::string& column,
                        const text::Unit& usual) {
  const std::string name = source.unit(column);
  if (name.empty()) return usual;
  if (const std::optional<text::Unit> unit = text::unit_named(name)) return *unit;
  refuse_column(source,
                fmt::format("column '{}' is in '{}', which is not a known unit; expected one of {}, or "
                            "--column with the unit",
                            text::printable(column), text::printable(name), text::unit_names()));
}

/// Sets the conversion factor of the column. A column whose unit has another dimension than the quantity
/// needs the user's factors. An encoder's counts need none, because the size of a count may be given
/// separately.
FoundColumn finished(const tables::ColumnSource& source, FoundColumn found, std::optional<double> factor) {
  const text::Dimension dimension = dimension_of(found.quantity).value();
  const bool own = found.unit.dimension == dimension;
  const bool of_encoder = dimension == text::Dimension::angle || dimension == text::Dimension::length;
  const bool counted_angle = of_encoder && found.unit.dimension == text::Dimension::count;
  if (!own && !factor && !counted_angle) {
    refuse_column(
        source,
        fmt::format("column '{}' is in {}, which cannot be converted to {} without a factor; expected "
                    "--column '{}={}[{}]*FACTOR'",
                    text::printable(found.column), found.unit.name, name_of(found.quantity),
                    name_of(found.quantity), text::printable(found.column), found.unit.name));
  }
  found.has_factor = factor.has_value();
  found.factor = (own ? found.unit.si : 1.0) * factor.value_or(1.0);
  return found;
}

/// True if the name of a column ends like a factor that the user meant, *… or /NUMBER. Paths of datasets,
/// which begin with /, do not count.
bool seems_to_have_factor(const std::string& column) {
  const std::string name = column.substr(0, column.find('['));
  if (name.find('*') != std::string::npos) return true;
  const std::size_t slash = name.rfind('/');
  return slash != std::string::npos && !name.starts_with('/') && slash + 1 < name.size() &&
         name.find_first_not_of("0123456789.eE+- ", slash + 1) == std::string::npos;
}

/// Name of the command-line option that gives the size of an encoder count.
std::string_view count_size_option(bool linear) {
  return linear ? "--resolution" : "--counts-per-revolution";
}

void require_column(const tables::ColumnSource& source, const std::string& column) {
  if (source.has(column)) return;
  refuse_column(
      source,
      fmt::format("has no column '{}'; its columns are {}{}", text::printable(column), source.columns_text(),
                  seems_to_have_factor(column) ? "; factors stand after a unit, as in current[A]*0.87" : ""));
}

FoundColumn mapped_column(const tables::ColumnSource& source, const ColumnMapping& mapping,
                          const text::Unit& usual) {
  require_column(source, mapping.column);
  FoundColumn found{mapping.quantity, mapping.column,
                    mapping.unit ? *mapping.unit : unit_in_file(source, mapping.column, usual)};
  return finished(source, found, mapping.factor);
}

/// The column of a quantity: the `chosen` name, or else the first of `names` that the source has.
FoundColumn usual_column(const tables::ColumnSource& source, Quantity quantity,
                         const std::optional<std::string>& chosen, const std::vector<std::string>& names) {
  const std::vector<std::string> candidates = chosen ? std::vector{*chosen} : names;
  const auto name = std::find_if(candidates.begin(), candidates.end(),
                                 [&](const std::string& one) { return source.has(one); });
  if (name == candidates.end()) {
    refuse_column(source, fmt::format("has no column for the {}; expected {}, or --column {}=COLUMN; its "
                                      "columns are {}",
                                      name_of(quantity), fmt::join(candidates, " or "), name_of(quantity),
                                      source.columns_text()));
  }
  if (name->starts_with("drive_")) {
    quantity = is_linear(quantity) ? Quantity::drive_force : Quantity::drive_torque;
  }
  const text::Unit usual = *name == "count" ? text::unit_named("count").value() : si_unit(quantity);
  return finished(source, {quantity, *name, unit_in_file(source, *name, usual)}, std::nullopt);
}

std::vector<double> scaled_numbers(const tables::ColumnSource& source, const FoundColumn& column) {
  std::vector<double> values = source.numbers(column.column);
  if (column.factor == 1.0) return values;
  for (double& value : values) value *= column.factor;
  return values;
}

/// The unit of the encoder's readings if neither the mapping nor the file states one. Whole numbers are
/// counts if the size of a count is given. If it is not given, whole numbers are refused, because an angle in
/// rad, or a position in m, has decimals.
text::Unit unit_of_readings(const tables::ColumnSource& source, const ColumnMapping& mapping,
                            const SeriesChoice& choice) {
  const std::vector<double> values = source.numbers(mapping.column);
  const bool whole = std::ranges::all_of(values, [](double value) { return value == std::round(value); }) &&
                     std::ranges::any_of(values, [&](double value) { return value != values.front(); });
  if (whole && choice.count_size) return text::unit_named("count").value();
  const text::Unit usual = si_unit(mapping.quantity);
  if (!whole && !choice.count_size) return usual;
  const std::string as_column =
      fmt::format("{}={}", name_of(mapping.quantity), text::printable(mapping.column));
  refuse_column(source, whole
                            ? fmt::format("column '{}' has no unit, and whole numbers as an encoder counts; "
                                          "expected --column '{}[count]' with {} for the size of a count, or "
                                          "--column '{}[{}]'",
                                          text::printable(mapping.column), as_column,
                                          count_size_option(choice.linear), as_column, usual.name)
                            : fmt::format("column '{}' has no unit, and is not in counts, which are whole "
                                          "numbers, although {} gives their size; expected its unit, such as "
                                          "--column '{}[{}]'",
                                          text::printable(mapping.column), count_size_option(choice.linear),
                                          as_column, usual.name));
}

/// The column with the encoder's readings (angle or position), as the user chose it or as the file names it.
/// @throws Failure (bad_input) if there is none
FoundColumn angle_column(const tables::ColumnSource& source, const SeriesChoice& choice, bool linear) {
  if (const ColumnMapping* mapping = mapping_of(choice, {Quantity::angle, Quantity::position})) {
    require_column(source, mapping->column);
    const bool named = mapping->unit || !source.unit(mapping->column).empty();
    return mapped_column(source, *mapping,
                         named ? si_unit(mapping->quantity) : unit_of_readings(source, *mapping, choice));
  }
  std::vector<std::string> names{"theta", "count"};
  if (linear) names.insert(names.begin(), "position");
  if (choice.count_size) std::rotate(names.begin(), names.end() - 1, names.end());
  return usual_column(source, linear ? Quantity::position : Quantity::angle, choice.angle, names);
}

void read_time(const tables::ColumnSource& source, const SeriesChoice& choice, RawSeries& series) {
  if (choice.sample_time) {
    for (std::size_t k = 0; k < series.torque.size(); ++k) {
      series.time.push_back(static_cast<double>(k) * *choice.sample_time);
    }
    return;
  }
  if (const ColumnMapping* mapping = mapping_of(choice, {Quantity::time})) {
    series.time = scaled_numbers(source, mapped_column(source, *mapping, text::unit_named("s").value()));
    return;
  }
  if (source.has("t") && source.has("time")) {
    refuse_column(source, "has both columns t and time; expected one of them, or --column time=COLUMN");
  }
  series.time = scaled_numbers(source, usual_column(source, Quantity::time, std::nullopt, {"t", "time"}));
}

void read_torque(const tables::ColumnSource& source, const SeriesChoice& choice, RawSeries& series) {
  const ColumnMapping* mapping =
      mapping_of(choice, {Quantity::torque, Quantity::drive_torque, Quantity::force, Quantity::drive_force});
  const FoundColumn column =
      mapping != nullptr ? mapped_column(source, *mapping, si_unit(mapping->quantity))
      : series.linear    ? usual_column(source, Quantity::force, choice.torque,
                                        {"drive_force", "force", "drive_torque", "torque"})
                         : usual_column(source, Quantity::torque, choice.torque, {"drive_torque", "torque"});
  series.torque = scaled_numbers(source, column);
  const bool of_motor = column.quantity == Quantity::drive_torque || column.quantity == Quantity::drive_force;
  series.torque_kind = of_motor ? TorqueKind::motor : TorqueKind::commanded;
}

void read_angle(const tables::ColumnSource& source, const SeriesChoice& choice, RawSeries& series) {
  FoundColumn column = angle_column(source, choice, series.linear);
  if (column.unit.dimension == text::Dimension::count) {
    const std::string_view option = count_size_option(series.linear);
    const std::string_view what = name_of(column.quantity);
    if (!column.has_factor && !choice.count_size) {
      refuse_column(source, fmt::format("the {} is in counts; {} is missing", what, option));
    }
    if (column.has_factor && choice.count_size) {
      refuse_column(source, fmt::format("the {} has a factor for its counts beside {}; expected one of them",
                                        what, option));
    }
    // Counts stay whole numbers, whose resolution is known.
    series.count_size = column.has_factor ? std::abs(column.factor) : *choice.count_size;
    column.factor = column.factor < 0.0 ? -1.0 : 1.0;
  }
  series.angle = scaled_numbers(source, column);
}

/// True if the file's columns are those of a linear axis (force, position), false for a rotary axis.
bool is_linear(const tables::ColumnSource& source, const SeriesChoice& choice) {
  using enum Quantity;
  if (choice.linear || mapping_of(choice, {force, drive_force, position}) != nullptr) return true;
  if (mapping_of(choice, {torque, drive_torque, angle}) != nullptr) return false;
  const auto has_any = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* name) { return source.has(name); });
  };
  const bool linear =
      has_any({"force", "drive_force", "position"}) && !has_any({"torque", "drive_torque", "theta"});
  if (linear && choice.rotary) {
    refuse_column(
        source,
        "has the columns of a linear axis, force or position; expected --resolution for the size of "
        "a count, and not --counts-per-revolution or --axis rotary");
  }
  return linear;
}

template <class Value>
std::vector<Value> part_of(const std::vector<Value>& values, std::size_t first, std::size_t end) {
  if (values.empty()) return {};
  return {values.begin() + static_cast<std::ptrdiff_t>(first),
          values.begin() + static_cast<std::ptrdiff_t>(end)};
}

/// Indices of the samples with which repetitions of a test begin. The time restarts if it falls back to
/// within a hundredth of the duration so far from its first value. A smaller step back is an error of the
/// time.
std::vector<std::size_t> repetition_starts(const RawSeries& series, const std::vector<double>& repetition) {
  std::vector<std::size_t> starts{0};
  const std::vector<double>& time = series.time;
  for (std::size_t k = 1; k < time.size(); ++k) {
    const double first = time[starts.back()];
    const double tolerance = 0.01 * (time[k - 1] - first);
    const bool restarts = time[k] < time[k - 1] && time[k] <= first + tolerance && k > starts.back() + 1;
    const bool changes = !repetition.empty() && repetition[k] != repetition[k - 1];
    if (restarts || changes) starts.push_back(k);
  }
  return starts;
}

std::vector<RawSeries> split(const RawSeries& series, std::vector<std::size_t> starts) {
  if (starts.size() == 1) return {series};
  starts.push_back(series.time.size());
  std::vector<RawSeries> parts;
  for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
    const std::size_t first = starts[i];
    const std::size_t end = starts[i + 1];
    RawSeries part = series;
    part.name = fmt::format("{}, repetition {}", series.name, i + 1);
    part.file = series.name;
    part.lines = part_of(series.lines, first, end);
    part.time = part_of(series.time, first, end);
    part.torque = part_of(series.torque, first, end);
    part.angle = part_of(series.angle, first, end);
    part.code = part_of(series.code, first, end);
    part.excluded = part_of(series.excluded, first, end);
    part.sliding = part_of(series.sliding, first, end);
    parts.push_back(std::move(part));
  }
  return parts;
}

/// Reverses the samples if the file begins with the newest one, so that they are in order of time.
void put_oldest_first(RawSeries& series, std::vector<double>& repetition) {
  const auto not_before = [](double time, double next) { return !(next < time); };
  if (series.time.size() < 2 || std::ranges::adjacent_find(series.time, not_before) != series.time.end())
    return;
  std::ranges::reverse(series.lines);
  for (std::vector<double>* values : {&series.time, &series.torque, &series.angle, &series.code, &repetition})
    std::ranges::reverse(*values);
  std::reverse(series.sliding.begin(), series.sliding.end());
  series.notes.emplace_back("the rows have the newest first; they are read from the last one on");
}

/// [sample] Whether the axis slides, from the column `mode` of a trace (words "slide" and "stick"). Empty
/// without this column, or if it has other words, as a column of that name in another file may.
std::vector<bool> sliding_flags(const tables::ColumnSource& source) {
  if (!source.has("mode")) return {};
  std::vector<bool> slides = source.equals("mode", "slide");
  std::vector<bool> known = source.equals("mode", "stick");
  for (std::size_t k = 0; k < slides.size(); ++k) known[k] = known[k] || slides[k];
  if (std::ranges::count(known, false) > 0) slides.clear();
  return slides;
}

}  // namespace

std::string place_of(const RawSeries& series, std::size_t sample) {
  if (series.lines.empty()) return fmt::format("{}, sample {}", series.name, sample);
  return fmt::format("{}:{}", series.file.empty() ? series.name : series.file, series.lines[sample]);
}

bool exclude(RawSeries& series, const ExcludedTime& interval) {
  series.excluded.resize(series.time.size(), false);
  bool any = false;
  for (std::size_t k = 0; k < series.time.size(); ++k) {
    if (series.time[k] < interval.from || series.time[k] > interval.to) continue;
    series.excluded[k] = true;
    any = true;
  }
  return any;
}

std::string contradiction_in(const SeriesChoice& choice) {
  for (std::size_t i = 0; i < choice.columns.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (choice.columns[i].quantity != choice.columns[j].quantity) continue;
      return fmt::format("'--column {}=…' is given twice", name_of(choice.columns[i].quantity));
    }
  }
  const auto has = [&](std::initializer_list<Quantity> quantities) {
    return mapping_of(choice, quantities) != nullptr;
  };
  using enum Quantity;
  int torques = 0;
  for (const Quantity quantity : {torque, drive_torque, force, drive_force})
    torques += has({quantity}) ? 1 : 0;
  if (torques > 1) return "'--column' gives two of torque, drive_torque, force and drive_force";
  if (has({angle}) && has({position})) return "'--column' gives both angle and position";
  const bool linear = has({force, drive_force}) || has({position});
  if (linear && !(has({force, drive_force}) && has({position}))) {
    return "a linear axis needs both '--column force=…' (or drive_force) and '--column position=…'";
  }
  if (torques > 0 && choice.torque) return "'--torque' and '--column' both choose the torque";
  if (has({angle, position}) && choice.angle) return "'--angle' and '--column' both choose the angle";
  if (has({time}) && choice.sample_time) return "'--sample-time' and '--column time=…' exclude each other";
  if (has({angle, torque, drive_torque}) && choice.linear) {
    return "'--axis linear' has a force and a position, '--column' gives a torque or an angle";
  }
  return "";
}

double delay_of(const RawSeries& series, const SeriesChoice& choice, double otherwise) {
  if (series.torque_kind == TorqueKind::commanded) return choice.delay.value_or(otherwise);
  if (choice.delay.value_or(0.0) == 0.0) return 0.0;
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: drive_torque is the motor's torque, behind any delay; --delay goes with "
                            "--torque torque",
                            series.name));
}

std::vector<RawSeries> read_columns(const tables::ColumnSource& source, const SeriesChoice& choice) {
  RawSeries series;
  series.name = source.name();
  series.lines = source.lines();
  series.linear = is_linear(source, choice);
  read_torque(source, choice, series);
  read_angle(source, choice, series);
  read_time(source, choice, series);
  if (series.time.size() != series.torque.size() || series.angle.size() != series.torque.size()) {
    refuse_column(source,
                  fmt::format("time, torque and angle have {}, {} and {} samples; expected as many of "
                              "each",
                              series.time.size(), series.torque.size(), series.angle.size()));
  }
  series.bandwidth = choice.bandwidth.value_or(0.0);
  series.delay = delay_of(series, choice, 0.0);
  if (!series.lines.empty() && source.has("code")) series.code = source.numbers("code");
  series.dac_bits = choice.dac_bits.value_or(0);
  series.sliding = sliding_flags(source);
  series.start.preload = choice.preload.value_or(0.0);
  series.start.hardening = choice.hardening.value_or(0.0);
  std::vector<double> repetition;
  if (const ColumnMapping* mapping = mapping_of(choice, {Quantity::repetition})) {
    require_column(source, mapping->column);
    repetition = source.numbers(mapping->column);
    if (repetition.size() != series.time.size()) {
      refuse_column(source, fmt::format("the repetition has {} samples, the time {}", repetition.size(),
                                        series.time.size()));
    }
  }
  put_oldest_first(series, repetition);
  std::vector<RawSeries> parts = split(series, repetition_starts(series, repetition));
  for (RawSeries& part : parts) unwrap(part);
  return parts;
}

}  // namespace zerocount::records
