
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "results/layout/table_io.hpp"

namespace zerocount::layout {
namespace {

/// The columns of the group as they are described in the file, without values.
std::vector<PointColumn> described_columns(const hdf5::Group& group, const StatisticGroup& kind) {
  std::vector<PointColumn> columns;
  for (const std::string& name : group.children()) {
    if (name == "point" || name == kind.dimension) continue;
    const hdf5::Dataset dataset = group.open_dataset(name);
    columns.push_back({name, dataset.text("units"), dataset.text("long_name"), {}});
  }
  return columns;
}

}  // namespace

void write_statistic_table(hdf5::File& file, const StatisticTable& table, std::int64_t points) {
  for (const PointColumn& column : table.columns) {
    if (std::ssize(column.values) == points * table.width) continue;
    throw std::invalid_argument(
        fmt::format("the statistic '{}' of '{}' needs one value per design point and {}", column.name,
                    table.group->name, table.group->dimension));
  }
  TableIo io = TableIo::create(file, statistic_table(*table.group, table.columns), points, table.width);
  io.number_rows(0);
  for (std::size_t index = 0; index < table.columns.size(); ++index) {
    io.column(index).write(0, points, table.columns[index].values.data());
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
