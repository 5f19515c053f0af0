#include "runners/trials/shard_writer.hpp"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <iterator>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::trials {

std::size_t bytes_of(const shards::TrialResult& result) {
  return sizeof result + result.inputs.size() * sizeof(double) +
         result.outcome.moves.size() * sizeof(trial::MoveOutcome) +
         result.jerks.size() * sizeof(trial::Jerk) + result.trace.size() * sizeof(trial::SampleRecord);
}

KeptBlock reduce(const study::Study& study, TrialBlock&& block) {
  const layout::MeasureTable& measures = layout::measure_table(study.features);
  KeptBlock kept{{block.results.front().row, std::ssize(block.results)}, {}, {}, {}};
  if (!layout::has_sums(study.retention)) {
    kept.trials = shards::columns_of(study, measures, block.results);
    kept.predictions = std::move(block.predictions);
    return kept;
  }
  const std::int64_t first_point = kept.rows.first / study.trials;
  for (std::span<const shards::TrialResult> rest(block.results); !rest.empty();) {
    const std::int64_t row = rest.front().row;
    const std::int64_t point = row / study.trials;
    const auto of_point = static_cast<std::size_t>(
        std::min((point + 1) * study.trials - row, static_cast<std::int64_t>(rest.size())));
    kept.sums.emplace_back(study, point, row % study.trials).add(rest.first(of_point));
    kept.sums.back().add(block.predictions[static_cast<std::size_t>(point - first_point)]);
    rest = rest.subspan(of_point);
  }
  if (layout::has_trials(study.retention)) {
    std::erase_if(block.results,
                  [](const shards::TrialResult& result) { return trial::succeeded(result.outcome.moves); });
    kept.trials = shards::columns_of(study, measures, block.results);
  }
  return kept;
}

shards::EncodedShard encoded(const study::Study& study, const layout::Provenance& provenance,
                             ShardContents&& contents) {
  std::vector<layout::PointSums> sums;
  for (const summary::SummedPoint& point : contents.sums) sums.push_back(point.sums());
  return shards::encode_shard(study, contents.rows, shards::joined(contents.trials), std::move(sums),
                              {provenance, contents.compression});
}

void ShardCollector::take(KeptBlock&& block) {
  const std::int64_t point = block.rows.first / study_.trials;
  const bool ends_only_point =
      block.begins_turn && rows_.end() == point * study_.trials && rows_.first >= (point - 1) * study_.trials;
  if (rows_.end() != block.rows.first || ends_only_point) flush();
  if (block.begins_turn) end_whole_chunks();
  append(std::move(block));
  if (trials_ >= max_trials_per_shard || bytes_ >= max_bytes_per_shard || sums_.size() >= max_points_of_shard)
    end_whole_chunks();
}

void ShardCollector::flush() {
  if (rows_.count > 0) end(rows_.count);
}

std::vector<ShardContents> ShardCollector::ended() {
  return std::exchange(ended_, {});
}

void ShardCollector::append(KeptBlock&& block) {
  if (rows_.count == 0) rows_.first = block.rows.first;
  rows_.count += block.rows.count;
  trials_ += block.trials.rows.size();
  bytes_ += shards::bytes_of(block.trials);
  auto first = block.sums.begin();
  if (!sums_.empty() && first != block.sums.end() && first->point() == sums_.back().point())
    sums_.back() += *first++;
  sums_.insert(sums_.end(), std::make_move_iterator(first), std::make_move_iterator(block.sums.end()));
  block.sums.clear();
  blocks_.push_back(std::move(block));
}

/// Number of the waiting rows (finished trials that are not yet in a shard) up to the last boundary between
/// chunks of the results file. Chunks are counted from the first row of the study. 0 if the shard has sums.
std::int64_t ShardCollector::rows_in_chunks() const {
  if (!sums_.empty()) return 0;  // sums cannot be divided
  return std::max<std::int64_t>(rows_.end() - rows_.end() % layout::chunk_elements - rows_.first, 0);
}

/// Ends a shard with the waiting rows (finished trials) up to the last boundary between chunks of the results
/// file. The rows after it go on waiting. If there is no such boundary, all waiting rows go into the shard.
void ShardCollector::end_whole_chunks() {
  if (rows_.count == 0) return;
  const std::int64_t in_chunks = rows_in_chunks();
  end(in_chunks > 0 ? in_chunks : rows_.count);
}

/// Ends a shard with the first `count` of the waiting rows (finished trials). If several whole chunks of the
/// results file follow the first boundary between chunks, the rows before this boundary go into a shard of
/// their own, so that the chunks can be compressed.
void ShardCollector::end(std::int64_t count) {
  constexpr std::int64_t chunk = layout::chunk_elements;
  const std::int64_t before_chunks = (chunk - rows_.first % chunk) % chunk;
  const bool apart = sums_.empty() && before_chunks > 0 && count >= before_chunks + 2 * chunk;
  if (apart) end_shard(before_chunks);
  end_shard(apart ? count - before_chunks : count);
}

void ShardCollector::end_shard(std::int64_t count) {
  const bool in_chunks = rows_.first % layout::chunk_elements == 0 && rows_in_chunks() > 0;
  ShardContents contents{{rows_.first, count},
                         {},
                         std::exchange(sums_, {}),
                         in_chunks ? hdf5::Compression::deflate : hdf5::Compression::none};
  // A shard that does not end with the last block ends with a chunk, so with a block.
  const auto end = std::find_if(blocks_.begin(), blocks_.end(), [&](const KeptBlock& block) {
    return block.rows.first >= contents.rows.end();
  });
  for (auto block = blocks_.begin(); block != end; ++block) {
    trials_ -= block->trials.rows.size();
    bytes_ -= shards::bytes_of(block->trials);
    contents.trials.push_back(std::move(block->trials));
  }
  blocks_.erase(blocks_.begin(), end);
  rows_ = {contents.rows.end(), rows_.count - count};
  ended_.push_back(std::move(contents));
}

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
      const std::lock_guard lock(mutex_);
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

/// Encodes and writes one shard file. Any thread may call it.
void ShardWriter::write_shard(ShardContents&& contents) {
  const layout::RowRange rows = contents.rows;
  const auto timed = [&](std::string_view name, const auto& step) {
    const timeline::TimeSpan span(timeline_, name, timeline::Work::parallel, rows.count);
    return step();
  };
  const shards::EncodedShard shard =
      timed("encode", [&] { return encoded(study_, provenance_, std::move(contents)); });
  const std::filesystem::path path = shards::shard_path(directory_, rows);
  timed("store", [&] { shards::store_shard(path, shard); });
  const std::lock_guard lock(mutex_);
  written_.push_back({path, rows});
}

}  // namespace zerocount::trials
