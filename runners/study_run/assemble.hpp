#pragma once

#include <filesystem>
#include <span>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/concatenate.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::study_run {

/// Joins shards into the results file `output`. A file with the whole study gets the statistics of all design
/// points.
/// @throws Failure; see merge_shards.
void assemble(std::span<const shards::ShardInfo> shards, const study::Study& study,
              const std::filesystem::path& output, layout::RowRange rows,
              const shards::Renumbering& renumber = {});

}  // namespace zerocount::study_run
