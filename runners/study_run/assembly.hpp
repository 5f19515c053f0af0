#pragma once

#include <filesystem>
#include <span>
#include <stop_token>

#include "analysis/theory/theory_prediction.hpp"
#include "experiments/study/study_fwd.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/concatenate.hpp"
#include "results/shards/shard.hpp"
#include "results/timeline/timeline.hpp"

namespace zerocount::study_run {

struct AssembleSettings {
  std::span<const theory::PointPrediction> predictions{};  ///< see theory::study_predictions
  shards::Renumbering renumber{};                          ///< see shards::MergeOptions
  std::stop_token stop{};
  timeline::Timeline* timeline{nullptr};  ///< gets spans of the stages; null: none
};

/// Joins shards into the results file `output`. A file with the whole study gets the statistics of all design
/// points.
/// @throws Failure; see MergedFile.
void assemble(std::span<const shards::ShardInfo> shards, const study::Study& study,
              const std::filesystem::path& output, layout::RowRange rows,
              const AssembleSettings& settings = {});

}  // namespace zerocount::study_run
