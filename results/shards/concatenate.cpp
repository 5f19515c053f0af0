#include "results/shards/concatenate.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <vector>

#include "results/layout/row_range.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount::shards {
namespace {

/// The rows that one shard contributes to the table.
struct Source {
  std::filesystem::path path;
  layout::RowRange rows;  ///< in the table written
};

std::vector<Source> find_sources(const layout::Table& table, std::span<const ShardInfo> shards,
                                 std::int64_t width) {
  std::vector<Source> sources;
  std::int64_t next = 0;
  for (const ShardInfo& shard : shards) {
    const hdf5::File file = hdf5::File::open_to_read(shard.path);
    const layout::TableIo io = layout::TableIo::open(file, table);
    if (io.width() != width) io.row_scale().fail("its trials have another number of moves than the study");
    sources.push_back({shard.path, {next, io.rows()}});
    next += io.rows();
  }
  return sources;
}

/// The bytes of some rows, by column.
using Block = std::vector<std::vector<std::byte>>;

/// Reads the rows of `wanted` that `source` holds into `block`.
void read_overlap(const layout::Table& table, const Source& source, layout::RowRange wanted,
                  std::int64_t width, Block& block) {
  const std::int64_t first = std::max(source.rows.first, wanted.first);
  const std::int64_t count = std::min(source.rows.end(), wanted.end()) - first;
  if (count <= 0) return;
  const hdf5::File file = hdf5::File::open_to_read(source.path);
  const layout::TableIo io = layout::TableIo::open(file, table);
  for (std::size_t index = 0; index < table.columns.size(); ++index) {
    const auto offset = static_cast<std::size_t>((first - wanted.first) * width) *
                        hdf5::size_of(table.columns[index].element);
    io.column(index).read(first - source.rows.first, count, block[index].data() + offset);
  }
}

void renumber_trials(const layout::Table& table, const Renumbering& renumber, Block& block) {
  for (std::size_t index = 0; index < table.columns.size(); ++index) {
    if (table.columns[index].name != "trial") continue;
    for (std::size_t at = 0; at < block[index].size(); at += sizeof(std::int64_t)) {
      std::int64_t row = 0;
      std::memcpy(&row, block[index].data() + at, sizeof row);
      row = renumber(row);
      std::memcpy(block[index].data() + at, &row, sizeof row);
    }
  }
}

}  // namespace

void concatenate(hdf5::File& file, const layout::Table& table, std::span<const ShardInfo> shards,
                 std::int64_t width, std::int64_t first_number, const Renumbering& renumber) {
  const std::vector<Source> sources = find_sources(table, shards, width);
  const std::int64_t rows = sources.empty() ? 0 : sources.back().rows.end();
  layout::TableIo out = layout::TableIo::create(file, table, rows, width);
  out.number_rows(first_number);
  Block block(table.columns.size());
  std::size_t next = 0;
  for (layout::RowRange wanted; wanted.first < rows; wanted.first = wanted.end()) {
    wanted.count = std::min(layout::chunk_rows(width), rows - wanted.first);
    for (std::size_t index = 0; index < block.size(); ++index) {
      block[index].resize(static_cast<std::size_t>(wanted.count * width) *
                          hdf5::size_of(table.columns[index].element));
    }
    while (sources[next].rows.end() <= wanted.first) ++next;
    for (std::size_t source = next; source < sources.size() && sources[source].rows.first < wanted.end();
         ++source) {
      read_overlap(table, sources[source], wanted, width, block);
    }
    if (renumber) renumber_trials(table, renumber, block);
    for (std::size_t index = 0; index < block.size(); ++index) {
      out.column(index).write(wanted.first, wanted.count, block[index].data());
    }
  }
}

}  // namespace zerocount::shards
