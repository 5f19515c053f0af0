#include "results/layout/table_io.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "results/hdf5/encoded_rows.hpp"

namespace zerocount::layout {
namespace {

void describe(hdf5::Dataset& dataset, const Column& column) {
  dataset.set_text("units", column.unit);
  dataset.set_text("long_name", column.long_name);
  if (!column.role.empty()) dataset.set_text("role", column.role);
  if (column.flags.empty()) return;
  std::vector<std::int64_t> values;
  std::string words;
  for (const FlagMeaning& flag : column.flags) {
    values.push_back(flag.value);
    words += (words.empty() ? "" : " ") + flag.word;
  }
  dataset.set_integers("flag_values", column.element, values);
  dataset.set_text("flag_meanings", words);
}

/// The HDF5 group at `path` below `root`. Each group on the path is created if it does not exist yet.
hdf5::Group make_group(hdf5::Group& root, const std::string& path) {
  const std::size_t slash = path.find('/');
  const std::string name = path.substr(0, slash);
  hdf5::Group group = root.contains(name) ? root.open_group(name) : root.create_group(name);
  return slash == std::string::npos ? std::move(group) : make_group(group, path.substr(slash + 1));
}

/// Creates the dataset `name`, which may be a path, below `group`. Groups on the path are created if they do
/// not exist yet.
hdf5::Dataset make_dataset(hdf5::Group& group, const std::string& name, const hdf5::Storage& storage) {
  const std::size_t slash = name.rfind('/');
  if (slash == std::string::npos) return group.create_dataset(name, storage);
  hdf5::Group folder = make_group(group, name.substr(0, slash));
  return folder.create_dataset(name.substr(slash + 1), storage);
}

/// HDF5 storage of a dataset with this many rows.
/// @param inner sizes of the dimensions after the rows.
hdf5::Storage storage_of(hdf5::Element element, std::int64_t rows, std::span<const hdf5::Size> inner,
                         hdf5::Compression compression) {
  std::int64_t width = 1;
  for (const hdf5::Size size : inner) width *= static_cast<std::int64_t>(size);
  const bool empty = rows == 0;
  const std::int64_t chunk = empty ? chunk_rows(width) : std::min(rows, chunk_rows(width));
  hdf5::Storage storage{
      element, {static_cast<hdf5::Size>(rows)}, {static_cast<hdf5::Size>(chunk)}, empty, compression};
  for (const hdf5::Size size : inner) {
    storage.extent.push_back(size);
    storage.chunk.push_back(std::min(size, static_cast<hdf5::Size>(chunk_elements)));
  }
  return storage;
}

/// Creates the HDF5 dimension scale `column` with `size` values, or opens it if another table of the group
/// has made it.
hdf5::Dataset make_scale(hdf5::Group& group, const Column& column, std::int64_t size) {
  if (group.contains(column.name)) return group.open_dataset(column.name);
  hdf5::Dataset scale = group.create_dataset(column.name, scale_storage(column, size));
  scale.make_scale(column.name);
  describe(scale, column);
  return scale;
}

void write_numbers(hdf5::Dataset& scale, std::int64_t size, std::int64_t first_value,
                   timeline::Timeline* timeline = nullptr) {
  constexpr std::int64_t numbers_at_once = 32 * chunk_elements;  // chunks that several threads encode
  std::vector<std::int64_t> numbers;
  for (std::int64_t first = 0; first < size; first += numbers_at_once) {
    const std::int64_t count = std::min(numbers_at_once, size - first);
    numbers.resize(static_cast<std::size_t>(count));
    std::iota(numbers.begin(), numbers.end(), first_value + first);
    hdf5::write_rows({{hdf5::RowsToWrite{&scale, first, count, numbers.data()}}}, timeline);
  }
}

}  // namespace

std::int64_t chunk_rows(std::int64_t width) {
  return std::max<std::int64_t>(1, chunk_elements / width);
}

hdf5::Storage scale_storage(const Column& scale, std::int64_t size) {
  return storage_of(scale.element, size, {}, hdf5::Compression::deflate);
}

hdf5::Storage column_storage(const Table& table, const Column& column, std::int64_t rows, std::int64_t second,
                             hdf5::Compression compression) {
  std::vector<hdf5::Size> inner;
  if (table.second) inner.push_back(static_cast<hdf5::Size>(second));
  if (table.last) inner.push_back(table.last->values.size());
  return storage_of(column.element, rows, inner, compression);
}

TableIo TableIo::create(hdf5::Group& root, const Table& table, std::int64_t rows, std::int64_t second) {
  hdf5::Group group = make_group(root, table.group);
  hdf5::Dataset scale = make_scale(group, table.rows, rows);
  TableIo io(std::move(group), std::move(scale));
  io.rows_ = rows;
  if (table.second) {
    io.second_scale_ = make_scale(io.group_, *table.second, second);
    if (table.second->element == hdf5::Element::int64) write_numbers(*io.second_scale_, second, 0);
    io.add_dimension(second);
  }
  if (table.last) {
    const std::int64_t last = std::ssize(table.last->values);
    io.last_scale_ = make_scale(root, table.last->scale, last);
    if (table.last->scale.element == hdf5::Element::int64) {
      const std::vector<std::int64_t> whole(table.last->values.begin(), table.last->values.end());
      io.last_scale_->write(0, last, whole.data());
    } else {
      io.last_scale_->write(0, last, table.last->values.data());
    }
    io.add_dimension(last);
  }
  for (const Column& column : table.columns) io.add(column);
  return io;
}

TableIo TableIo::open(const hdf5::Group& root, const Table& table) {
  hdf5::Group group = root.open_group(table.group);
  hdf5::Dataset scale = group.open_dataset(table.rows.name);
  TableIo io(std::move(group), std::move(scale));
  const std::vector<hdf5::Size> rows = io.row_scale_.extent();
  if (rows.size() != 1) io.row_scale_.fail("it should have one dimension");
  io.rows_ = static_cast<std::int64_t>(rows[0]);
  const auto size_of_scale = [](const hdf5::Dataset& inner) {
    const std::vector<hdf5::Size> extent = inner.extent();
    if (extent.size() != 1 || extent[0] == 0) inner.fail("it should have one dimension, not empty");
    return static_cast<std::int64_t>(extent[0]);
  };
  if (table.second) {
    io.second_scale_ = io.group_.open_dataset(table.second->name);
    io.add_dimension(size_of_scale(*io.second_scale_));
  }
  if (table.last) {
    io.last_scale_ = root.open_dataset(table.last->scale.name);
    io.add_dimension(size_of_scale(*io.last_scale_));
  }
  std::vector<hdf5::Size> expected{static_cast<hdf5::Size>(io.rows_)};
  expected.insert(expected.end(), io.inner_extent_.begin(), io.inner_extent_.end());
  for (const Column& column : table.columns) {
    hdf5::Dataset dataset = io.group_.open_dataset(column.name);
    if (dataset.element() != column.element) dataset.fail("its elements have an unexpected type");
    if (dataset.extent() != expected) dataset.fail("its size differs from that of its axes");
    io.datasets_.push_back(std::move(dataset));
  }
  return io;
}

TableReader TableReader::open(const hdf5::Group& root, const Table& table) {
  TableIo io = TableIo::open(root, table);
  std::vector<Column> columns;
  for (hdf5::Dataset& dataset : io.datasets_)
    columns.push_back(std::make_shared<const hdf5::Dataset>(std::move(dataset)));
  return {io.rows_, io.width_, std::make_shared<const hdf5::Dataset>(std::move(io.row_scale_)),
          std::move(columns)};
}

void TableIo::add_dimension(std::int64_t size) {
  inner_extent_.push_back(static_cast<hdf5::Size>(size));
  width_ *= size;
}

void require_flags(const TableReader& io, std::size_t index, std::int64_t first,
                   std::span<const std::byte> flags) {
  const auto wrong =
      std::find_if(flags.begin(), flags.end(), [](std::byte flag) { return flag > std::byte{1}; });
  if (wrong == flags.end()) return;
  io.column(index).fail(fmt::format("row {}: it is {}; expected 0 or 1",
                                    first + (wrong - flags.begin()) / io.width(),
                                    std::to_integer<int>(*wrong)));
}

hdf5::Dataset& TableIo::add(const Column& column) {
  hdf5::Dataset dataset = make_dataset(
      group_, column.name, storage_of(column.element, rows_, inner_extent_, hdf5::Compression::deflate));
  describe(dataset, column);
  dataset.attach_scale(row_scale_, 0);
  if (second_scale_) dataset.attach_scale(*second_scale_, 1);
  if (last_scale_) dataset.attach_scale(*last_scale_, static_cast<unsigned>(inner_extent_.size()));
  return datasets_.emplace_back(std::move(dataset));
}

std::vector<hdf5::FetchedRows> fetch_columns(const TableReader& io, std::int64_t first, std::int64_t rows) {
  std::vector<hdf5::FetchedRows> fetched;
  for (std::size_t index = 0; index < io.columns(); ++index)
    fetched.push_back(io.column(index).fetch(first, rows));
  return fetched;
}

std::vector<std::vector<std::byte>> decode_columns(const TableReader& io,
                                                   std::span<const hdf5::FetchedRows> fetched) {
  std::vector<std::vector<std::byte>> columns = hdf5::decode_rows(fetched);
  for (std::size_t index = 0; index < io.columns(); ++index) {
    if (io.column(index).element() == hdf5::Element::flag)
      require_flags(io, index, fetched[index].first, columns[index]);
  }
  return columns;
}

void TableIo::number_rows(std::int64_t first_value, timeline::Timeline* timeline) {
  write_numbers(row_scale_, rows_, first_value, timeline);
}

}  // namespace zerocount::layout
