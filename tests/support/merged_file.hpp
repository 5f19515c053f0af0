#pragma once

#include <filesystem>
#include <functional>
#include <span>

#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/shards/merge.hpp"

namespace zerocount::testing {

/// The statistics of all points of a file that holds all trials.
using StatisticsOfPoints = std::function<layout::StoredStatistics(const reading::AllTrialsFile&)>;

/// Makes the results file from shards.
/// @param statistics statistics of a whole study that keeps every trial; may be empty
void merge_shards(std::span<const shards::ShardInfo> shards, const study::Study& study,
                  const std::filesystem::path& output, layout::RowRange rows,
                  const StatisticsOfPoints& statistics = {}, const shards::MergeOptions& options = {});

}  // namespace zerocount::testing
