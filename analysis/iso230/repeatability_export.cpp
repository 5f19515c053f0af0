#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "analysis/iso230/repeatability_columns.hpp"
#include "analysis/iso230/repeatability_file.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/csv.hpp"

namespace zerocount::iso230 {
namespace {

/// Rows [first, first + rows) of a column of numbers or flags, [row][second] flattened.
std::vector<double> read_values(const layout::TableIo& io, std::size_t column, std::int64_t first,
                                std::int64_t rows) {
  const auto size = static_cast<std::size_t>(rows * io.width());
  std::vector<double> values(size);
  if (io.column(column).element() == hdf5::Element::float64) {
    io.column(column).read(first, rows, values.data());
    return values;
  }
  std::vector<std::uint8_t> flags(size);
  io.column(column).read(first, rows, flags.data());
  std::copy(flags.begin(), flags.end(), values.begin());
  return values;
}

void export_table(const hdf5::Group& root, const layout::Table& table, reading::CsvFile& csv) {
  const layout::TableIo io = layout::TableIo::open(root, table);
  csv.add(table.rows.name);
  if (table.second) csv.add(table.second->name);
  for (const layout::Column& column : table.columns) {
    std::string name = column.name;
    std::replace(name.begin(), name.end(), '/', '_');
    csv.add(reading::head_with_unit(name, column.unit));
  }
  csv.end_row();
  for (std::int64_t first = 0; first < io.rows(); first += layout::chunk_rows(io.width())) {
    const std::int64_t rows = std::min(layout::chunk_rows(io.width()), io.rows() - first);
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

reading::ExportedTable exported(const char* name, layout::Table table) {
  return {name, [table = std::move(table)](const reading::StudyFile& file, reading::CsvFile& csv) {
            export_table(hdf5::File::open_to_read(file.path()), table, csv);
          }};
}

}  // namespace

std::vector<reading::ExportedTable> repeatability_exports(const reading::StudyFile& file) {
  if (!hdf5::File::open_to_read(file.path()).contains("repeatability")) return {};
  const parameters::AxisKind axis = file.axis();
  return {exported("repeatability_trials.csv", layout::on_axis(trial_table_of_axis(), axis)),
          exported("repeatability_trial_targets.csv", layout::on_axis(trial_table_of_targets(), axis)),
          exported("repeatability_points.csv", layout::on_axis(point_table_of_axis(), axis)),
          exported("repeatability_point_targets.csv", layout::on_axis(point_table_of_targets(), axis))};
}

}  // namespace zerocount::iso230
