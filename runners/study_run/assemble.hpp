#pragma once

#include <filesystem>
#include <span>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/concatenate.hpp"
#include "results/shards/shard.hpp"

namespace zerocount {

/// Joins shards into the results file `output`, with the statistics of every design point where it is the
/// whole study.
/// @throws Failure; see merge_shards.
void assemble(std::span<const ShardInfo> shards, const Study& study, const std::filesystem::path& output,
              RowRange rows, const Renumbering& renumber = {});

}  // namespace zerocount
