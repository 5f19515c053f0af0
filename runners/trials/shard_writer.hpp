#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "analysis/summary/summed_point.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/shard.hpp"
#include "runners/trials/trial_runner.hpp"

namespace zerocount::trials {

/// Memory of a result, bytes.
std::size_t bytes_of(const shards::TrialResult& result);

/// Results of consecutive trials that go into a shard. Sums are computed only if it does not keep every
/// trial: for ten trials of each point, writing them would take longer than the trials, and statistics follow
/// from the trials anyway.
struct KeptBlock {
  layout::RowRange rows;
  std::vector<shards::TrialResult> trials;  ///< every one, or the failures, or none
  /// [point, from that of the first trial]; empty if every trial is kept
  std::vector<summary::SummedPoint> sums;
  /// [point, from that of the first trial]; empty if the sums have them
  std::vector<theory::PointPrediction> predictions;
  bool begins_turn{false};  ///< the blocks before go into a shard, without waiting for more
};

KeptBlock reduce(const study::Study& study, TrialBlock&& block);

/// Limits of a shard. The last one does not count the points of its last block.
inline constexpr std::size_t max_trials_per_shard = 1 << 16;
inline constexpr std::size_t max_bytes_per_shard = std::size_t{64} << 20;
inline constexpr std::size_t max_points_of_shard = 32;  ///< with sums

/// Collects blocks and writes them as shards: those of one turn, if they are not too large for one. A shard
/// has trials of one point, or of several points that took a turn together.
///
/// If every trial is kept, a shard ends at the end of a chunk of the results file if it can: the file then
/// takes over its compressed chunks, of all tables with a row a trial whose chunks begin where the shard
/// does. The other shards are not compressed, because their values are compressed again for the file. Trials
/// after the last whole chunk wait for the next turn, if it goes on with their point.
class ShardWriter {
 public:
  /// @param study stays as long as this
  ShardWriter(const study::Study& study, std::filesystem::path directory);

  void take(KeptBlock&& block);
  void flush();

  const std::vector<shards::ShardInfo>& written() const { return written_; }

 private:
  void append(KeptBlock&& block);
  void write_whole_chunks();
  std::int64_t rows_in_chunks() const;
  void write(std::int64_t rows);
  void write_shard(std::int64_t rows);

  const study::Study& study_;
  std::filesystem::path directory_;
  layout::Provenance provenance_;
  KeptBlock waiting_;
  std::size_t bytes_{0};  ///< of the trials that wait
  std::vector<shards::ShardInfo> written_;
};

}  // namespace zerocount::trials
