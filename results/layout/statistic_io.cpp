
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "results/layout/table_io.hpp"

namespace zerocount::layout {
namespace {

/// The columns of a group of statistics as the file describes them, without their values.
std::vector<PointColumn> described_columns(const hdf5::Group& group, const StatisticGroup& kind) {
  std::vector<PointColumn> columns;
  for (const std::string& name : group.children()) {
    if (name == "point" || name == kind.dimension) continue;
    const hdf5::Dataset dataset = group.open_dataset(name);
    columns.push_back({name, dataset.text("units"), dataset.text("long_name"), {}});
  }
  return columns;
}

/// The part of a statistic's name before the error band or tolerance in brackets; empty for a name without
/// brackets.
std::string_view name_before_limit(std::string_view name) {
  return name.ends_with(']') ? name.substr(0, name.find('[')) : std::string_view();
}

/// Joins the columns of successive error bands, or tolerances, into one column with the values [point, band].
PointColumn joined_limits(std::span<const PointColumn> columns) {
  PointColumn joined{std::string(name_before_limit(columns.front().name)),
                     columns.front().unit,
                     columns.front().long_name,
                     {}};
  for (std::size_t point = 0; point < columns.front().values.size(); ++point) {
    for (const PointColumn& column : columns) joined.values.push_back(column.values.at(point));
  }
  return joined;
}

}  // namespace

void write_point_columns(hdf5::File& file, const Table& points, std::span<const PointColumn> columns,
                         const study::StudyFeatures& features, RowRange rows) {
  TableIo io = TableIo::open(file, points);
  hdf5::Group group = file.open_group(points.group);
  const auto write = [&](TableIo& table, const PointColumn& column) {
    if (rows.first == 0) {
      table.add(statistic_column(column)).write(0, rows.count, column.values.data());
    } else {
      group.open_dataset(column.name).write(rows.first, rows.count, column.values.data());
    }
  };
  std::map<std::string_view, std::vector<PointColumn>> of_limits;
  for (const PointColumn& column : columns) {
    if (std::ssize(column.values) != rows.count) {
      throw std::invalid_argument(
          fmt::format("the statistic '{}' needs one value per design point", column.name));
    }
    const std::string_view before_limit = name_before_limit(column.name);
    if (before_limit.empty()) {
      write(io, column);
    } else {
      of_limits[before_limit].push_back(column);
    }
  }
  const auto write_all = [&](RootDimension limits, bool of_tolerances) {
    if (limits.values.empty()) return;
    TableIo table =
        TableIo::create(file, on_axis(limit_statistic_table(std::move(limits)), features.axis), io.rows(), 1);
    for (const auto& [name, all] : of_limits)
      if (is_of_tolerance(name) == of_tolerances) write(table, joined_limits(all));
  };
  if (of_limits.empty()) return;
  write_all(band_dimension(features.bands), false);
  write_all(tolerance_dimension(features.tolerances), true);
}

void write_statistic_table(hdf5::File& file, const StatisticTable& table, std::int64_t points,
                           RowRange rows) {
  for (const PointColumn& column : table.columns) {
    if (std::ssize(column.values) == rows.count * table.width) continue;
    throw std::invalid_argument(
        fmt::format("the statistic '{}' of '{}' needs one value per design point and {}", column.name,
                    table.group->name, table.group->dimension));
  }
  const Table described = statistic_table(*table.group, table.columns);
  TableIo io = rows.first == 0 ? TableIo::create(file, described, points, table.width)
                               : TableIo::open(file, described);
  if (rows.first == 0) io.number_rows(0);
  for (std::size_t index = 0; index < table.columns.size(); ++index) {
    io.column(index).write(rows.first, rows.count, table.columns[index].values.data());
  }
}

std::vector<StatisticTable> read_statistic_tables(const hdf5::File& file) {
  std::vector<StatisticTable> tables;
  for (const StatisticGroup& kind : statistic_groups()) {
    const std::string name(kind.name);
    if (!file.contains(name)) continue;
    StatisticTable table{&kind, 1, described_columns(file.open_group(name), kind)};
    const TableIo io = TableIo::open(file, statistic_table(kind, table.columns));
    table.width = io.width();
    for (std::size_t index = 0; index < table.columns.size(); ++index) {
      table.columns[index].values = read_column<double>(io, index);
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace zerocount::layout
