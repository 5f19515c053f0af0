#include "runners/trials/shard_writer.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "results/layout/table_io.hpp"

namespace zerocount::trials {
namespace {

template <class Value>
void move_behind(std::vector<Value>& values, std::vector<Value>& more) {
  values.insert(values.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

std::size_t bytes_of(const shards::TrialResult& result) {
  return sizeof result + result.inputs.size() * sizeof(double) +
         result.outcome.moves.size() * sizeof(trial::MoveOutcome) +
         result.jerks.size() * sizeof(trial::Jerk) + result.trace.size() * sizeof(trial::SampleRecord);
}

KeptBlock reduce(const study::Study& study, TrialBlock&& block) {
  KeptBlock kept{{block.results.front().row, std::ssize(block.results)}, {}, {}, {}};
  if (!layout::has_sums(study.retention)) {
    kept.trials = std::move(block.results);
    kept.predictions = std::move(block.predictions);
    return kept;
  }
  for (shards::TrialResult& result : block.results) {
    const std::int64_t point = result.row / study.trials;
    if (kept.sums.empty() || kept.sums.back().point() != point)
      kept.sums.emplace_back(study, point, result.row % study.trials);
    kept.sums.back().add(result.row, result.outcome, result.jerks);
    if (layout::has_trials(study.retention) && !trial::succeeded(result.outcome.moves))
      kept.trials.push_back(std::move(result));
  }
  for (std::size_t i = 0; i < kept.sums.size(); ++i) kept.sums[i].add(block.predictions[i]);
  return kept;
}

ShardWriter::ShardWriter(const study::Study& study, std::filesystem::path directory)
    : study_(study), directory_(std::move(directory)), provenance_(layout::current_provenance()) {}

void ShardWriter::take(KeptBlock&& block) {
  const std::int64_t point = block.rows.first / study_.trials;
  const bool ends_only_point = block.begins_turn && waiting_.rows.end() == point * study_.trials &&
                               waiting_.rows.first >= (point - 1) * study_.trials;
  if (waiting_.rows.end() != block.rows.first || ends_only_point) flush();
  if (block.begins_turn) write_whole_chunks();
  append(std::move(block));
  if (waiting_.trials.size() >= max_trials_per_shard || bytes_ >= max_bytes_per_shard ||
      waiting_.sums.size() >= max_points_of_shard)
    write_whole_chunks();
}

void ShardWriter::flush() {
  if (waiting_.rows.count > 0) write(waiting_.rows.count);
}

void ShardWriter::append(KeptBlock&& block) {
  for (const shards::TrialResult& trial : block.trials) bytes_ += bytes_of(trial);
  if (waiting_.rows.count == 0) {
    waiting_ = std::move(block);
    return;
  }
  waiting_.rows.count += block.rows.count;
  move_behind(waiting_.trials, block.trials);
  if (block.sums.empty()) return;
  const bool same_point = block.sums.front().point() == waiting_.sums.back().point();
  if (same_point) {
    waiting_.sums.back() += block.sums.front();
    block.sums.erase(block.sums.begin());
  }
  move_behind(waiting_.sums, block.sums);
}

/// Number of the waiting rows up to the end of the last whole chunk of a whole study.
std::int64_t ShardWriter::rows_in_chunks() const {
  if (!waiting_.sums.empty()) return 0;  // sums cannot be divided
  const std::int64_t end = waiting_.rows.end();
  return std::max<std::int64_t>(end - end % layout::chunk_elements - waiting_.rows.first, 0);
}

/// Writes the waiting rows: those in whole chunks, or all where no chunk is whole.
void ShardWriter::write_whole_chunks() {
  if (waiting_.rows.count == 0) return;
  const std::int64_t in_chunks = rows_in_chunks();
  write(in_chunks > 0 ? in_chunks : waiting_.rows.count);
}

/// Writes the first `count` of the waiting rows: those before several whole chunks as a shard of their own,
/// so that the chunks can be compressed.
void ShardWriter::write(std::int64_t count) {
  constexpr std::int64_t chunk = layout::chunk_elements;
  const std::int64_t before_chunks = (chunk - waiting_.rows.first % chunk) % chunk;
  const bool apart = waiting_.sums.empty() && before_chunks > 0 && count >= before_chunks + 2 * chunk;
  if (apart) write_shard(before_chunks);
  write_shard(apart ? count - before_chunks : count);
}

void ShardWriter::write_shard(std::int64_t count) {
  const layout::RowRange rows{waiting_.rows.first, count};
  const bool every_trial = waiting_.sums.empty();
  const std::int64_t trials = every_trial ? count : std::ssize(waiting_.trials);
  std::vector<layout::PointSums> sums;
  for (const summary::SummedPoint& point : waiting_.sums) sums.push_back(point.sums());
  const bool in_chunks = rows.first % layout::chunk_elements == 0 && rows_in_chunks() > 0;
  written_.push_back({shards::shard_path(directory_, rows), rows});
  shards::write_shard(written_.back().path, study_, rows,
                      std::span(waiting_.trials).first(static_cast<std::size_t>(trials)), sums,
                      {provenance_, in_chunks ? hdf5::Compression::deflate : hdf5::Compression::none});
  waiting_.rows = {rows.end(), waiting_.rows.count - count};
  waiting_.trials.erase(waiting_.trials.begin(), waiting_.trials.begin() + trials);
  waiting_.sums.clear();
  bytes_ = 0;
  for (const shards::TrialResult& trial : waiting_.trials) bytes_ += bytes_of(trial);
}

}  // namespace zerocount::trials
