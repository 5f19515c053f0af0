#include "analysis/summary/study_statistics.hpp"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "analysis/iso230/results_group.hpp"
#include "analysis/measures/point_columns.hpp"
#include "analysis/measures/trial_value.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::summary {
namespace {

constexpr std::int64_t jerks_at_once = 65536;
constexpr std::int64_t points_of_block = 32;  // whose sums take 30 kB each

[[noreturn]] void fail(const reading::AllTrialsFile& file, const std::string& what) {
  throw Failure(ExitCode::bad_data, fmt::format("{}: {}", file.path().string(), what));
}

/// The jerks of some trials of a file, in their order, read in blocks of fixed size: a trial that never comes
/// to rest may have thousands.
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
    while (block_.empty() && read_ < end_) {  // a block may have only jerks of other conditions
      const std::int64_t count = std::min(jerks_at_once, end_ - read_);
      block_ = file_.jerks_at(read_, count);
      read_ += count;
    }
    return !block_.empty();
  }

  const reading::AllTrialsFile& file_;
  std::int64_t end_;   ///< position in the table
  std::int64_t read_;  ///< index of the first jerk that is not in the block
  std::vector<layout::JerkRecord> block_;
  std::size_t next_{0};
  std::vector<trial::Jerk> taken_;
};

std::int64_t jerks_of(std::span<const trial::MoveOutcome> moves) {
  std::int64_t count = 0;
  for (const trial::MoveOutcome& move : moves) count += move.jerk_count;
  return count;
}

/// Trials of a file that follow one another, in one chunk.
struct Block {
  layout::RowRange rows;
  std::span<const trial::MoveOutcome> moves;  ///< [trial, move], of the chunk
  std::vector<trial::Jerk> jerks;
  std::shared_ptr<const std::vector<trial::MoveOutcome>> chunk;
};

/// Divides the trials `rows` of a file into blocks: the chunks of the file, or parts with not too many jerks
/// and points.
class BlockReader {
 public:
  /// @param trials at each point
  BlockReader(const reading::AllTrialsFile& file, layout::RowRange rows, std::int64_t trials)
      : file_(file), trials_(trials), rows_(rows), jerks_(file, rows) {}

  std::optional<Block> next() {
    if (rows_.count == 0) return std::nullopt;
    if (unread_.empty()) read_chunk();
    const auto moves = static_cast<std::size_t>(file_.moves());
    Block block{{rows_.first, 0}, unread_, {}, chunk_};
    const std::int64_t end = (rows_.first / trials_ + points_of_block) * trials_;
    while (!unread_.empty() && block.rows.end() < end && std::ssize(block.jerks) < jerks_at_once) {
      const auto jerks = jerks_.take(block.rows.end(), jerks_of(unread_.first(moves)));
      block.jerks.insert(block.jerks.end(), jerks.begin(), jerks.end());
      unread_ = unread_.subspan(moves);
      ++block.rows.count;
    }
    block.moves = block.moves.first(block.moves.size() - unread_.size());
    rows_ = {block.rows.end(), rows_.count - block.rows.count};
    if (rows_.count == 0 && !jerks_.at_end())
      fail(file_, "jerks are recorded beyond those that the trials counted");
    return block;
  }

 private:
  void read_chunk() {
    chunk_ = std::make_shared<std::vector<trial::MoveOutcome>>(
        file_.outcomes(measures::rows_of_first_chunk(file_, rows_)));
    unread_ = *chunk_;
  }

  const reading::AllTrialsFile& file_;
  std::int64_t trials_;
  layout::RowRange rows_;  ///< in no block yet
  JerkStream jerks_;
  std::shared_ptr<const std::vector<trial::MoveOutcome>> chunk_;
  std::span<const trial::MoveOutcome> unread_;  ///< of the chunk, in no block yet
};

/// The sums of the trials of a block at one point. @param moves, jerks of the block from there on
SummedPoint sums_of(const reading::AllTrialsFile& file, const study::Study& study, const Wanted& wanted,
                    layout::RowRange rows, std::span<const trial::MoveOutcome>& moves,
                    std::span<const trial::Jerk>& jerks) {
  const auto of_trial = static_cast<std::size_t>(file.moves());
  const auto of_rows = moves.first(static_cast<std::size_t>(rows.count) * of_trial);
  SummedPoint sums(study, rows.first / study.trials, rows.first % study.trials, file.header().version,
                   file.table());
  for (std::int64_t row = rows.first; row < rows.end(); ++row, moves = moves.subspan(of_trial)) {
    const auto trial = moves.first(of_trial);
    const auto count = static_cast<std::size_t>(jerks_of(trial));
    try {
      sums.trials().add_counts(trial, jerks.first(count));
    } catch (const Failure& failure) {
      fail(file, fmt::format("trial {}: {}", row, failure.what()));
    }
    jerks = jerks.subspan(count);
  }
  sums.trials().add_measures(of_rows, of_trial);
  if (wanted.undecided) sums.add_undecided(rows, of_rows);
  if (wanted.predictions) sums.add(theory::prediction_of(study, rows));
  return sums;
}

/// The sums of a block, [point, from that of the first trial], or why there are none.
struct BlockSums {
  std::vector<SummedPoint> points{};
  std::exception_ptr failure{};
};

BlockSums sums_of(const reading::AllTrialsFile& file, const study::Study& study, const Wanted& wanted,
                  const Block& block) {
  BlockSums sums;
  std::span<const trial::MoveOutcome> moves = block.moves;
  std::span<const trial::Jerk> jerks = block.jerks;
  try {
    for (layout::RowRange rows{block.rows.first, 0}; rows.first < block.rows.end(); rows.first = rows.end()) {
      rows.count = std::min(study.trials - rows.first % study.trials, block.rows.end() - rows.first);
      sums.points.push_back(sums_of(file, study, wanted, rows, moves, jerks));
    }
  } catch (const Failure&) {
    sums.failure = std::current_exception();
  }
  return sums;
}

}  // namespace

StudyAccumulator::StudyAccumulator(const study::Study& study, const Wanted& wanted,
                                   std::function<void(PointResults&&)> take)
    : study_(study), wanted_(wanted), take_(std::move(take)), next_point_(wanted.first_point) {
  statistics::require_confidence(wanted.confidence);
}

void StudyAccumulator::add(const reading::AllTrialsFile& file, layout::RowRange rows) {
  namespace tbb = oneapi::tbb;
  BlockReader reader(file, rows, study_.trials);
  const auto read = [&](tbb::flow_control& control) -> std::shared_ptr<Block> {
    std::optional<Block> block = reader.next();
    if (!block) {
      control.stop();
      return nullptr;
    }
    return std::make_shared<Block>(std::move(*block));
  };
  const auto sum = [&](const std::shared_ptr<Block>& block) {
    return std::make_shared<BlockSums>(sums_of(file, study_, wanted_, *block));
  };
  const auto add_sums = [&](const std::shared_ptr<BlockSums>& sums) {
    if (sums->failure) std::rethrow_exception(sums->failure);  // here, so that it is that of the first trial
    for (SummedPoint& next : sums->points) {
      SummedPoint& all = point(next.point(), file.header().version, file.table());
      if (all.trials().trials() == 0) {
        all = std::move(next);
      } else {
        all += next;
      }
    }
  };
  const auto pipeline = [&] {
    tbb::parallel_pipeline(
        2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()),
        tbb::make_filter<void, std::shared_ptr<Block>>(tbb::filter_mode::serial_in_order, read) &
            tbb::make_filter<std::shared_ptr<Block>, std::shared_ptr<BlockSums>>(tbb::filter_mode::parallel,
                                                                                 sum) &
            tbb::make_filter<std::shared_ptr<BlockSums>, void>(tbb::filter_mode::serial_in_order, add_sums));
  };
  // A thread that waits here must not begin another task meanwhile, such as a block of trials.
  tbb::this_task_arena::isolate(pipeline);
}

void StudyAccumulator::add(const reading::ResultsFile& file, std::int64_t number) {
  point(number, layout::format_version, layout::measure_table(study_.features)) +=
      restored_point(file, study_, number);
}

void StudyAccumulator::add(const reading::ResultsFile& file) {
  for (std::int64_t i = 0; i < file.points(); ++i) add(file, file.first_point() + i);
}

SummedPoint& StudyAccumulator::point(std::int64_t number, std::int64_t version,
                                     const layout::MeasureTable& table) {
  while (!point_ || point_->point() < number) {
    finish();
    point_.emplace(study_, next_point_++, 0, version, table);
  }
  return *point_;
}

void StudyAccumulator::finish() {
  if (!point_) return;
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
