#include "experiments/sections/named_tables.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/text/text.hpp"
#include "core/text/unit.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/tables/time_gaps.hpp"

namespace zerocount::sections {
namespace {

using Pairs = std::vector<std::pair<double, double>>;

/// Reports a fault of the table that `field` names, at this line and column (from 1) of the table.
void add_fault(const yaml::Field& field, std::size_t line, std::string_view what, std::string_view expected,
               yaml::Problems& problems, std::size_t column = 1) {
  problems.add({field.node->text, static_cast<int>(line), static_cast<int>(column)}, field.path, what,
               expected);
}

struct FoundColumn {
  std::size_t index;
  double si;  ///< factor by which the column's numbers are multiplied to get SI units
};

/// The quantity of a recorded torque or reference, with the names it may have in a table.
struct Recorded {
  std::string_view quantity;  ///< noun for the recorded quantity, in the plural ("torques"), for messages
  std::vector<std::string> columns;  ///< possible names of the quantity's column; the table has one of them
  text::Dimension dimension;
  std::string_view units;    ///< examples of units that its column can have, for messages
  std::string header;        ///< example of a header that the table can have, for messages
  std::string_view between;  ///< phrase for the value of the record between two of its rows, for messages
};

/// The table of a recorded torque or reference in a file that the manifest names.
struct RecordTable {
  const yaml::Field& field;
  const tables::TextTable& table;
  const Recorded& recorded;
  yaml::Problems& problems;
  double first{0.0};  ///< time of the record's first row in the table, s

  /// The column whose name is one of `names`, with its unit. Empty, and reported, if there is none or if its
  /// unit has another dimension.
  std::optional<FoundColumn> column(const std::vector<std::string>& names, text::Dimension dimension,
                                    std::string_view units) const {
    const auto name =
        std::ranges::find_if(names, [&](const auto& one) { return table.find(one) < table.columns(); });
    if (name == names.end()) {
      add_fault(field, table.header_line(), fmt::format("the table has no column {}", names.front()),
                fmt::format("a header such as {}", recorded.header), problems);
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

  /// The rows of the record as pairs of time (s, the first time becomes 0) and value (SI units); empty after
  /// errors, which are reported.
  Pairs pairs() {
    const auto time = column({"t", "time"}, text::Dimension::time, "s, ms or us");
    if (!time) return {};
    const auto value = column(recorded.columns, recorded.dimension, recorded.units);
    if (!value) return {};
    Pairs found;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      for (const FoundColumn& one : {*time, *value}) {
        if (std::isfinite(table.number(row, one.index))) continue;
        add_fault(field, table.line(row), fmt::format("'{}' is not a number", table.cell(row, one.index)),
                  "a finite number for the time and for the value", problems);
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
      found.emplace_back(at - first, table.number(row, value->index) * value->si);
    }
    return found;
  }
};

/// The points [frequency in Hz, density] of the table of a spectrum; empty after an error, which is reported.
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

std::string list_of(const Pairs& pairs) {
  std::string list;
  for (const auto& [first, second] : pairs)
    list += fmt::format("{}[{}, {}]", list.empty() ? "" : ", ", first, second);
  return "[" + list + "]";
}

/// The table in the file that a field names where a list of pairs is allowed too; empty if the field is
/// absent or has a list, and after an error, which is reported.
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

Recorded torques(bool linear) {
  constexpr std::string_view held = "the value before it is held";
  if (linear)
    return {"forces",
            {"force", "drive_force", "torque"},
            text::Dimension::force,
            "N, mN or kN",
            "t [s], force [N]",
            held};
  return {"torques",     {"torque", "drive_torque"}, text::Dimension::torque,
          "N m or mN m", "t [s], torque [N m]",      held};
}

Recorded positions(bool linear, const std::string& column) {
  return {"positions",
          {column},
          linear ? text::Dimension::length : text::Dimension::angle,
          linear ? "m, mm or um" : "rad, mrad or deg",
          fmt::format("t [s], {} [{}]", column, linear ? "m" : "rad"),
          "a straight line joins them"};
}

/// The reader of the tables that a manifest names, and the objects that the reading fills: problems, warnings
/// and overrides.
struct TableReader {
  const SamplesReader& read;
  yaml::Problems& problems;
  std::vector<std::string>& warnings;
  std::vector<std::string> overrides{};
};

void add_spectra_below(const yaml::Field& disturbance, TableReader& tables) {
  constexpr std::string_view expected = "a line 'frequency in Hz, density' for each point, such as 10, 1e-9";
  const auto list = yaml::find_field(disturbance, "vibration");
  if (!list || list->node->kind != yaml::YamlNode::Kind::list) return;
  for (const yaml::Field& element : shapes::items_of(*list)) {
    const auto field = yaml::find_field(element, "spectrum");
    const auto table = named_table(field, "spectra", expected, tables.read, tables.problems);
    const Pairs points = table ? points_of(*field, *table, expected, tables.problems) : Pairs{};
    if (!points.empty()) tables.overrides.push_back(fmt::format("{}={}", field->path, list_of(points)));
  }
}

/// Adds a warning about the gaps in the times of a record across which the value changes: rows of a
/// standstill may be left out.
/// @param first time of the first row in the record, s
/// @param place_of the place of a row
template <class PlaceOf>
void warn_of_gaps(const Pairs& rows, double first, const Recorded& recorded, std::string_view path,
                  const PlaceOf& place_of, TableReader& tables) {
  std::vector<double> times;
  for (const auto& [time, value] : rows) times.push_back(time);
  std::vector<tables::TimeGap> gaps = tables::time_gaps(times);
  std::erase_if(gaps,
                [&](const tables::TimeGap& gap) { return rows[gap.row].second == rows[gap.row - 1].second; });
  if (gaps.empty()) return;
  const tables::TimeGap& gap = gaps.front();
  tables.warnings.push_back(yaml::at_place(
      place_of(gap.row), path,
      fmt::format("no rows for {:.6g} s, between {:.9g} and {:.9g} s, where others are {:.6g} s apart: {}{}",
                  gap.step, first + times[gap.row - 1], first + times[gap.row], gap.usual, recorded.between,
                  gaps.size() > 1 ? fmt::format("; such gaps in all: {}", gaps.size()) : "")));
}

/// The pairs of numbers of a list in the manifest; empty if some of them are not plain numbers.
Pairs pairs_of_list(const yaml::Field& list) {
  Pairs pairs;
  for (const yaml::YamlPointer& item : list.node->items) {
    if (item->kind != yaml::YamlNode::Kind::list || item->items.size() != 2) return {};
    const auto time = text::parse_number<double>(item->items[0]->text);
    const auto value = text::parse_number<double>(item->items[1]->text);
    if (!time || !value || (!pairs.empty() && !(*time > pairs.back().first))) return {};
    pairs.emplace_back(*time, *value);
  }
  return pairs;
}

/// The rows of the record in the file that the field names; empty if the field names no file, and after
/// errors, which are reported. Warns of gaps in the times of the record, also if the manifest has a list of
/// pairs instead of a file.
Pairs pairs_in(const std::optional<yaml::Field>& field, const Recorded& recorded, TableReader& tables) {
  const std::string expected =
      fmt::format("a header such as {}, and 2 to {} rows of numbers", recorded.header, keys::max_record_rows);
  if (field && field->node->kind == yaml::YamlNode::Kind::list) {
    const auto place_of = [&](std::size_t row) {
      const yaml::Place& place = field->node->items[row]->place;
      return place.line > 0 ? place : yaml::Place{"--set"};  // an override is as long as its list
    };
    warn_of_gaps(pairs_of_list(*field), 0.0, recorded, field->path, place_of, tables);
  }
  const auto table = named_table(field, recorded.quantity, expected, tables.read, tables.problems);
  if (!table) return {};
  if (table->rows() < 2 || table->rows() > keys::max_record_rows) {
    add_fault(*field, 1, fmt::format("the table has {} rows", table->rows()), expected, tables.problems);
    return {};
  }
  RecordTable record{*field, *table, recorded, tables.problems};
  Pairs pairs = record.pairs();
  const auto place_of = [&](std::size_t row) {
    return yaml::Place{field->node->text, static_cast<int>(table->line(row)), 1};
  };
  if (!pairs.empty()) warn_of_gaps(pairs, record.first, recorded, field->path, place_of, tables);
  return pairs;
}

void add_torque(const yaml::Field& torque, bool linear, TableReader& tables) {
  const Pairs pairs = pairs_in(yaml::find_field(torque, "file"), torques(linear), tables);
  if (!pairs.empty()) tables.overrides.push_back(fmt::format("{}.file={}", torque.path, list_of(pairs)));
}

void add_reference(const yaml::Field& reference, bool linear, TableReader& tables) {
  const auto file = yaml::find_field(reference, "file");
  const auto column = yaml::find_field(reference, "column");
  if (column && file && file->node->kind == yaml::YamlNode::Kind::list)
    return tables.problems.add(*column, "it has no effect: the record is a list of pairs",
                               "the name of a table in command.reference.file, or the key left out");
  const bool is_named = column && column->node->kind == yaml::YamlNode::Kind::scalar;
  const Pairs pairs = pairs_in(file, positions(linear, is_named ? column->node->text : "reference"), tables);
  // The column goes with the table.
  if (!pairs.empty())
    tables.overrides.push_back(fmt::format("{}={{file: {}}}", reference.path, list_of(pairs)));
}

void add_records(const yaml::Field& root, TableReader& tables) {
  const auto command = yaml::find_field(root, "command");
  if (!command) return;
  const auto axis = yaml::find_field(root, "axis");
  const bool linear =
      axis && axis->node->kind == yaml::YamlNode::Kind::scalar && axis->node->text == "linear";
  if (const auto torque = yaml::find_field(*command, "torque")) add_torque(*torque, linear, tables);
  if (const auto reference = yaml::find_field(*command, "reference"))
    add_reference(*reference, linear, tables);
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

namespace {

/// Reads a recorded torque or reference from a list of pairs; null after errors, which it reports. If the
/// table of a file could not be read, the field still has the file name; that error was reported before.
template <class Record>
std::shared_ptr<const Record> read_record(const yaml::Field& list, yaml::Problems& problems) {
  if (!shapes::read(list, keys::shape_of(list.path), problems) ||
      list.node->kind != yaml::YamlNode::Kind::list)
    return nullptr;
  Record record;
  auto& [times, values] = record;
  for (const yaml::Field& pair : shapes::items_of(list)) {
    times.push_back(shapes::number_of(yaml::item_of(pair, 0)));
    values.push_back(shapes::number_of(yaml::item_of(pair, 1)));
  }
  if (times.front() == 0.0) return std::make_shared<const Record>(std::move(record));
  problems.add(yaml::item_of(list, 0), fmt::format("found the time {} s", times.front()), "0");
  return nullptr;
}

}  // namespace

std::shared_ptr<const trial::TorqueRecord> read_torque_record(const yaml::Field& list,
                                                              yaml::Problems& problems) {
  return read_record<trial::TorqueRecord>(list, problems);
}

std::shared_ptr<const loop::ReferenceRecord> read_reference_record(const yaml::Field& list,
                                                                   yaml::Problems& problems) {
  return read_record<loop::ReferenceRecord>(list, problems);
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
                                         yaml::Problems& problems, std::vector<std::string>& warnings) {
  TableReader tables{read, problems, warnings};
  if (const auto disturbance = yaml::find_field({&root, ""}, "disturbance")) {
    add_spectra_below(*disturbance, tables);
    if (const auto load = yaml::find_field(*disturbance, "load")) add_spectra_below(*load, tables);
  }
  add_records({&root, ""}, tables);
  return tables.overrides;
}

}  // namespace zerocount::sections
