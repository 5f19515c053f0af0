#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "experiments/study/study_fwd.hpp"
#include "results/hdf5/encoded_rows.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/point_sums.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/shard.hpp"
#include "results/shards/trial_columns.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/written_bytes.hpp"

/// A shard on its way to the disk. One of the steps calls the HDF5 library, and is for one thread at a time;
/// the others are for any.
///
///     encoded = encode_shard(…)      filters the columns
///     stored = store_shard(…)        writes the file (library)
///     flush_shard(stored)            brings it to the disk
///     publish_shard(stored)          reads it from there, appends its checksum, and gives it its name
namespace zerocount::shards {

struct EncodedTable {
  ShardTable table;
  TableColumns columns;                    ///< where they are not encoded
  std::optional<hdf5::EncodedRows> scale;  ///< of its rows, if the table writes it
  std::vector<hdf5::EncodedRows> encoded;  ///< [column]; empty if the library must filter the columns
};

struct EncodedShard {
  layout::RowRange rows;
  std::vector<std::int64_t> trials;  ///< row of each trial that is kept
  std::vector<EncodedTable> tables;  ///< empty if no trial is ever kept
  std::vector<layout::PointSums> sums;
  ShardOptions options;
};

/// @param columns of what is kept of the trials `rows` @param sums as for write_shard()
/// @throws std::invalid_argument if they do not fit the rows and the study
EncodedShard encode_shard(const study::Study& study, layout::RowRange rows, TrialColumns&& columns,
                          std::vector<layout::PointSums>&& sums, const ShardOptions& options = {});

/// A shard without its checksum and its name.
struct StoredShard {
  std::filesystem::path path;
  layout::RowRange rows;
  std::unique_ptr<storage::UnfinishedFile> part;
  storage::WrittenBytes written;
};

/// @throws Failure (machine_failed) with the path and the reason
StoredShard store_shard(const std::filesystem::path& path, const study::Study& study,
                        const EncodedShard& shard);

/// @throws Failure (machine_failed) with the path and the reason
void flush_shard(const StoredShard& shard);

/// @param timeline gets the spans of what any thread does; null: none
/// @throws Failure (machine_failed) if anything that was written is missing, differs or cannot be read
void publish_shard(const StoredShard& shard, timeline::Timeline* timeline = nullptr);

}  // namespace zerocount::shards
