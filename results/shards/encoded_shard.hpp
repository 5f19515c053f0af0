#pragma once

#include <filesystem>
#include <vector>

#include "experiments/study/study_fwd.hpp"
#include "results/hdf5/encoded_rows.hpp"
#include "results/layout/point_sums.hpp"
#include "results/layout/row_range.hpp"
#include "results/reading/shard_file.hpp"
#include "results/shards/shard.hpp"
#include "results/shards/trial_columns.hpp"

namespace zerocount::shards {

/// A shard as it will be stored. Any thread can encode and store one.
struct EncodedShard {
  layout::RowRange rows;
  reading::ShardHead head;
  std::vector<hdf5::EncodedRows> columns;  ///< those of the head
};

/// @param columns of what is kept of the trials `rows` @param sums as for write_shard()
/// @throws std::invalid_argument if they do not fit the rows and the study
EncodedShard encode_shard(const study::Study& study, layout::RowRange rows, TrialColumns&& columns,
                          std::vector<layout::PointSums>&& sums, const ShardOptions& options = {});

/// Writes the file, brings it to the disk, reads it from there, and gives it its name.
/// @throws Failure (machine_failed) with the path and the reason
void store_shard(const std::filesystem::path& path, const EncodedShard& shard);

}  // namespace zerocount::shards
