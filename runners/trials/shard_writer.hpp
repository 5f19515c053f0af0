#pragma once

#include <atomic>
#include <exception>
#include <filesystem>
#include <mutex>
#include <vector>

#include <oneapi/tbb/task_group.h>

#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "results/shards/shard.hpp"
#include "results/timeline/timeline.hpp"
#include "runners/trials/shard_collector.hpp"

namespace zerocount::trials {

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

  /// Locked while the library of the files is called.
  std::mutex& library() { return library_; }

 private:
  void write_shard(ShardContents&& contents);
  /// For all tasks. @throws the first failure
  void wait();

  const study::Study& study_;
  const std::filesystem::path& directory_;
  timeline::Timeline* timeline_;
  layout::Provenance provenance_;
  std::mutex library_;
  std::vector<shards::ShardInfo> written_;  ///< with the library
  std::atomic<int> in_work_{0};             ///< by tasks
  std::atomic<bool> has_failed_{false};     ///< a task
  std::exception_ptr failure_;              ///< the first one of a task
  /// Shards that have begun are written when the run ends with an exception.
  oneapi::tbb::task_group_context context_{oneapi::tbb::task_group_context::isolated};
  oneapi::tbb::task_group tasks_{context_};
};

}  // namespace zerocount::trials
