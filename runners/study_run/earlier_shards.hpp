#pragma once

#include <filesystem>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/shard.hpp"

namespace zerocount {

/// What earlier runs left in the folder of shards.
struct EarlierShards {
  std::vector<ShardInfo> usable;           ///< in order of rows, none overlapping another
  std::vector<std::filesystem::path> all;  ///< every sound shard of the study
};

/// Shards of a run of other parts may reach beyond this one's, or overlap: what is left out is run again.
EarlierShards choose_shards(const std::vector<ShardInfo>& sound, RowRange wanted);

/// What becomes of the shards of another run.
enum class ForeignShards { refuse, remove };

/// The shards of earlier runs. Damaged ones are set aside, and run again.
/// @throws Failure (bad_input) where the folder holds shards of something else, which are to be left alone.
EarlierShards earlier_shards(const std::filesystem::path& directory, const Study& study, RowRange wanted,
                             ForeignShards foreign = ForeignShards::refuse);

/// Removes the shards, whose trials the finished file holds or another run can make again, and their folder
/// if nothing else is in it.
void remove_shards(const std::filesystem::path& directory, const std::vector<std::filesystem::path>& shards);

}  // namespace zerocount
