#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <mutex>
#include <vector>

#include <oneapi/tbb/task_group.h>

#include "analysis/trials/summary/study_statistics.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "experiments/study/study.hpp"
#include "results/hdf5/element.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/shards/shard.hpp"
#include "results/shards/trial_columns.hpp"
#include "results/timeline/timeline.hpp"
#include "runners/trials/trial_runner.hpp"

namespace zerocount::trials {

/// Memory that the result of one trial takes, bytes.
std::size_t bytes_of(const shards::TrialResult& result);

/// Data of a block of consecutive trials, reduced to what goes into a shard file. Sums are computed only if
/// the shard does not keep every trial. If it does, the statistics follow from the trials, and for points
/// with about ten trials, writing sums would take longer than the trials.
struct KeptBlock {
  layout::RowRange rows;
  /// Trials whose data are stored, as the study asks: all, only the failures, or none.
  shards::TrialColumns trials;
  /// [design point, starting with the point of the block's first trial] Sums over the trials; empty if every
  /// trial is kept.
  std::vector<summary::SummedPoint> sums;
  /// [design point, starting with the point of the block's first trial] Predictions by theory; empty if the
  /// sums contain them.
  std::vector<theory::PointPrediction> predictions;
  /// Whether the block is the first of another design point's turn. The blocks before it then go into a shard
  /// file without waiting for more.
  bool begins_turn{false};
};

/// Reduces the results of a block of trials to the data that the study stores.
KeptBlock reduce(const study::Study& study, TrialBlock&& block);

/// Maximum number of trials of a shard file.
inline constexpr std::size_t max_trials_per_shard = 3 << 14;
/// Maximum size of a shard file, bytes.
inline constexpr std::size_t max_bytes_per_shard = std::size_t{64} << 20;
/// Maximum number of design points of a shard with sums. The points of its last block are not counted.
inline constexpr std::size_t max_points_of_shard = 32;

/// Contents of a shard, a file with the results of consecutive trials.
struct ShardContents {
  layout::RowRange rows;
  /// Stored trials of each block of the shard, in ascending order of rows.
  std::vector<shards::TrialColumns> trials;
  std::vector<summary::SummedPoint> sums;
  hdf5::Compression compression{hdf5::Compression::none};
};

/// Encodes the contents of a shard file. This takes most of the time of writing a shard, and may run on any
/// thread.
shards::EncodedShard encoded(const study::Study& study, const layout::Provenance& provenance,
                             ShardContents&& contents);

/// Divides finished blocks of trials among shard files. The blocks of one turn (the time in which the trials
/// of one design point run) go into one shard, unless they are too large for it. A shard has trials of one
/// point, or of several points that took a turn together.
///
/// If every trial is kept, a shard ends at the end of a chunk of the results file whenever possible. The
/// results file then takes over the compressed chunks of all tables that have one row per trial and whose
/// chunks begin where the shard begins. Other shards are not compressed, because their values are compressed
/// again for the file. Trials after the last whole chunk wait for the next turn, if this turn continues with
/// their point.
class ShardCollector {
 public:
  /// @param study study whose trials are collected; must outlive this object
  explicit ShardCollector(const study::Study& study) : study_(study) {}

  /// Adds a finished block of trials to the waiting ones. A block must not cross the end of a chunk of the
  /// results file.
  void take(KeptBlock&& block);
  /// Ends the last shard, with all blocks that still wait.
  void flush();
  /// Contents of the shards that have ended since the last call, in the order in which they ended.
  std::vector<ShardContents> ended();

 private:
  void append(KeptBlock&& block);
  void end_whole_chunks();
  std::int64_t rows_in_chunks() const;
  void end(std::int64_t rows);
  void end_shard(std::int64_t rows);

  const study::Study& study_;
  layout::RowRange rows_;          ///< Rows (trials) of the waiting blocks, which are not yet in a shard.
  std::vector<KeptBlock> blocks_;  ///< Finished blocks of trials that wait for a shard, without their sums.
  std::vector<summary::SummedPoint> sums_;  ///< Sums of the design points of the waiting blocks.
  std::size_t trials_{0};  ///< Number of stored trials in the waiting blocks, which are not yet in a shard.
  std::size_t bytes_{0};   ///< Memory of the kept trials in the waiting blocks, bytes.
  std::vector<ShardContents> ended_;
};

/// Writes shard files while trials still run. Each shard is written in a task, so that no block of trials
/// waits for it. If several shards are being written already, because trials are faster than the disk, the
/// caller writes the next one itself. This bounds the memory.
class ShardWriter {
 public:
  /// @param study must outlive this object
  /// @param directory folder of the shards; must outlive this object
  /// @param timeline records the times of the stages, must outlive this object; null: not recorded
  ShardWriter(const study::Study& study, const std::filesystem::path& directory,
              timeline::Timeline* timeline);
  ShardWriter(const ShardWriter&) = delete;
  ShardWriter& operator=(const ShardWriter&) = delete;
  /// Waits until the shards that tasks are writing are complete.
  ~ShardWriter();

  /// Throws if writing an earlier shard has failed.
  /// @throws the failure of an earlier shard
  void require_working();
  /// Begins to write a shard in a task. Writes it in the calling thread if several shards are being written.
  /// @throws Failure (machine_failed) if this shard or an earlier one cannot be written
  void write(ShardContents&& contents);
  /// Waits until all shards are written.
  /// @returns the shards in ascending order of rows
  /// @throws Failure as write()
  std::vector<shards::ShardInfo> finish();

 private:
  void write_shard(ShardContents&& contents);
  /// Waits for all tasks that write shards.
  /// @throws the first failure of a task
  void wait();

  const study::Study& study_;
  const std::filesystem::path& directory_;
  timeline::Timeline* timeline_;
  layout::Provenance provenance_;
  std::mutex mutex_;  ///< Protects the members declared after it.
  std::vector<shards::ShardInfo> written_;
  std::atomic<int> in_work_{0};          ///< Number of shards that tasks are writing at the moment.
  std::atomic<bool> has_failed_{false};  ///< Whether a task that writes a shard has failed.
  std::exception_ptr failure_;  ///< First failure of a task that writes a shard; null: none has failed.
  /// Context of the tasks. It is isolated, so that begun shards are written even if the run ends with an
  /// exception.
  oneapi::tbb::task_group_context context_{oneapi::tbb::task_group_context::isolated};
  oneapi::tbb::task_group tasks_{context_};
};

}  // namespace zerocount::trials
