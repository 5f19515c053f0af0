#pragma once

#include <filesystem>
#include <functional>
#include <span>

#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/shards/merge.hpp"

namespace zerocount::testing {

/// Function that computes the statistics of all design points from a file that has all trials.
using StatisticsOfPoints = std::function<layout::StoredStatistics(const reading::AllTrialsFile&)>;

/// Merges shards to a results file.
/// @param statistics computes the statistics of a whole study that keeps every trial; may be empty
void merge_shards(std::span<const shards::ShardInfo> shards, const study::Study& study,
                  const std::filesystem::path& output, layout::RowRange rows,
                  const StatisticsOfPoints& statistics = {}, const shards::MergeOptions& options = {});

}  // namespace zerocount::testing
