#include "analysis/trials/summary/study_statistics.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <iterator>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "analysis/basis/statistics/sums/state.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::summary {
namespace {

constexpr std::int64_t jerks_at_once = 65536;
constexpr std::int64_t points_of_block = 32;  // whose sums take 30 kB each

[[noreturn]] void fail(const reading::AllTrialsFile& file, const std::string& what) {
  throw Failure(ExitCode::bad_data, fmt::format("{}: {}", file.path().string(), what));
}

/// Reads the jerks (excursions of the error from 0 after arrival) of some trials of a file, in their order.
/// They are read in blocks of fixed size, because a trial that never comes to rest may have thousands.
class JerkStream {
 public:
  JerkStream(const reading::AllTrialsFile& file, layout::RowRange rows)
      : file_(file), end_(file.first_jerk_from(rows.end())), read_(file.first_jerk_from(rows.first)) {}

  /// The next `count` jerks, which must belong to the trial of the global row `row`. Valid until the next
  /// call.
  std::span<const trial::Jerk> take(std::int64_t row, std::int64_t count) {
    taken_.clear();
    while (static_cast<std::int64_t>(taken_.size()) < count) {
      if (next_ == block_.size() && !refill()) fail(file_, fmt::format("trial {}: jerks are missing", row));
      if (block_[next_].trial != row) {
        fail(file_, fmt::format("trial {}: {} jerks recorded; expected the {} it counted", row, taken_.size(),
                                count));
      }
      taken_.push_back(block_[next_++]);
    }
    return taken_;
  }

  bool at_end() { return next_ == block_.size() && !refill(); }

 private:
  bool refill() {
    block_.clear();
    next_ = 0;
    while (block_.empty() && read_ < end_) {  // a block may have only jerks of other settings
      const std::int64_t count = std::min(jerks_at_once, end_ - read_);
      block_ = file_.jerks_at(read_, count);
      read_ += count;
    }
    return !block_.empty();
  }

  const reading::AllTrialsFile& file_;
  std::int64_t end_;   ///< Index, in the file's table of jerks, one past the last jerk of the trials.
  std::int64_t read_;  ///< Index, in the file's table of jerks, of the first jerk that was not read yet.
  std::vector<layout::JerkRecord> block_;
  std::size_t next_{0};
  std::vector<trial::Jerk> taken_;
};

/// The measures of the file that are summed: those of Wanted::measures, or all.
const layout::MeasureTable& measures_in(const reading::AllTrialsFile& file, const Wanted& wanted) {
  return wanted.measures != nullptr ? *wanted.measures : file.table();
}

std::int64_t jerks_of(std::span<const trial::MoveOutcome> moves) {
  std::int64_t count = 0;
  for (const trial::MoveOutcome& move : moves) count += move.jerk_count;
  return count;
}

/// The trials in one chunk (compressed unit) of a file. All blocks in the same chunk share this object.
struct Chunk {
  reading::StoredOutcomes stored;
  std::once_flag once;
  reading::OutcomeColumns columns;
};

/// Consecutive trials in one chunk of a file, with the state of their summation.
struct Block {
  layout::RowRange rows;
  std::shared_ptr<Chunk> chunk;
  std::vector<std::int64_t> jerk_counts;  ///< [trial] Number of jerks.
  std::vector<trial::Jerk> jerks;         ///< Jerks of the trials, kept until they are summed.
  /// [i] Sums of the i-th design point that has trials in the block, counted from the point of the first
  /// trial.
  std::vector<SummedPoint> sums;
  bool is_summed{false};
  std::exception_ptr failure;  ///< Exception that prevented the sums; otherwise null.
};

/// The sums of the trials `rows` of a file, in blocks that pass through the stages one after the other:
///
///     fetch     one block at a time: if the block begins a chunk, read the bytes of the chunk
///     decode    any thread: decode the bytes, and count the jerks of each trial
///     add_jerks one block at a time, in order: read the jerks; if they are many, sum the block at once
///     sum       any thread: sum the trials at each point
///     gather    one block at a time, in order: collect the sums of several blocks
///     add       any thread: add the collected sums; one thread: add the results to the sums of all trials
///
/// A block has all trials of a chunk, or those of some points. A failure is stored in its block and thrown
/// when the sums are taken in order, so the failure of the first trial is reported.
class BlockStages {
 public:
  /// @param file, study, wanted must outlive this object
  BlockStages(const reading::AllTrialsFile& file, const study::Study& study, const Wanted& wanted,
              layout::RowRange rows)
      : file_(file), study_(study), wanted_(wanted), rows_(rows), end_(rows.end()), jerks_(file, rows) {}

  /// The next block of trials; null after the last block, or after a failure.
  std::shared_ptr<Block> fetch() {
    if (rows_.count == 0 || has_failed_ || wanted_.stop.stop_requested()) return nullptr;
    if (chunk_rows_.count == 0) {
      const timeline::TimeSpan span(wanted_.timeline, "fetch", timeline::Work::serial);
      const std::lock_guard lock(library_);
      chunk_rows_ = measures::rows_of_first_chunk(file_, rows_);
      chunk_ = std::make_shared<Chunk>();
      chunk_->stored = file_.stored_outcomes(chunk_rows_);
    }
    const std::int64_t end = (rows_.first / study_.trials + points_of_block) * study_.trials;
    auto block = std::make_shared<Block>();
    block->rows = {rows_.first, std::min(chunk_rows_.count, end - rows_.first)};
    block->chunk = chunk_;
    rows_ = {block->rows.end(), rows_.count - block->rows.count};
    chunk_rows_ = {rows_.first, chunk_rows_.count - block->rows.count};
    if (chunk_rows_.count == 0) chunk_.reset();
    return block;
  }

  void decode(Block& block) const {
    const timeline::TimeSpan span(wanted_.timeline, "decode", timeline::Work::parallel, block.rows.count);
    keep_failure(block, [&] {
      Chunk& chunk = *block.chunk;
      std::call_once(chunk.once, [&] {
        chunk.columns = file_.decoded(chunk.stored);
        chunk.stored = {};
      });
      block.jerk_counts = file_.jerk_counts(chunk.columns, block.rows);
    });
  }

  void add_jerks(Block& block) {
    const timeline::TimeSpan span(wanted_.timeline, "jerks", timeline::Work::serial, block.rows.count);
    if (has_failed_ || block.failure) {
      has_failed_ = true;
      return;
    }
    keep_failure(block, [&] { take_jerks(block); });
    if (!block.failure) return;
    has_failed_ = true;
    // Impossible outcomes are said before the jerks that they do not have.
    const std::exception_ptr of_jerks = std::exchange(block.failure, nullptr);
    keep_failure(block, [&] { file_.outcomes(block.chunk->columns, block.rows); });
    if (!block.failure) block.failure = of_jerks;
  }

  void sum(Block& block) const {
    if (block.failure || block.is_summed) return;
    const timeline::TimeSpan span(wanted_.timeline, "sum", timeline::Work::parallel, block.rows.count);
    keep_failure(block, [&] { sum(block, block.rows, block.jerks); });
    block.jerks = {};
    block.chunk.reset();
  }

 private:
  template <class Stage>
  static void keep_failure(Block& block, const Stage& stage) {
    try {
      stage();
    } catch (const Failure&) {
      block.failure = std::current_exception();
    }
  }

  void take_jerks(Block& block) {
    const std::lock_guard lock(library_);
    const std::int64_t first = block.rows.first;
    layout::RowRange rows{first, 0};  // whose jerks are in the block and not summed
    for (const std::int64_t count : block.jerk_counts) {
      const auto jerks = jerks_.take(rows.end(), count);
      block.jerks.insert(block.jerks.end(), jerks.begin(), jerks.end());
      ++rows.count;
      block.is_summed = block.is_summed || std::ssize(block.jerks) >= jerks_at_once;
      const bool sums_now = std::ssize(block.jerks) >= jerks_at_once || rows.end() == block.rows.end();
      if (!block.is_summed || !sums_now) continue;
      sum(block, rows, block.jerks);
      block.jerks.clear();
      rows = {rows.end(), 0};
    }
    if (block.rows.end() == end_ && !jerks_.at_end())
      fail(file_, "jerks are recorded beyond those that the trials counted");
  }

  /// Adds some trials of a block to its sums, in pieces so small that their outcomes stay in the processor's
  /// cache.
  void sum(Block& block, layout::RowRange rows, std::span<const trial::Jerk> jerks) const {
    constexpr std::int64_t trials_of_piece = 512;
    for (layout::RowRange piece{rows.first, 0}; piece.first < rows.end(); piece.first = piece.end()) {
      const std::int64_t of_point = study_.trials - piece.first % study_.trials;
      const std::int64_t point = piece.first / study_.trials;
      piece.count = std::min({of_point, trials_of_piece, rows.end() - piece.first});
      if (block.sums.empty() || block.sums.back().point() != point)
        block.sums.emplace_back(study_, point, piece.first % study_.trials, measures_in(file_, wanted_));
      add_piece(block.sums.back(), piece, file_.outcomes(block.chunk->columns, piece), jerks);
    }
  }

  /// Adds the trials of a piece to the sums.
  /// @param jerks jerks from the first trial of the piece on; the jerks of the piece are removed
  void add_piece(SummedPoint& sums, layout::RowRange piece, const std::vector<trial::MoveOutcome>& outcomes,
                 std::span<const trial::Jerk>& jerks) const {
    const auto of_trial = static_cast<std::size_t>(file_.moves());
    std::span<const trial::MoveOutcome> moves(outcomes);
    for (std::int64_t row = piece.first; row < piece.end(); ++row, moves = moves.subspan(of_trial)) {
      const auto trial = moves.first(of_trial);
      const auto count = static_cast<std::size_t>(jerks_of(trial));
      try {
        sums.trials().add_counts(trial, jerks.first(count));
      } catch (const Failure& failure) {
        fail(file_, fmt::format("trial {}: {}", row, failure.what()));
      }
      jerks = jerks.subspan(count);
    }
    sums.trials().add_measures(layout::pointers_to(outcomes), of_trial);
    if (wanted_.undecided) sums.add_undecided(piece, outcomes);
    if (wanted_.predictions) sums.add(theory::prediction_of(study_, piece));
  }

  const reading::AllTrialsFile& file_;
  const study::Study& study_;
  const Wanted& wanted_;
  layout::RowRange rows_;        ///< Rows of the file that are not in a block yet.
  std::int64_t end_;             ///< One past the last row to be summed.
  layout::RowRange chunk_rows_;  ///< Rows of chunk_ that are not in a block yet.
  std::shared_ptr<Chunk> chunk_;
  JerkStream jerks_;
  std::mutex library_;  ///< Guards the library that reads files; two stages call it.
  std::atomic<bool> has_failed_{false};
};

/// Number of blocks of trials that the pipeline processes at once. Each may hold a decoded chunk, 6 MB with
/// the usual measures. Threads beyond that number help to decode.
std::size_t blocks_at_once(std::size_t threads) {
  return std::min(threads + 2, threads / 4 + 6);
}

/// Checks that the work is to go on.
/// @throws Failure (interrupted) if Wanted::stop requests an end
void require_no_stop(const Wanted& wanted) {
  if (wanted.stop.stop_requested())
    throw Failure(ExitCode::interrupted,
                  "interrupted while the statistics were computed; the finished shards are kept");
}

/// Sums of consecutive trials, one element for each design point.
using Sums = std::vector<SummedPoint>;
constexpr std::size_t sums_added_at_once = 8;

/// The sums, with consecutive elements of the same design point added together.
Sums added(Sums&& sums) {
  Sums all;
  for (SummedPoint& next : sums) {
    if (!all.empty() && next.point() == all.back().point()) {
      all.back() += next;
    } else {
      all.push_back(std::move(next));
    }
  }
  return all;
}

}  // namespace

StudyAccumulator::StudyAccumulator(const study::Study& study, const Wanted& wanted,
                                   std::function<void(PointResults&&)> take)
    : study_(study), wanted_(wanted), take_(std::move(take)), next_point_(wanted.first_point) {
  statistics::require_confidence(wanted.confidence);
}

void StudyAccumulator::add(const reading::AllTrialsFile& file, layout::RowRange rows) {
  namespace tbb = oneapi::tbb;
  using Mode = tbb::filter_mode;
  using BlockPointer = std::shared_ptr<Block>;
  BlockStages stages(file, study_, wanted_, rows);
  const auto fetch = [&](tbb::flow_control& control) {
    BlockPointer block = stages.fetch();
    if (!block) control.stop();
    return block;
  };
  const auto stage = [&](Mode mode, auto work) {
    return tbb::make_filter<BlockPointer, BlockPointer>(mode, [&stages, work](const BlockPointer& block) {
      std::invoke(work, stages, *block);
      return block;
    });
  };
  using SumsPointer = std::shared_ptr<Sums>;
  Sums waiting;
  const auto gather = [&](const BlockPointer& block) {
    if (block->failure) std::rethrow_exception(block->failure);
    waiting.insert(waiting.end(), std::make_move_iterator(block->sums.begin()),
                   std::make_move_iterator(block->sums.end()));
    return std::make_shared<Sums>(waiting.size() < sums_added_at_once ? Sums() : std::exchange(waiting, {}));
  };
  const auto add_gathered = [&](const SumsPointer& sums) {
    const timeline::TimeSpan span(wanted_.timeline, "add blocks", timeline::Work::parallel);
    *sums = added(std::move(*sums));
    return sums;
  };
  const auto pipeline = [&] {
    tbb::parallel_pipeline(
        blocks_at_once(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency())),
        tbb::make_filter<void, BlockPointer>(Mode::serial_in_order, fetch) &
            stage(Mode::parallel, &BlockStages::decode) &
            stage(Mode::serial_in_order, &BlockStages::add_jerks) &
            stage(Mode::parallel, static_cast<void (BlockStages::*)(Block&) const>(&BlockStages::sum)) &
            tbb::make_filter<BlockPointer, SumsPointer>(Mode::serial_in_order, gather) &
            tbb::make_filter<SumsPointer, SumsPointer>(Mode::parallel, add_gathered) &
            tbb::make_filter<SumsPointer, void>(
                Mode::serial_in_order, [&](const SumsPointer& sums) { add(std::move(*sums), file); }));
  };
  // A thread that waits here must not begin another task meanwhile, such as a block of trials.
  tbb::this_task_arena::isolate(pipeline);
  require_no_stop(wanted_);  // otherwise the trials of the blocks that were not fetched would be missing
  add(added(std::move(waiting)), file);
}

void StudyAccumulator::add(std::vector<SummedPoint>&& sums, const reading::AllTrialsFile& file) {
  const timeline::TimeSpan span(wanted_.timeline, "add sums", timeline::Work::serial);
  for (SummedPoint& next : sums) {
    SummedPoint& all = point(next.point(), measures_in(file, wanted_));
    if (all.trials().trials() == 0) {
      all = std::move(next);
    } else {
      all += next;
    }
  }
}

void StudyAccumulator::add(const reading::ResultsFile& file, std::int64_t number) {
  point(number, layout::measure_table(study_.features)) += restored_point(file, study_, number);
}

void StudyAccumulator::add(const reading::ResultsFile& file) {
  for (std::int64_t i = 0; i < file.points(); ++i) add(file, file.first_point() + i);
}

SummedPoint& StudyAccumulator::point(std::int64_t number, const layout::MeasureTable& table) {
  while (!point_ || point_->point() < number) {
    finish();
    point_.emplace(study_, next_point_++, 0, table);
  }
  return *point_;
}

void StudyAccumulator::finish() {
  if (!point_) return;
  require_no_stop(wanted_);
  const timeline::TimeSpan span(wanted_.timeline, "statistics", timeline::Work::serial);
  PointResults results;
  results.prediction = point_->prediction();
  if (wanted_.sums) results.sums = point_->sums();
  try {
    if (wanted_.statistics) results.statistics = point_->statistics(wanted_.confidence, wanted_.bootstrap);
  } catch (const std::logic_error& error) {  // of a formula whose arguments no trials give
    throw Failure(ExitCode::bad_data,
                  fmt::format("design point {}: no statistics follow from its sums, which are damaged ({})",
                              point_->point(), error.what()));
  }
  point_.reset();
  take_(std::move(results));
}

void require_all_trials(const reading::AllTrialsFile& file) {
  const layout::FileHeader& header = file.header();
  if (file.rows() == layout::RowRange{0, header.points * header.trials} && header.trials > 0) return;
  fail(file, fmt::format("trials {} to {}; expected all {} trials of the study", file.rows().first,
                         file.rows().end() - 1, header.points * header.trials));
}

std::vector<measures::PointSummary> study_statistics(const reading::AllTrialsFile& file,
                                                     const study::Study& study, const Wanted& wanted) {
  std::vector<measures::PointSummary> points;
  StudyAccumulator accumulator(study, wanted,
                               [&](PointResults&& point) { points.push_back(std::move(point.statistics)); });
  require_all_trials(file);
  accumulator.add(file, file.rows());
  accumulator.finish();
  return points;
}

measures::PointSummary point_statistics(const reading::AllTrialsFile& file, const study::Study& study,
                                        std::int64_t point, Wanted wanted) {
  measures::PointSummary statistics;
  wanted.first_point = point;
  StudyAccumulator accumulator(study, wanted,
                               [&](PointResults&& results) { statistics = std::move(results.statistics); });
  accumulator.add(file, file.rows_of(point));
  accumulator.finish();
  return statistics;
}

}  // namespace zerocount::summary
