#include "analysis/iso230/repeatability_export.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "analysis/iso230/repeatability_layout.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/csv.hpp"

namespace zerocount {
namespace {

/// Rows [first, first + rows) of a column of numbers or flags, [row][second] flattened.
std::vector<double> read_values(const TableIo& io, std::size_t column, std::int64_t first,
                                std::int64_t rows) {
  const auto size = static_cast<std::size_t>(rows * io.width());
  std::vector<double> values(size);
  if (io.column(column).element() == Element::float64) {
    io.column(column).read(first, rows, values.data());
    return values;
  }
  std::vector<std::uint8_t> flags(size);
  io.column(column).read(first, rows, flags.data());
  std::copy(flags.begin(), flags.end(), values.begin());
  return values;
}

void export_table(const hdf5::Group& root, const Table& table, CsvFile& csv) {
  const TableIo io = TableIo::open(root, table);
  csv.add(table.rows.name);
  if (table.second) csv.add(table.second->name);
  for (const Column& column : table.columns) {
    std::string name = column.name;
    std::replace(name.begin(), name.end(), '/', '_');
    csv.add(head_with_unit(name, column.unit));
  }
  csv.end_row();
  for (std::int64_t first = 0; first < io.rows(); first += chunk_rows(io.width())) {
    const std::int64_t rows = std::min(chunk_rows(io.width()), io.rows() - first);
    std::vector<std::vector<double>> columns;
    for (std::size_t i = 0; i < table.columns.size(); ++i) columns.push_back(read_values(io, i, first, rows));
    for (std::int64_t i = 0; i < rows * io.width(); ++i) {
      csv.add(first + i / io.width());
      if (table.second) csv.add(i % io.width());
      for (const std::vector<double>& values : columns) csv.add(values[static_cast<std::size_t>(i)]);
      csv.end_row();
    }
  }
}

ExportedTable exported(const char* name, Table table) {
  return {name, [table = std::move(table)](const StudyFile& file, CsvFile& csv) {
            export_table(hdf5::File::open_to_read(file.path()), table, csv);
          }};
}

}  // namespace

std::vector<ExportedTable> repeatability_exports(const StudyFile& file) {
  if (!hdf5::File::open_to_read(file.path()).contains("repeatability")) return {};
  const AxisKind axis = file.axis();
  return {exported("repeatability_trials.csv", on_axis(trial_table_of_axis(), axis)),
          exported("repeatability_trial_targets.csv", on_axis(trial_table_of_targets(), axis)),
          exported("repeatability_points.csv", on_axis(point_table_of_axis(), axis)),
          exported("repeatability_point_targets.csv", on_axis(point_table_of_targets(), axis))};
}

}  // namespace zerocount
