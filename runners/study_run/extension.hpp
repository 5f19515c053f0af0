#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/reading/study_file.hpp"
#include "results/shards/shard.hpp"

namespace zerocount {

/// Copies the trials of a finished file into shards of a study that is the same but for more trials, as far
/// as they are `missing` there (rows of the study). Memory is bounded.
/// @returns the shards written, in order of rows.
/// @throws Failure as StudyFile and write_shard.
std::vector<ShardInfo> copy_trials(const StudyFile& file, const Study& study,
                                   const std::filesystem::path& directory, std::span<const RowRange> missing);

}  // namespace zerocount
