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

/// Memory of a trial's result, bytes.
std::size_t bytes_of(const shards::TrialResult& result);

/// Data of consecutive trials that go into a shard. Sums are computed only if the shard does not keep every
/// trial. If it does, the statistics follow from the trials, and for points with about ten trials, writing
/// sums would take longer than the trials.
struct KeptBlock {
  layout::RowRange rows;
  shards::TrialColumns trials;  ///< Kept trials: all, the failures, or none.
  /// [point, starting with the point of the first trial] Sums; empty if every trial is kept.
  std::vector<summary::SummedPoint> sums;
  /// [point, starting with the point of the first trial] Predictions; empty if the sums contain them.
  std::vector<theory::PointPrediction> predictions;
  /// Whether a new turn begins with this block. The blocks before it then go into a shard without waiting for
  /// more.
  bool begins_turn{false};
};

/// Reduces a block to the data that the study keeps.
KeptBlock reduce(const study::Study& study, TrialBlock&& block);

/// Maximum number of trials of a shard.
inline constexpr std::size_t max_trials_per_shard = 3 << 14;
/// Maximum size of a shard, bytes.
inline constexpr std::size_t max_bytes_per_shard = std::size_t{64} << 20;
/// Maximum number of points of a shard with sums. The points of its last block are not counted.
inline constexpr std::size_t max_points_of_shard = 32;

/// Contents of a shard.
struct ShardContents {
  layout::RowRange rows;
  std::vector<shards::TrialColumns> trials;  ///< Kept trials of each block, in ascending order of rows.
  std::vector<summary::SummedPoint> sums;
  hdf5::Compression compression{hdf5::Compression::none};
};

/// Encodes the contents of a shard. This takes most of the time of writing a shard, and may run on any
/// thread.
shards::EncodedShard encoded(const study::Study& study, const layout::Provenance& provenance,
                             ShardContents&& contents);

/// Divides blocks among shards. The blocks of one turn go into one shard, unless they are too large for it. A
/// shard has trials of one point, or of several points that took a turn together.
///
/// If every trial is kept, a shard ends at the end of a chunk of the results file whenever possible. The
/// results file then takes over the compressed chunks of all tables that have one row per trial and whose
/// chunks begin where the shard begins. Other shards are not compressed, because their values are compressed
/// again for the file. Trials after the last whole chunk wait for the next turn, if this turn continues with
/// their point.
class ShardCollector {
 public:
  /// @param study must outlive this object
  explicit ShardCollector(const study::Study& study) : study_(study) {}

  /// Takes a block. A block must not cross the end of a chunk.
  void take(KeptBlock&& block);
  /// Ends the last shard.
  void flush();
  /// Shards that have ended since the last call, in the order in which they ended.
  std::vector<ShardContents> ended();

 private:
  void append(KeptBlock&& block);
  void end_whole_chunks();
  std::int64_t rows_in_chunks() const;
  void end(std::int64_t rows);
  void end_shard(std::int64_t rows);

  const study::Study& study_;
  layout::RowRange rows_;                   ///< Rows of the waiting blocks.
  std::vector<KeptBlock> blocks_;           ///< Waiting blocks, without their sums.
  std::vector<summary::SummedPoint> sums_;  ///< Sums of the points of the waiting blocks.
  std::size_t trials_{0};                   ///< Number of kept trials in the waiting blocks.
  std::size_t bytes_{0};                    ///< Memory of these trials, bytes.
  std::vector<ShardContents> ended_;
};

/// Writes shards while trials still run. Each shard is written in a task, so that no block of trials waits
/// for it. If several shards are being written already, because trials are faster than the disk, the caller
/// writes the next one itself. This bounds the memory.
class ShardWriter {
 public:
  /// @param study must outlive this object
  /// @param directory must outlive this object
  /// @param timeline must outlive this object; null: none
  ShardWriter(const study::Study& study, const std::filesystem::path& directory,
              timeline::Timeline* timeline);
  ShardWriter(const ShardWriter&) = delete;
  ShardWriter& operator=(const ShardWriter&) = delete;
  /// Waits for the shards that are being written.
  ~ShardWriter();

  /// Checks that no earlier shard has failed.
  /// @throws the failure of an earlier shard
  void require_working();
  /// Writes a shard.
  /// @throws Failure (machine_failed) if this shard or an earlier one cannot be written
  void write(ShardContents&& contents);
  /// Waits for all shards.
  /// @returns the shards in ascending order of rows
  /// @throws Failure as write()
  std::vector<shards::ShardInfo> finish();

 private:
  void write_shard(ShardContents&& contents);
  /// Waits for all tasks.
  /// @throws the first failure of a task
  void wait();

  const study::Study& study_;
  const std::filesystem::path& directory_;
  timeline::Timeline* timeline_;
  layout::Provenance provenance_;
  std::mutex mutex_;  ///< Protects the members below.
  std::vector<shards::ShardInfo> written_;
  std::atomic<int> in_work_{0};          ///< Number of shards that tasks are writing.
  std::atomic<bool> has_failed_{false};  ///< Whether a task has failed.
  std::exception_ptr failure_;           ///< First failure of a task.
  /// Context that is isolated, so that begun shards are written even if the run ends with an exception.
  oneapi::tbb::task_group_context context_{oneapi::tbb::task_group_context::isolated};
  oneapi::tbb::task_group tasks_{context_};
};

}  // namespace zerocount::trials
