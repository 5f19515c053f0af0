#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <mutex>
#include <vector>

#include <oneapi/tbb/task_group.h>

#include "analysis/summary/study_statistics.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "experiments/study/study.hpp"
#include "results/hdf5/element.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/shards/shard.hpp"
#include "results/shards/trial_columns.hpp"
#include "results/timeline/timeline.hpp"
#include "runners/trials/trial_runner.hpp"

namespace zerocount::trials {

/// Memory of a result, bytes.
std::size_t bytes_of(const shards::TrialResult& result);

/// What a shard gets of consecutive trials. Sums are computed only if it does not keep every trial: for ten
/// trials of each point, writing them would take longer than the trials, and statistics follow from the
/// trials anyway.
struct KeptBlock {
  layout::RowRange rows;
  shards::TrialColumns trials;  ///< every one, or the failures, or none
  /// [point, from that of the first trial]; empty if every trial is kept
  std::vector<summary::SummedPoint> sums;
  /// [point, from that of the first trial]; empty if the sums have them
  std::vector<theory::PointPrediction> predictions;
  bool begins_turn{false};  ///< the blocks before go into a shard, without waiting for more
};

KeptBlock reduce(const study::Study& study, TrialBlock&& block);

/// Limits of a shard. The last one does not count the points of its last block.
inline constexpr std::size_t max_trials_per_shard = 3 << 14;
inline constexpr std::size_t max_bytes_per_shard = std::size_t{64} << 20;
inline constexpr std::size_t max_points_of_shard = 32;  ///< with sums

/// What goes into a shard.
struct ShardContents {
  layout::RowRange rows;
  std::vector<shards::TrialColumns> trials;  ///< of the blocks, in order of rows
  std::vector<summary::SummedPoint> sums;
  hdf5::Compression compression{hdf5::Compression::none};
};

/// Encodes the contents of a shard, which takes most of the time of writing one, on any thread.
shards::EncodedShard encoded(const study::Study& study, const layout::Provenance& provenance,
                             ShardContents&& contents);

/// Divides blocks among shards: those of one turn go into one, if they are not too large for one. A shard
/// has trials of one point, or of several points that took a turn together.
///
/// If every trial is kept, a shard ends at the end of a chunk of the results file if it can: the file then
/// takes over its compressed chunks, of all tables with a row a trial whose chunks begin where the shard
/// does. The other shards are not compressed, because their values are compressed again for the file. Trials
/// after the last whole chunk wait for the next turn, if it goes on with their point.
class ShardCollector {
 public:
  /// @param study stays as long as this
  explicit ShardCollector(const study::Study& study) : study_(study) {}

  /// Takes a block, none of which goes beyond the end of a chunk.
  void take(KeptBlock&& block);
  /// Ends the last shard.
  void flush();
  /// The shards that have ended since the last call, in the order in which they did.
  std::vector<ShardContents> ended();

 private:
  void append(KeptBlock&& block);
  void end_whole_chunks();
  std::int64_t rows_in_chunks() const;
  void end(std::int64_t rows);
  void end_shard(std::int64_t rows);

  const study::Study& study_;
  layout::RowRange rows_;                   ///< of the blocks that wait
  std::vector<KeptBlock> blocks_;           ///< that wait, without their sums
  std::vector<summary::SummedPoint> sums_;  ///< of their points
  std::size_t trials_{0};                   ///< that they keep
  std::size_t bytes_{0};                    ///< of those
  std::vector<ShardContents> ended_;
};

/// Writes shards beside the trials that still run: each in a task, so that no block of trials waits for one.
/// If several are being written already, because trials are faster than the disk, the caller writes the next
/// one itself, which bounds the memory.
class ShardWriter {
 public:
  /// @param study, directory, timeline stay as long as this; timeline null: none
  ShardWriter(const study::Study& study, const std::filesystem::path& directory,
              timeline::Timeline* timeline);
  ShardWriter(const ShardWriter&) = delete;
  ShardWriter& operator=(const ShardWriter&) = delete;
  /// Waits for the shards that are being written.
  ~ShardWriter();

  /// @throws the failure of an earlier shard
  void require_working();
  /// @throws Failure (machine_failed) if this shard or an earlier one cannot be written
  void write(ShardContents&& contents);
  /// Waits for all shards. @returns them in order of rows. @throws as write()
  std::vector<shards::ShardInfo> finish();

 private:
  void write_shard(ShardContents&& contents);
  /// For all tasks. @throws the first failure
  void wait();

  const study::Study& study_;
  const std::filesystem::path& directory_;
  timeline::Timeline* timeline_;
  layout::Provenance provenance_;
  std::mutex mutex_;  ///< for what follows
  std::vector<shards::ShardInfo> written_;
  std::atomic<int> in_work_{0};          ///< by tasks
  std::atomic<bool> has_failed_{false};  ///< a task
  std::exception_ptr failure_;           ///< the first one of a task
  /// Shards that have begun are written when the run ends with an exception.
  oneapi::tbb::task_group_context context_{oneapi::tbb::task_group_context::isolated};
  oneapi::tbb::task_group tasks_{context_};
};

}  // namespace zerocount::trials
