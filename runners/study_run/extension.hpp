#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::study_run {

/// Copies trials of a finished file to shards of a study that differs only in having more trials: those in
/// the ranges `missing` (rows of the study). Memory is bounded.
/// @returns the written shards, in order of rows
/// @throws Failure as AllTrialsFile and write_shard.
std::vector<shards::ShardInfo> copy_trials(const reading::AllTrialsFile& file, const study::Study& study,
                                           const std::filesystem::path& directory,
                                           std::span<const layout::RowRange> missing);

}  // namespace zerocount::study_run
