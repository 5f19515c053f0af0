#include "runners/trials/block_source.hpp"

#include <algorithm>
#include <cstddef>

#include "core/trial/trial.hpp"
#include "results/layout/table_io.hpp"
#include "runners/trials/study_runner.hpp"
#include "runners/trials/trial_runner.hpp"

namespace zerocount::trials {

Turns::Turns(std::span<const layout::RowRange> ranges, std::int64_t trials) {
  std::int64_t last_point = -1;
  for (const layout::RowRange& range : ranges) {
    for (layout::RowRange rows{range.first, 0}; rows.first < range.end(); rows.first = rows.end()) {
      const std::int64_t point = rows.first / trials;
      rows.count = std::min((point + 1) * trials, range.end()) - rows.first;
      if (point != last_point) points_.push_back({trials, {}});
      points_.back().trials_run -= rows.count;
      points_.back().remaining.push_back(rows);
      last_point = point;
    }
  }
  for (std::size_t point = 0; point < points_.size(); ++point) {
    std::reverse(points_[point].remaining.begin(), points_[point].remaining.end());
    waiting_.emplace(points_[point].trials_run, point);
  }
  choose_point();
}

layout::RowRange Turns::upcoming(std::int64_t max_rows) const {
  layout::RowRange rows = points_[*current_].remaining.back();
  rows.count = std::min(rows.count, max_rows);
  bool ends_point = points_[*current_].remaining.size() == 1 && rows == points_[*current_].remaining.back();
  for (auto next = waiting_.begin(); ends_point && next != waiting_.end(); ++next) {
    const std::vector<layout::RowRange>& remaining = points_[next->second].remaining;
    ends_point = remaining.size() == 1 && remaining.back().first == rows.end() &&
                 rows.count + remaining.back().count <= max_rows;
    if (ends_point) rows.count += remaining.back().count;
  }
  return rows;
}

void Turns::take(std::int64_t count) {
  at_new_point_ = false;
  while (count > 0) {
    PointRows& point = points_[*current_];
    layout::RowRange& rows = point.remaining.back();
    const std::int64_t size = std::min(count, rows.count);
    rows = {rows.first + size, rows.count - size};
    point.trials_run += size;
    count -= size;
    if (rows.count > 0) continue;
    point.remaining.pop_back();
    at_new_point_ = point.remaining.empty();
    if (at_new_point_) choose_point();
  }
}

void Turns::end_turn() {
  if (!current_) return;
  waiting_.emplace(points_[*current_].trials_run, *current_);
  choose_point();
}

void Turns::choose_point() {
  current_.reset();
  if (waiting_.empty()) return;
  current_ = waiting_.begin()->second;
  waiting_.erase(waiting_.begin());
}

namespace {

/// Limits of a block of trials, which one thread runs in one go. A block takes a fraction of a second, so
/// that interruptions are handled quickly. The batch engine needs many trials per block, because the last
/// ones do not fill its lanes: blocks of 128 trials take 4 % longer than blocks of 1024, blocks of 64 take 17
/// % longer.
struct BlockLimits {
  double samples;  ///< Maximum number of samples of a block, over all its trials.
  std::int64_t max_trials;
  /// Minimum number of trials of a block, unless these have more than `samples` samples.
  std::int64_t min_trials;
  /// Maximum number of samples of the first blocks, before it is known how long a trial takes.
  double first_samples;
};
constexpr BlockLimits reference_block{1e5, 256, 16, 1.0};
constexpr BlockLimits batch_block{1e7, 1024, 128, 1e6};

/// Maximum time that one thread takes for a block of trials, s. It is estimated from the time per trial of
/// earlier blocks.
constexpr double max_block_seconds = 1.0;

const BlockLimits& block_limits(const study::Study& study) {
  return study.engine == study::Engine::batch ? batch_block : reference_block;
}

/// Number of rows (trials) per block if the remaining rows are divided equally into two blocks for each
/// thread; at least BlockLimits::min_trials.
std::int64_t rows_for_each(const BlockLimits& limits, std::int64_t rows, int threads) {
  return std::max(rows / (std::int64_t{2} * threads), limits.min_trials);
}

/// Number of trials that together have about this number of samples, at least one.
std::int64_t trials_with(double samples, const study::Study& study) {
  return std::max(static_cast<std::int64_t>(samples / std::max(samples_per_trial(study), 1.0)),
                  std::int64_t{1});
}

/// Maximum number of trials of a block before it is known how long a trial takes. The first blocks are
/// smaller if the SIMD lanes of the batch engine cannot run the trials, because such trials may be slow.
std::int64_t max_first_rows(const study::Study& study) {
  const bool in_lanes = study.engine == study::Engine::batch && lanes_run_first_trials(study);
  const BlockLimits& limits = in_lanes ? batch_block : reference_block;
  return std::min(trials_with(limits.first_samples, study), limits.min_trials);
}

/// Limit of the memory that the traces (all samples of retained trials) of a block take, bytes. The block
/// ends with the first trial at which its traces exceed the limit.
constexpr std::size_t max_trace_bytes_per_block = std::size_t{8} << 20;

/// Memory that the trace of one retained trial takes, bytes; 0 if the study retains no traces.
double bytes_of_trace(const study::Study& study) {
  return study.retained_trials.empty() ? 0.0 : samples_per_trial(study) * sizeof(trial::SampleRecord);
}

}  // namespace

std::int64_t max_block_rows(const study::Study& study, std::int64_t rows, int threads) {
  const BlockLimits limits = block_limits(study);
  return std::min(
      {trials_with(limits.samples, study), limits.max_trials, rows_for_each(limits, rows, threads)});
}

double max_block_traces(const study::Study& study) {
  return static_cast<double>(max_trace_bytes_per_block) + bytes_of_trace(study);
}

BlockSource::BlockSource(const study::Study& study, std::span<const layout::RowRange> ranges, int threads)
    : study_(study),
      turns_(ranges, study.trials),
      clock_(turns_.points(), threads),
      max_rows_(max_block_rows(study, layout::total_rows(ranges), threads)),
      max_first_rows_(max_first_rows(study)),
      threads_(threads),
      remaining_(layout::total_rows(ranges)),
      trace_bytes_(bytes_of_trace(study)) {}

std::optional<Block> BlockSource::next() {
  if (turns_.is_empty()) return std::nullopt;
  const bool begins_turn = clock_.progress() >= end_of_turn();
  if (begins_turn) {
    turns_.end_turn();
    clock_.begin_turn();
  }
  const std::int64_t of_chunk = layout::chunk_elements - next_row() % layout::chunk_elements;
  const std::int64_t max_rows = std::min(
      {max_rows_, max_quick_rows(), rows_for_each(block_limits(study_), remaining_, threads_), of_chunk});
  const layout::RowRange rows = with_few_traces(turns_.upcoming(max_rows));
  turns_.take(rows.count);
  remaining_ -= rows.count;
  return Block{rows, begins_turn};
}

/// Value of TurnClock::progress() at which the turn of the current design point ends before the next row
/// (trial). A turn that has finished a point ends early, so that short points share a turn, and a point that
/// takes most of a turn has a shard file of its own. Otherwise the turn ends preferably before a chunk of the
/// results file, because shards that begin with a chunk are cheap to join (shards::concatenate).
double BlockSource::end_of_turn() const {
  if (turns_.is_at_new_point()) return 0.5;
  return next_row() % layout::chunk_elements == 0 ? 1.0 : 1.5;
}

/// Number of trials that take at most max_block_seconds, estimated from the time per trial of the blocks that
/// have ended.
std::int64_t BlockSource::max_quick_rows() const {
  const double seconds = trial_seconds_;
  if (seconds == 0.0) return max_first_rows_;
  return static_cast<std::int64_t>(std::clamp(max_block_seconds / seconds, 1.0, 1e6));
}

layout::RowRange BlockSource::with_few_traces(layout::RowRange rows) const {
  double bytes = 0.0;
  for (std::int64_t i = 0; i < rows.count; ++i) {
    if (is_retained(study_, (rows.first + i) % study_.trials)) bytes += trace_bytes_;
    if (bytes > static_cast<double>(max_trace_bytes_per_block)) return {rows.first, i + 1};
  }
  return rows;
}

}  // namespace zerocount::trials
