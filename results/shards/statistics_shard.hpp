#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "experiments/study/study.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/layout/header.hpp"
#include "results/layout/point_sums.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::shards {

/// Writes /sums. @param sums [point, from `first_point` on]
void write_sums(hdf5::File& file, std::int64_t first_point, std::span<const layout::PointSums> sums);

/// Writes the sums of the trials `rows` as one shard of a study that keeps statistics. `path` appears when
/// the shard is complete on the disk.
/// @param sums [point, from that of the first trial] @param failures the trials that did not succeed, in
/// order of rows, of a study that keeps them
/// @throws Failure (machine_failed) with the path and the reason
void write_statistics_shard(const std::filesystem::path& path, const study::Study& study,
                            layout::RowRange rows, std::span<const layout::PointSums> sums,
                            std::span<const TrialResult> failures,
                            const layout::Provenance& provenance = layout::current_provenance());

}  // namespace zerocount::shards
