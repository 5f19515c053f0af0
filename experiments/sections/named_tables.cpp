#include "experiments/sections/named_tables.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/text/unit.hpp"
#include "experiments/keys/manifest_keys.hpp"

namespace zerocount::sections {
namespace {

using Pairs = std::vector<std::pair<double, double>>;

/// Reports a fault of the table that `field` names.
void add_fault(const yaml::Field& field, std::size_t line, std::string_view what, std::string_view expected,
               yaml::Problems& problems, std::size_t column = 1) {
  problems.add({field.node->text, static_cast<int>(line), static_cast<int>(column)}, field.path, what,
               expected);
}

struct FoundColumn {
  std::size_t index;
  double si;  ///< one of its unit in SI units
};

/// The table of a torque, on a rotary or linear axis.
struct TorqueTable {
  const yaml::Field& field;
  const tables::TextTable& table;
  bool linear;
  yaml::Problems& problems;

  /// The column with one of these names. Reports its absence, and a unit of another dimension.
  std::optional<FoundColumn> column(const std::vector<std::string_view>& names, text::Dimension dimension,
                                    std::string_view units) const {
    const auto name =
        std::ranges::find_if(names, [&](std::string_view one) { return table.find(one) < table.columns(); });
    if (name == names.end()) {
      add_fault(field, table.header_line(), fmt::format("the table has no column {}", names.front()),
                fmt::format("a header such as {}", linear ? "t [s], force [N]" : "t [s], torque [N m]"),
                problems);
      return std::nullopt;
    }
    const std::string unit = table.unit(*name);
    const auto known = text::unit_named(unit);
    if (unit.empty() || (known && known->dimension == dimension))
      return FoundColumn{table.find(*name), unit.empty() ? 1.0 : known->si};
    add_fault(field, table.header_line(), fmt::format("the column {} has the unit '{}'", *name, unit), units,
              problems);
    return std::nullopt;
  }

  /// Times from 0 on (s) and torques (N m or N); none after a report.
  Pairs pairs() const {
    const auto time = column({"t", "time"}, text::Dimension::time, "s, ms or us");
    if (!time) return {};
    const auto torque =
        linear ? column({"force", "drive_force", "torque"}, text::Dimension::force, "N, mN or kN")
               : column({"torque", "drive_torque"}, text::Dimension::torque, "N m or mN m");
    if (!torque) return {};
    Pairs found;
    double first = 0.0;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      for (const FoundColumn& one : {*time, *torque}) {
        if (std::isfinite(table.number(row, one.index))) continue;
        add_fault(field, table.line(row), fmt::format("'{}' is not a number", table.cell(row, one.index)),
                  "a finite number for the time and for the torque", problems);
        return {};
      }
      const double at = table.number(row, time->index) * time->si;
      if (row == 0) first = at;
      if (row > 0 && !(at - first > found.back().first)) {
        add_fault(field, table.line(row),
                  fmt::format("the time {:.9g} s is not after the one before it, {:.9g} s", at,
                              found.back().first + first),
                  "increasing times", problems);
        return {};
      }
      found.emplace_back(at - first, table.number(row, torque->index) * torque->si);
    }
    return found;
  }
};

/// The points of the table of a spectrum; none after a report.
Pairs points_of(const yaml::Field& field, const tables::TextTable& table, std::string_view expected,
                yaml::Problems& problems) {
  Pairs points;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const bool is_point =
        table.columns() == 2 && std::isfinite(table.number(row, 0)) && std::isfinite(table.number(row, 1));
    if (!is_point) {
      add_fault(field, table.line(row), "this is not a point of a spectrum", expected, problems);
      return {};
    }
    points.emplace_back(table.number(row, 0), table.number(row, 1));
  }
  if (points.empty()) add_fault(field, 1, "the table has no points", expected, problems);
  return points;
}

std::string override_of(std::string_view path, const Pairs& pairs) {
  std::string list;
  for (const auto& [first, second] : pairs)
    list += fmt::format("{}[{}, {}]", list.empty() ? "" : ", ", first, second);
  return fmt::format("{}=[{}]", path, list);
}

/// The file that the field names in place of a list of pairs, and its text.
std::optional<tables::TextTable> named_table(const std::optional<yaml::Field>& field, std::string_view what,
                                             std::string_view expected, const SamplesReader& read,
                                             yaml::Problems& problems) {
  if (!field || field->node->kind != yaml::YamlNode::Kind::scalar) return std::nullopt;
  const auto file = yaml::read_line(*field, problems);
  if (!file) return std::nullopt;
  if (read) return read_table(*field, read(*file, fmt::format("a table of {}", what)), expected, problems);
  problems.add(*field, fmt::format("this command does not read tables of {}", what), "a list of pairs");
  return std::nullopt;
}

void add_spectra_below(const yaml::Field& disturbance, const SamplesReader& read, yaml::Problems& problems,
                       std::vector<std::string>& overrides) {
  constexpr std::string_view expected = "a line 'frequency in Hz, density' for each point, such as 10, 1e-9";
  const auto list = yaml::find_field(disturbance, "vibration");
  if (!list || list->node->kind != yaml::YamlNode::Kind::list) return;
  for (const yaml::Field& element : shapes::items_of(*list)) {
    const auto field = yaml::find_field(element, "spectrum");
    const auto table = named_table(field, "spectra", expected, read, problems);
    const Pairs points = table ? points_of(*field, *table, expected, problems) : Pairs{};
    if (!points.empty()) overrides.push_back(override_of(field->path, points));
  }
}

void add_torque_record(const yaml::Field& root, const SamplesReader& read, yaml::Problems& problems,
                       std::vector<std::string>& overrides) {
  const auto command = yaml::find_field(root, "command");
  const auto torque = command ? yaml::find_field(*command, "torque") : std::nullopt;
  const auto field = torque ? yaml::find_field(*torque, "file") : std::nullopt;
  const auto axis = yaml::find_field(root, "axis");
  const bool linear =
      axis && axis->node->kind == yaml::YamlNode::Kind::scalar && axis->node->text == "linear";
  const std::string expected =
      fmt::format("a header such as {}, and 2 to {} rows of numbers",
                  linear ? "t [s], force [N]" : "t [s], torque [N m]", keys::max_record_rows);
  const auto table = named_table(field, "torques", expected, read, problems);
  if (!table) return;
  if (table->rows() < 2 || table->rows() > keys::max_record_rows)
    return add_fault(*field, 1, fmt::format("the table has {} rows", table->rows()), expected, problems);
  const Pairs pairs = TorqueTable{*field, *table, linear, problems}.pairs();
  if (pairs.empty()) return;
  overrides.push_back(override_of(field->path, pairs));
  if (!yaml::find_field(*command, "hold"))
    overrides.push_back(
        fmt::format("command.hold={}", 2.0 * pairs.back().first - pairs[pairs.size() - 2].first));
}

}  // namespace

std::optional<tables::TextTable> read_table(const yaml::Field& field, std::string text,
                                            std::string_view expected, yaml::Problems& problems) {
  try {
    return tables::TextTable(field.node->text, std::move(text), expected);
  } catch (const tables::TableFault& fault) {
    add_fault(field, fault.line(), fault.found(), fault.expected(), problems, fault.column());
    return std::nullopt;
  }
}

std::shared_ptr<const trial::TorqueRecord> read_torque_record(const yaml::Field& list,
                                                              yaml::Problems& problems) {
  // The name of a file is still there if its table could not be read, which is reported.
  if (!shapes::read(list, keys::shape_of("command.torque.file"), problems) ||
      list.node->kind != yaml::YamlNode::Kind::list)
    return nullptr;
  trial::TorqueRecord record;
  for (const yaml::Field& pair : shapes::items_of(list)) {
    record.time.push_back(shapes::number_of(yaml::item_of(pair, 0)));
    record.torque.push_back(shapes::number_of(yaml::item_of(pair, 1)));
  }
  if (record.time.front() != 0.0) {
    problems.add(yaml::item_of(list, 0), fmt::format("found the time {} s", record.time.front()), "0");
    return nullptr;
  }
  return std::make_shared<const trial::TorqueRecord>(std::move(record));
}

bool is_spectrum(const yaml::Field& element) {
  return element.node->kind == yaml::YamlNode::Kind::map && yaml::find_field(element, "spectrum");
}

std::shared_ptr<const trial::SpectrumParameters> read_spectrum(const yaml::Field& element,
                                                               yaml::Problems& problems) {
  const yaml::Field points = yaml::find_field(element, "spectrum").value();
  if (!shapes::read(element, keys::spectrum_shape(), problems) ||
      points.node->kind != yaml::YamlNode::Kind::list)
    return nullptr;
  trial::SpectrumParameters spectrum;
  if (const auto lines = yaml::find_field(element, "lines")) spectrum.lines = shapes::whole_of<int>(*lines);
  for (const yaml::Field& point : shapes::items_of(points))
    spectrum.density.push_back(
        {shapes::number_of(yaml::item_of(point, 0)), shapes::number_of(yaml::item_of(point, 1))});
  return std::make_shared<const trial::SpectrumParameters>(std::move(spectrum));
}

std::vector<std::string> table_overrides(const yaml::YamlNode& root, const SamplesReader& read,
                                         yaml::Problems& problems) {
  std::vector<std::string> overrides;
  if (const auto disturbance = yaml::find_field({&root, ""}, "disturbance")) {
    add_spectra_below(*disturbance, read, problems, overrides);
    if (const auto load = yaml::find_field(*disturbance, "load"))
      add_spectra_below(*load, read, problems, overrides);
  }
  add_torque_record({&root, ""}, read, problems, overrides);
  return overrides;
}

}  // namespace zerocount::sections
