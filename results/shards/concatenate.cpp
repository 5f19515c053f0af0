#include "results/shards/concatenate.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "core/failure/failure.hpp"
#include "results/hdf5/encoded_rows.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/shard_file.hpp"

namespace zerocount::shards {
namespace {

/// The rows that one shard contributes to the table that is written.
struct Source {
  std::filesystem::path path;
  layout::RowRange rows;  ///< Rows in the table that is written
};

/// Number of elements in one row of the table's columns.
/// @param width size of the second dimension
std::int64_t elements_of_row(const layout::Table& table, std::int64_t width) {
  return table.last ? width * std::ssize(table.last->values) : width;
}

/// Opens the table in a shard or in a part. `file` keeps a part open while the table is read.
layout::TableReader open_table(const std::filesystem::path& path, const layout::Table& table,
                               std::int64_t width, std::optional<hdf5::File>& file) {
  if (reading::is_shard(path))
    return reading::ShardFile(path, layout::Checksum::not_yet).open(table, table.second ? width : 1);
  file.emplace(hdf5::File::open_to_read(path));
  return layout::TableReader::open(*file, table);
}

std::vector<Source> find_sources(const layout::Table& table, std::span<const ShardInfo> shards,
                                 std::int64_t width) {
  std::vector<Source> sources;
  std::int64_t next = 0;
  for (const ShardInfo& shard : shards) {
    std::optional<hdf5::File> file;
    const layout::TableReader io = open_table(shard.path, table, width, file);
    if (io.width() != elements_of_row(table, width))
      io.row_scale().fail("its trials have another number of moves than the study");
    sources.push_back({shard.path, {next, io.rows()}});
    next += io.rows();
  }
  return sources;
}

/// Some rows of a table, as the bytes of each column, [column].
using Block = std::vector<std::vector<std::byte>>;

/// The shards' tables, as one sequence of rows. The table read last stays open, because the next rows are
/// mostly in it, too.
class Sources {
 public:
  /// @param width size of the second dimension.
  /// @param chunk number of rows in a chunk (stored block) of the table that is written.
  Sources(const layout::Table& table, std::span<const ShardInfo> shards, std::int64_t width,
          std::int64_t chunk)
      : table_(table), sources_(find_sources(table, shards, width)), width_(width), chunk_(chunk) {}

  std::int64_t rows() const { return sources_.empty() ? 0 : sources_.back().rows.end(); }

  /// Copies the rows `wanted` of all columns to `out` without decoding them.
  /// @returns false if that is not possible, because they are not whole chunks of one shard.
  bool copy_chunks(layout::RowRange wanted, layout::TableIo& out, timeline::Timeline* timeline) {
    const std::size_t index = index_of(wanted.first);
    const Source& source = sources_[index];
    if (!may_be_chunks_of(source, wanted)) return false;
    const std::vector<hdf5::FetchedRows> fetched =
        layout::fetch_columns(open(index), wanted.first - source.rows.first, wanted.count);
    for (std::size_t column = 0; column < fetched.size(); ++column)
      if (fetched[column].chunks.empty() || out.column(column).chunk_shape() != fetched[column].shape)
        return false;
    const std::vector<hdf5::EncodedRows> stored = hdf5::stored_rows(fetched, timeline);
    for (std::size_t column = 0; column < stored.size(); ++column)
      out.column(column).write(wanted.first, stored[column]);
    return true;
  }

  /// Whether copy_chunks() may be able to copy these rows. They must not lie before the rows of earlier
  /// calls.
  bool may_copy(layout::RowRange wanted) const {
    std::size_t index = next_;
    while (sources_[index].rows.end() <= wanted.first) ++index;
    return may_be_chunks_of(sources_[index], wanted);
  }

  /// Reads and decodes the rows `wanted` of all columns.
  Block read(layout::RowRange wanted, timeline::Timeline* timeline) {
    Block block(table_.columns.size());
    for (std::size_t index = index_of(wanted.first);
         index < sources_.size() && sources_[index].rows.first < wanted.end(); ++index) {
      const Source& source = sources_[index];
      const std::int64_t first = std::max(source.rows.first, wanted.first);
      const std::int64_t count = std::min(source.rows.end(), wanted.end()) - first;
      if (count <= 0) continue;
      const Block some =
          hdf5::decode_rows(layout::fetch_columns(open(index), first - source.rows.first, count), timeline);
      for (std::size_t column = 0; column < block.size(); ++column)
        block[column].insert(block[column].end(), some[column].begin(), some[column].end());
    }
    return block;
  }

 private:
  bool may_be_chunks_of(const Source& source, layout::RowRange wanted) const {
    return wanted.end() <= source.rows.end() && (wanted.first - source.rows.first) % chunk_ == 0;
  }

  /// Index of the shard's entry in sources_ that holds this row.
  std::size_t index_of(std::int64_t row) {
    while (sources_[next_].rows.end() <= row) ++next_;
    return next_;
  }

  const layout::TableReader& open(std::size_t index) {
    if (open_ != index) {
      reader_.reset();
      reader_.emplace(open_table(sources_[index].path, table_, width_, file_));
      open_ = index;
    }
    return *reader_;
  }

  const layout::Table& table_;
  std::vector<Source> sources_;
  std::int64_t width_;
  std::int64_t chunk_;
  std::size_t next_{0};  ///< Index of the first entry of sources_ whose rows are still needed
  std::optional<std::size_t> open_;
  std::optional<hdf5::File> file_;
  std::optional<layout::TableReader> reader_;
};

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

/// The rows to write next, from `first` on: one chunk if it may be copied without decoding, otherwise a few
/// chunks.
layout::RowRange next_rows(const Sources& sources, std::int64_t first, std::int64_t chunk, bool copies) {
  constexpr std::int64_t max_chunks = 8;
  const auto chunk_from = [&](std::int64_t row) {
    return layout::RowRange{row, std::min(chunk, sources.rows() - row)};
  };
  layout::RowRange rows = chunk_from(first);
  if (copies && sources.may_copy(rows)) return rows;
  while (rows.count < max_chunks * chunk && rows.end() < sources.rows()) {
    const layout::RowRange next = chunk_from(rows.end());
    if (copies && sources.may_copy(next)) break;
    rows.count += next.count;
  }
  return rows;
}

/// Writes rows of all columns to the table, one chunk of each column after the other.
void write_block(layout::TableIo& out, layout::RowRange rows, const Block& block,
                 timeline::Timeline* timeline) {
  const std::int64_t chunk = layout::chunk_rows(out.width());
  std::vector<hdf5::RowsToWrite> all;
  for (std::int64_t first = 0; first < rows.count; first += chunk) {
    for (std::size_t index = 0; index < block.size(); ++index) {
      const auto row_size = block[index].size() / static_cast<std::size_t>(rows.count);
      all.push_back({&out.column(index), rows.first + first, std::min(chunk, rows.count - first),
                     block[index].data() + static_cast<std::size_t>(first) * row_size});
    }
  }
  hdf5::write_rows(all, timeline);
}

}  // namespace

void concatenate(hdf5::File& file, const layout::Table& table, std::span<const ShardInfo> shards,
                 std::int64_t width, std::optional<std::int64_t> first_number, const JoinOptions& options) {
  const Renumbering& renumber = options.renumber;
  const std::int64_t elements = elements_of_row(table, width);
  const std::int64_t chunk = layout::chunk_rows(elements);
  Sources sources(table, shards, width, chunk);
  layout::TableIo out = layout::TableIo::create(file, table, sources.rows(), width);
  if (first_number) out.number_rows(*first_number, options.timeline);
  for (layout::RowRange wanted; wanted.first < sources.rows(); wanted.first = wanted.end()) {
    if (options.stop.stop_requested())
      throw Failure(ExitCode::interrupted, "interrupted while the shards were joined; they are kept");
    wanted = next_rows(sources, wanted.first, chunk, !renumber);
    if (!renumber && wanted.count <= chunk && sources.copy_chunks(wanted, out, options.timeline)) continue;
    Block block = sources.read(wanted, options.timeline);
    if (renumber) renumber_trials(table, renumber, block);
    write_block(out, wanted, block, options.timeline);
  }
}

}  // namespace zerocount::shards
