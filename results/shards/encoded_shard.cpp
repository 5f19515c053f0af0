#include "results/shards/encoded_shard.hpp"

#include <numeric>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "results/hdf5/chunk_transfer.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"
#include "results/storage/checksum_trailer.hpp"

namespace zerocount::shards {
namespace {

void require_fit(const study::Study& study, layout::RowRange rows, const TrialColumns& columns,
                 std::span<const layout::PointSums> sums) {
  const bool sparse = layout::has_sums(study.retention);
  const std::int64_t points = (rows.end() - 1) / study.trials - rows.first / study.trials + 1;
  if (rows.count < 1 || rows.first < 0 || rows.end() > study::trial_count(study) ||
      (!sparse && std::ssize(columns.rows) != rows.count) || std::ssize(sums) != (sparse ? points : 0))
    throw std::invalid_argument("a shard needs trials of its study");
  std::int64_t next = rows.first;
  for (const std::int64_t row : columns.rows) {
    if (sparse ? row < next || row >= rows.end() : row != next)
      throw std::invalid_argument(fmt::format("the result for row {} does not fit the study", row));
    next = row + 1;
  }
}

/// The numbers of the rows of a table.
std::vector<std::int64_t> row_numbers(const EncodedTable& table, const std::vector<std::int64_t>& trials) {
  if (table.table.rows == ShardTable::Rows::trials) return trials;
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(table.columns.rows));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// A table with the numbers of its rows, to be encoded.
struct UnencodedTable {
  EncodedTable* table;
  std::vector<std::int64_t> numbers;  ///< empty if it shares the scale of another
};

/// Adds the columns of a table to what is encoded. False if the library must filter one of them.
bool add_rows(const UnencodedTable& one, hdf5::Compression compression,
              std::vector<hdf5::RowsToEncode>& all) {
  const layout::Table& table = one.table->table.table;
  const std::int64_t rows = one.table->columns.rows;
  const auto add = [&](const hdf5::Storage& storage, const void* data) {
    const std::optional<hdf5::ChunkShape> shape = hdf5::chunk_shape_of(storage);
    if (shape) all.push_back({*shape, rows, data});
    return shape.has_value();
  };
  const bool has_scale = one.table->table.rows != ShardTable::Rows::shared;
  if (has_scale && !add(layout::scale_storage(table.rows, rows), one.numbers.data())) return false;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const hdf5::Storage storage =
        layout::column_storage(table, table.columns[i], rows, one.table->table.second, compression);
    if (!add(storage, one.table->columns.columns[i].data())) return false;
  }
  return true;
}

/// Encodes all tables together, so that their chunks can be encoded at a time.
void encode_tables(EncodedShard& shard, hdf5::Compression compression) {
  std::vector<UnencodedTable> tables;
  std::vector<hdf5::RowsToEncode> all;
  for (EncodedTable& table : shard.tables) {
    tables.push_back({&table, {}});
    if (table.table.rows != ShardTable::Rows::shared)
      tables.back().numbers = row_numbers(table, shard.trials);
    if (!add_rows(tables.back(), compression, all)) return;
  }
  std::vector<hdf5::EncodedRows> encoded = hdf5::encode_rows(all);
  auto next = std::make_move_iterator(encoded.begin());
  for (const UnencodedTable& one : tables) {
    if (one.table->table.rows != ShardTable::Rows::shared) one.table->scale = *next++;
    const auto columns = static_cast<std::ptrdiff_t>(one.table->columns.columns.size());
    one.table->encoded.assign(next, next + columns);
    next += columns;
    one.table->columns.columns.clear();
  }
}

void write_table(hdf5::File& file, const EncodedShard& shard, const EncodedTable& table) {
  layout::TableIo io =
      layout::TableIo::create(file, table.table.table, table.columns.rows, table.table.second,
                              {shard.options.compression, table.table.described});
  if (table.scale) io.row_scale().write(0, *table.scale);
  for (std::size_t i = 0; i < table.encoded.size(); ++i) io.column(i).write(0, table.encoded[i]);
  if (!table.encoded.empty()) return;
  if (table.table.rows != ShardTable::Rows::shared)
    io.row_scale().write(0, table.columns.rows, row_numbers(table, shard.trials).data());
  std::vector<hdf5::RowsToWrite> columns;
  for (std::size_t i = 0; i < table.columns.columns.size(); ++i)
    columns.push_back({&io.column(i), 0, table.columns.rows, table.columns.columns[i].data()});
  hdf5::write_rows(columns);
}

}  // namespace

EncodedShard encode_shard(const study::Study& study, layout::RowRange rows, TrialColumns&& columns,
                          std::vector<layout::PointSums>&& sums, const ShardOptions& options) {
  require_fit(study, rows, columns, sums);
  EncodedShard shard{rows, std::move(columns.rows), {}, std::move(sums), options};
  if (!layout::has_trials(study.retention)) return shard;
  const layout::MeasureTable& measures =
      options.measures != nullptr ? *options.measures : layout::measure_table(study.features);
  std::vector<ShardTable> tables = shard_tables(study, measures);
  if (columns.tables.empty()) columns = columns_of(study, measures, {});
  for (std::size_t i = 0; i < tables.size(); ++i)
    shard.tables.push_back({std::move(tables[i]), std::move(columns.tables[i]), {}, {}});
  encode_tables(shard, options.compression);
  return shard;
}

StoredShard store_shard(const std::filesystem::path& path, const study::Study& study,
                        const EncodedShard& shard) {
  StoredShard stored{path, shard.rows, std::make_unique<storage::UnfinishedFile>(path), {}};
  hdf5::File file = hdf5::File::create(stored.part->path());
  layout::write_header(
      file, layout::make_header(study, layout::FileKind::shard, shard.rows, shard.options.provenance));
  for (const EncodedTable& table : shard.tables) write_table(file, shard, table);
  if (layout::has_sums(study.retention))
    layout::write_sums(file, shard.rows.first / study.trials, shard.sums);
  layout::mark_finished(file);
  stored.written = file.close(storage::Flush::later);
  return stored;
}

void flush_shard(const StoredShard& shard) {
  storage::synchronise(shard.part->path());
}

void publish_shard(const StoredShard& shard, timeline::Timeline* timeline) {
  storage::publish_compared(shard.path, shard.written.require_in(shard.part->path(), timeline));
}

}  // namespace zerocount::shards
