#include "results/shards/encoded_shard.hpp"

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"
#include "results/storage/output_file.hpp"

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

/// Columns that are encoded together, so that several threads can encode their chunks.
class Encoding {
 public:
  explicit Encoding(EncodedShard& shard) : shard_(shard) {}

  void add(const std::string& group, const layout::Column& column, const hdf5::Storage& storage,
           const void* data) {
    const auto rows = static_cast<std::int64_t>(storage.extent[0]);
    shard_.head.columns.push_back({group + "/" + column.name, rows, {}});
    rows_.push_back({hdf5::chunk_shape_of(storage).value(), rows, data});
  }

  void add(const layout::Table& table, std::size_t column, std::int64_t rows, std::int64_t second,
           hdf5::Compression compression, const void* data) {
    add(table.group, table.columns[column],
        layout::column_storage(table, table.columns[column], rows, second, compression), data);
  }

  void encode() {
    shard_.columns = hdf5::encode_rows(rows_);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      for (const hdf5::EncodedChunk& chunk : shard_.columns[i].chunks)
        shard_.head.columns[i].chunks.push_back(chunk->size());
  }

 private:
  EncodedShard& shard_;
  std::vector<hdf5::RowsToEncode> rows_;
};

}  // namespace

EncodedShard encode_shard(const study::Study& study, layout::RowRange rows, TrialColumns&& columns,
                          std::vector<layout::PointSums>&& sums, const ShardOptions& options) {
  require_fit(study, rows, columns, sums);
  EncodedShard shard{rows,
                     {layout::make_header(study, layout::FileKind::shard, rows, options.provenance),
                      options.compression,
                      {}},
                     {}};
  Encoding encoding(shard);
  const layout::SumColumns all(sums);
  if (!sums.empty()) {
    const auto add = [&](const layout::Table& table, std::size_t column, const auto& values) {
      encoding.add(table, column, std::ssize(values), 1, hdf5::Compression::deflate, values.data());
    };
    add(layout::sums_table(), 0, all.whole_counts);
    add(layout::sums_table(), 1, all.real_counts);
    add(layout::whole_sums_table(), 0, all.whole);
    add(layout::real_sums_table(), 0, all.real);
  }
  if (layout::has_trials(study.retention)) {
    const layout::MeasureTable& measures =
        options.measures != nullptr ? *options.measures : layout::measure_table(study.features);
    const std::vector<ShardTable> tables = shard_tables(study, measures);
    if (columns.tables.empty()) columns.tables = columns_of(study, measures, {}).tables;
    const layout::Table& trials = tables.front().table;
    encoding.add(trials.group, trials.rows, layout::scale_storage(trials.rows, std::ssize(columns.rows)),
                 columns.rows.data());
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const TableColumns& values = columns.tables[i];
      for (std::size_t k = 0; k < values.columns.size(); ++k)
        encoding.add(tables[i].table, k, values.rows, tables[i].second, options.compression,
                     values.columns[k].data());
    }
  }
  encoding.encode();
  return shard;
}

void store_shard(const std::filesystem::path& path, const EncodedShard& shard) {
  storage::OutputFile file(path);
  file.write(reading::bytes_of(shard.head));
  for (const hdf5::EncodedRows& column : shard.columns)
    for (const hdf5::EncodedChunk& chunk : column.chunks)
      file.write(std::string_view(reinterpret_cast<const char*>(chunk->data()), chunk->size()));
  file.finish_with_checksum();
  file.publish();
}

}  // namespace zerocount::shards
