#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "analysis/summary/summed_point.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/shard.hpp"
#include "runners/study_run/shard_clock.hpp"
#include "runners/study_run/trial_runner.hpp"

namespace zerocount::study_run {

/// The sums of consecutive trials, for a study that keeps statistics.
struct SummedBlock {
  layout::RowRange rows;
  std::vector<summary::SummedPoint> points;     ///< from that of the first trial on
  std::vector<shards::TrialResult> failures{};  ///< trials that did not succeed, if the study keeps them
};

/// A shard has the sums of no more points than this and those of a block.
inline constexpr int max_points_of_shard = 32;

SummedBlock sum_block(const study::Study& study, TrialBlock&& block);

/// Adds blocks of trials in order of rows and writes their sums as shards.
class SumsWriter {
 public:
  /// @param study stays as long as this
  SumsWriter(const study::Study& study, std::filesystem::path directory);

  void take(SummedBlock&& block);
  void flush();

  const std::vector<shards::ShardInfo>& written() const { return written_; }

 private:
  void append(SummedBlock&& block);

  const study::Study& study_;
  std::filesystem::path directory_;
  layout::Provenance provenance_;
  std::optional<SummedBlock> waiting_;
  std::size_t bytes_{0};  ///< of the failures that wait
  ShardClock clock_;
  std::vector<shards::ShardInfo> written_;
};

/// Joins such shards into the results file `output`, or a part of it.
/// @throws Failure; see merge_statistics
void assemble_statistics(std::span<const shards::ShardInfo> shards, const study::Study& study,
                         const std::filesystem::path& output, layout::RowRange rows);

}  // namespace zerocount::study_run
