#include "runners/trials/shard_writer.hpp"

#include <cstdint>
#include <exception>
#include <memory>
#include <string_view>
#include <utility>

#include "results/shards/encoded_shard.hpp"

namespace zerocount::trials {
namespace {

constexpr int max_shards_in_work = 2;

}  // namespace

ShardWriter::ShardWriter(const study::Study& study, const std::filesystem::path& directory,
                         timeline::Timeline* timeline)
    : study_(study), directory_(directory), timeline_(timeline), provenance_(layout::current_provenance()) {}

ShardWriter::~ShardWriter() {
  tasks_.wait();  // no exception leaves a task
}

void ShardWriter::require_working() {
  if (has_failed_) wait();
}

void ShardWriter::write(ShardContents&& contents) {
  require_working();
  if (in_work_ >= max_shards_in_work) return write_shard(std::move(contents));
  ++in_work_;
  tasks_.run([this, shared = std::make_shared<ShardContents>(std::move(contents))] {
    try {
      write_shard(std::move(*shared));
    } catch (...) {
      const std::lock_guard lock(library_);
      if (!failure_) failure_ = std::current_exception();
      has_failed_ = true;
    }
    --in_work_;
  });
}

std::vector<shards::ShardInfo> ShardWriter::finish() {
  wait();
  shards::sort_by_rows(written_);
  return std::move(written_);
}

void ShardWriter::wait() {
  tasks_.wait();
  if (failure_) std::rethrow_exception(failure_);
}

/// Any thread; what calls the library, one thread at a time.
void ShardWriter::write_shard(ShardContents&& contents) {
  const std::int64_t trials = contents.rows.count;
  const auto timed = [&](std::string_view name, timeline::Work work, const auto& step) {
    const timeline::TimeSpan span(timeline_, name, work, trials);
    return step();
  };
  using timeline::Work;
  shards::StoredShard stored;
  {
    const shards::EncodedShard shard =
        timed("encode", Work::parallel, [&] { return encoded(study_, provenance_, std::move(contents)); });
    const std::lock_guard lock(library_);
    stored = timed("store", Work::serial, [&] {
      return shards::store_shard(shards::shard_path(directory_, shard.rows), study_, shard);
    });
  }
  timed("flush", Work::parallel, [&] { shards::flush_shard(stored); });
  {
    const std::lock_guard lock(library_);
    timed("read back", Work::serial, [&] { shards::require_stored(stored, timeline_); });
  }
  timed("publish", Work::parallel, [&] { shards::publish_shard(stored); });
  const std::lock_guard lock(library_);
  written_.push_back({stored.path, stored.rows});
}

}  // namespace zerocount::trials
