#include "analysis/summary/study_statistics.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_invoke.h>

#include "analysis/iso230/results_group.hpp"
#include "analysis/measures/point_columns.hpp"
#include "analysis/measures/trial_value.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::summary {
namespace {

constexpr std::int64_t jerks_at_once = 65536;
constexpr std::int64_t trials_of_task = 1024;

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

void add_trial(SummedPoint& point, const reading::AllTrialsFile& file, std::int64_t row,
               std::span<const trial::MoveOutcome> moves, JerkStream& jerk_stream) {
  std::int64_t count = 0;
  for (const trial::MoveOutcome& move : moves) count += move.jerk_count;
  const std::span<const trial::Jerk> jerks = jerk_stream.take(row, count);
  try {
    point.trials().add_counts(moves, jerks);
  } catch (const Failure& failure) {
    fail(file, fmt::format("trial {}: {}", row, failure.what()));
  }
}

/// Adds the trials `rows` of the file, all of one design point, with these moves.
void add_trials(SummedPoint& point, const reading::AllTrialsFile& file, layout::RowRange rows,
                std::span<const trial::MoveOutcome> moves, JerkStream& jerks) {
  const auto moves_of_trial = static_cast<std::size_t>(file.moves());
  const auto add_counts = [&] {
    std::span<const trial::MoveOutcome> rest = moves;
    for (std::int64_t row = rows.first; row < rows.end(); ++row) {
      add_trial(point, file, row, rest.first(moves_of_trial), jerks);
      rest = rest.subspan(moves_of_trial);
    }
  };
  if (rows.count < trials_of_task) {  // tasks would take longer
    add_counts();
    point.trials().add_measures(moves, moves_of_trial);
  } else {
    oneapi::tbb::parallel_invoke(add_counts,
                                 [&] { point.trials().add_measures_in_tasks(moves, moves_of_trial); });
  }
}

}  // namespace

StudyAccumulator::StudyAccumulator(const study::Study& study, const Wanted& wanted,
                                   std::function<void(PointResults&&)> take)
    : study_(study), wanted_(wanted), take_(std::move(take)), next_point_(wanted.first_point) {
  statistics::require_confidence(wanted.confidence);
}

void StudyAccumulator::add(const reading::AllTrialsFile& file, layout::RowRange rows) {
  JerkStream jerks(file, rows);
  using Outcomes = std::span<const trial::MoveOutcome>;
  measures::visit_blocks(file, rows, [&](layout::RowRange block, Outcomes rest) {
    for (layout::RowRange of_point{block.first, 0}; of_point.first < block.end();
         of_point.first = of_point.end()) {
      of_point.count = std::min(study_.trials - of_point.first % study_.trials, block.end() - of_point.first);
      const auto count = static_cast<std::size_t>(of_point.count * file.moves());
      SummedPoint& sums = point(of_point.first / study_.trials, file.header().version, file.table());
      add_trials(sums, file, of_point, rest.first(count), jerks);
      if (wanted_.undecided) sums.add_undecided(of_point, rest.first(count));
      if (wanted_.predictions) sums.add(theory::prediction_of(study_, of_point));
      rest = rest.subspan(count);
    }
  });
  if (!jerks.at_end()) fail(file, "jerks are recorded beyond those that the trials counted");
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
