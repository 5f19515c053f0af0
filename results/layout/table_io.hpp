#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "results/hdf5/encoded_rows.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/layout/fields.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::layout {

/// Number of elements in a chunk (stored block) of a column that is long enough to fill one. It is a constant
/// of the format, so that chunks depend on the study alone and not on how it was run.
inline constexpr std::int64_t chunk_elements = 16384;

/// Number of rows in a chunk (stored block) of a column with `width` elements in a row.
std::int64_t chunk_rows(std::int64_t width);

/// HDF5 storage of a dimension scale with `size` values.
hdf5::Storage scale_storage(const Column& scale, std::int64_t size);
/// HDF5 storage of a column of a table.
/// @param rows number of rows.
/// @param second size of the second dimension; 1 if the table has none.
hdf5::Storage column_storage(const Table& table, const Column& column, std::int64_t rows, std::int64_t second,
                             hdf5::Compression compression);

/// The columns and dimension scales of a table in an open results file, to be written or read.
class TableIo {
 public:
  /// Creates the table in the file: its groups, its dimension scales, and its columns, attached to the
  /// scales. A scale that another table of the group has made is used as it is. A table without rows is made
  /// extendible, because the netCDF library knows a length of zero only of an unlimited dimension.
  /// @param second size of the second dimension, 1 if the table has none.
  static TableIo create(hdf5::Group& root, const Table& table, std::int64_t rows, std::int64_t second);
  /// Opens the dimension scales and columns of a table, and checks that they have their element types and
  /// equal sizes.
  static TableIo open(const hdf5::Group& root, const Table& table);

  std::int64_t rows() const { return rows_; }
  std::int64_t width() const { return width_; }  ///< Number of elements in one row of a column
  std::size_t columns() const { return datasets_.size(); }
  hdf5::Dataset& row_scale() { return row_scale_; }
  const hdf5::Dataset& row_scale() const { return row_scale_; }
  /// The dimension scale of the second dimension; throws if the table has none. create() has filled it if it
  /// counts from 0.
  hdf5::Dataset& second_scale() { return second_scale_.value(); }
  hdf5::Dataset& column(std::size_t index) { return datasets_[index]; }
  const hdf5::Dataset& column(std::size_t index) const { return datasets_[index]; }

  /// Writes first_value, first_value + 1, … to the dimension scale of the rows.
  /// @param timeline records which thread works at what time; null: no record
  void number_rows(std::int64_t first_value, timeline::Timeline* timeline = nullptr);
  /// Creates one more column in the table.
  hdf5::Dataset& add(const Column& column);

 private:
  TableIo(hdf5::Group group, hdf5::Dataset row_scale)
      : group_(std::move(group)), row_scale_(std::move(row_scale)) {}
  void add_dimension(std::int64_t size);
  friend class TableReader;

  std::int64_t rows_{0};
  std::int64_t width_{1};
  hdf5::Group group_;
  hdf5::Dataset row_scale_;
  std::optional<hdf5::Dataset> second_scale_;
  std::optional<hdf5::Dataset> last_scale_;
  std::vector<hdf5::Size> inner_extent_;  ///< Sizes of the dimensions after the rows, in elements
  std::vector<hdf5::Dataset> datasets_;
};

/// A table that is open to be read, in a results file or in a shard (finished trials of a run).
class TableReader {
 public:
  using Column = std::shared_ptr<const hdf5::RowSource>;

  /// Opens the table of a results file for reading.
  /// @throws Failure (bad_data) as TableIo::open
  static TableReader open(const hdf5::Group& root, const Table& table);
  /// @param width number of elements in one row of a column.
  /// @param scale dimension scale of the rows.
  TableReader(std::int64_t rows, std::int64_t width, Column scale, std::vector<Column> columns)
      : rows_(rows), width_(width), scale_(std::move(scale)), columns_(std::move(columns)) {}

  std::int64_t rows() const { return rows_; }
  std::int64_t width() const { return width_; }
  std::size_t columns() const { return columns_.size(); }
  const hdf5::RowSource& row_scale() const { return *scale_; }
  const hdf5::RowSource& column(std::size_t index) const { return *columns_[index]; }

 private:
  std::int64_t rows_;
  std::int64_t width_;
  Column scale_;
  std::vector<Column> columns_;
};

/// All values of a column, [row][second dimension], flattened. `Value` must be the type of its elements.
template <class Value, class AnyTable>
std::vector<Value> read_column(const AnyTable& io, std::size_t index) {
  std::vector<Value> values(static_cast<std::size_t>(io.rows() * io.width()));
  io.column(index).read(0, io.rows(), values.data());
  return values;
}

/// Checks that every element of a column of truth values is 0 or 1.
/// @param flags elements as bytes, from row `first` on.
/// @throws Failure (bad_data) otherwise.
void require_flags(const TableReader& io, std::size_t index, std::int64_t first,
                   std::span<const std::byte> flags);

/// Finds the stored bytes of the rows [first, first + rows) of all columns, [column], without decoding them.
std::vector<hdf5::FetchedRows> fetch_columns(const TableReader& io, std::int64_t first, std::int64_t rows);

/// Decodes the fetched rows of all columns: the bytes of the elements, [column]. Any thread may call this.
/// @throws Failure (bad_data) if they are damaged.
std::vector<std::vector<std::byte>> decode_columns(const TableReader& io,
                                                   std::span<const hdf5::FetchedRows> fetched);

template <class Record>
std::vector<Record> read_records(const TableReader& io, const std::vector<RecordField<Record>>& fields,
                                 std::int64_t first, std::int64_t rows) {
  std::vector<Record> records(static_cast<std::size_t>(rows * io.width()));
  scatter_all(fields, decode_columns(io, fetch_columns(io, first, rows)), 0, std::span(records));
  return records;
}

/// Writes statistics of the design points `rows` to the table /point of the file. Columns of error bands
/// become one dataset [point, band] (see PointColumn). The call for the first points creates the datasets for
/// all points.
/// @throws std::invalid_argument where a column has not one value per design point.
void write_point_columns(hdf5::File& file, const Table& points, std::span<const PointColumn> columns,
                         const study::StudyFeatures& features, RowRange rows);

/// Writes statistics with a second dimension, for the design points `rows`, to their group. The call for the
/// first points creates the group for `points` design points.
/// @throws std::invalid_argument where a column has not one value per design point and index.
void write_statistic_table(hdf5::File& file, const StatisticTable& table, std::int64_t points, RowRange rows);

/// Reads all statistics with a second dimension that a file has, in the order of statistic_groups().
/// @throws Failure (bad_data) where one is damaged.
std::vector<StatisticTable> read_statistic_tables(const hdf5::File& file);

}  // namespace zerocount::layout
