#include "analysis/summary/study_statistics.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/parallel_reduce.h>

#include "analysis/iso230/repeatability_file.hpp"
#include "analysis/measures/point_columns.hpp"
#include "analysis/measures/trial_value.hpp"
#include "analysis/summary/observed_comparison.hpp"
#include "core/failure/failure.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount::summary {
namespace {

constexpr std::int64_t jerks_at_once = 65536;
constexpr std::int64_t trials_of_task = 1024;

[[noreturn]] void fail(const reading::StudyFile& file, const std::string& what) {
  throw Failure(ExitCode::bad_data, fmt::format("{}: {}", file.path().string(), what));
}

/// The jerks of some trials of a file, in their order, read in blocks of fixed size: a trial that never comes
/// to rest may have thousands.
class JerkStream {
 public:
  JerkStream(const reading::StudyFile& file, layout::RowRange rows)
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

  bool at_end() const { return next_ == block_.size() && read_ == end_; }

 private:
  bool refill() {
    const std::int64_t count = std::min(jerks_at_once, end_ - read_);
    block_ = file_.jerks_at(read_, count);
    read_ += count;
    next_ = 0;
    return !block_.empty();
  }

  const reading::StudyFile& file_;
  std::int64_t end_;   ///< position in the table
  std::int64_t read_;  ///< index of the first jerk that is not in the block
  std::vector<layout::JerkRecord> block_;
  std::size_t next_{0};
  std::vector<trial::Jerk> taken_;
};

void add_trial(measures::PointAccumulator& point, const reading::StudyFile& file, std::int64_t row,
               std::span<const trial::MoveOutcome> moves, JerkStream& jerk_stream) {
  std::int64_t count = 0;
  for (const trial::MoveOutcome& move : moves) count += move.jerk_count;
  const std::span<const trial::Jerk> jerks = jerk_stream.take(row, count);
  try {
    point.add_counts(moves, jerks);
  } catch (const Failure& failure) {
    fail(file, fmt::format("trial {}: {}", row, failure.what()));
  }
}

/// Adds the trials `rows` of the file, all of one design point, with these moves.
void add_trials(measures::PointAccumulator& point, const reading::StudyFile& file, layout::RowRange rows,
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
    point.add_measures(moves, moves_of_trial);
  } else {
    oneapi::tbb::parallel_invoke(add_counts, [&] { point.add_measures_in_tasks(moves, moves_of_trial); });
  }
}

void require_all_trials(const reading::StudyFile& file) {
  const layout::FileHeader& header = file.header();
  if (file.rows() == layout::RowRange{0, header.points * header.trials} && header.trials > 0) return;
  fail(file, fmt::format("trials {} to {}; expected all {} trials of the study", file.rows().first,
                         file.rows().end() - 1, header.points * header.trials));
}

/// The trials of the worlds at each point; of an open loop none is judged.
layout::WorldCounts world_counts(std::span<const measures::PointSummary> points, const study::Study& study) {
  layout::WorldCounts counts;
  const auto of_worlds = [&](const std::optional<measures::WorldTrials>& point,
                             measures::MoveCounts measures::WorldTrials::*which,
                             std::int64_t measures::MoveCounts::*number) {
    std::vector<std::int64_t> numbers;
    if (point) {
      for (const measures::MoveCounts& world : measures::in_worlds((*point).*which))
        numbers.push_back(world.*number);
    }
    numbers.resize(static_cast<std::size_t>(study.worlds));  // none in an open loop
    return numbers;
  };
  using measures::MoveCounts;
  using measures::WorldTrials;
  for (const measures::PointSummary& point : points) {
    counts.trials.push_back(of_worlds(point.worlds, &WorldTrials::succeeded, &MoveCounts::moves));
    counts.success.push_back(of_worlds(point.worlds, &WorldTrials::succeeded, &MoveCounts::met));
    if (study.goal)
      counts.goal_met.push_back(of_worlds(point.worlds, &WorldTrials::meeting, &MoveCounts::met));
  }
  return counts;
}

/// Appends the statistics of the points that follow.
void append(layout::StoredStatistics& stored, layout::StoredStatistics&& next) {
  const auto append_to = [](auto& values, auto& more) {
    values.insert(values.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  };
  for (std::size_t i = 0; i < stored.points.size(); ++i)
    append_to(stored.points[i].values, next.points[i].values);
  for (std::size_t i = 0; i < stored.tables.size(); ++i) {
    for (std::size_t column = 0; column < stored.tables[i].columns.size(); ++column)
      append_to(stored.tables[i].columns[column].values, next.tables[i].columns[column].values);
  }
  append_to(stored.rig_successes, next.rig_successes);
  if (!stored.worlds) return;
  append_to(stored.worlds->trials, next.worlds->trials);
  append_to(stored.worlds->success, next.worlds->success);
  append_to(stored.worlds->goal_met, next.worlds->goal_met);
}

/// The statistics of all points of a file, in blocks of a chunk of the file.
class StatisticsBlocks {
 public:
  StatisticsBlocks(const reading::StudyFile& file, const study::Study& study,
                   std::span<const theory::PointPrediction> predictions)
      : file_(file),
        study_(study),
        predictions_(theory::study_predictions(study, predictions)),
        accumulator_(study, statistics::summary_confidence, false,
                     [this](measures::PointSummary&& point) { take(std::move(point)); }) {
    require_all_trials(file);
  }
  StatisticsBlocks(const StatisticsBlocks&) = delete;
  StatisticsBlocks& operator=(const StatisticsBlocks&) = delete;

  std::optional<layout::StoredStatistics> next() {
    const std::int64_t points =
        std::min(layout::chunk_elements, file_.header().points - next_row_ / study_.trials);
    if (points == 0) return std::nullopt;
    const layout::RowRange rows{next_row_, points * study_.trials};
    accumulator_.add(file_, rows);
    accumulator_.finish();
    next_row_ = rows.end();
    store();
    return std::exchange(block_, std::nullopt);
  }

 private:
  static constexpr std::size_t points_at_once = 256;  ///< that are kept with all their statistics

  void take(measures::PointSummary&& point) {
    points_.push_back(std::move(point));
    if (points_.size() == points_at_once) store();
  }

  /// Adds the kept points to the block.
  void store() {
    if (points_.empty()) return;
    const auto first = static_cast<std::size_t>(stored_);
    layout::StoredStatistics stored = stored_statistics(
        points_, study_, std::span(predictions_).subspan(first, points_.size()), file_.table(), stored_);
    if (block_) {
      append(*block_, std::move(stored));
    } else {
      block_ = std::move(stored);
    }
    stored_ += std::ssize(points_);
    points_.clear();
  }

  const reading::StudyFile& file_;
  const study::Study& study_;
  std::vector<theory::PointPrediction> predictions_;  ///< [point]
  StudyAccumulator accumulator_;
  std::int64_t next_row_{0};
  std::int64_t stored_{0};  ///< points
  std::vector<measures::PointSummary> points_;
  std::optional<layout::StoredStatistics> block_;
};

}  // namespace

StudyAccumulator::StudyAccumulator(const study::Study& study, double confidence, bool bootstrap,
                                   std::function<void(measures::PointSummary&&)> take)
    : study_(study), confidence_(confidence), bootstrap_(bootstrap), take_(std::move(take)) {
  if (!take_) take_ = [this](measures::PointSummary&& point) { points_.push_back(std::move(point)); };
  statistics::require_confidence(confidence);
}

measures::PointSummary point_statistics(const reading::StudyFile& file, const study::Study& study,
                                        std::int64_t point, double confidence, bool bootstrap) {
  const layout::RowRange rows = file.rows_of(point);
  measures::PointAccumulator trials(measures::move_kind(study, file.header().version), file.table());
  JerkStream jerks(file, rows);
  measures::visit_blocks(file, rows, [&](layout::RowRange block, std::span<const trial::MoveOutcome> moves) {
    add_trials(trials, file, block, moves, jerks);
  });
  measures::StatisticsOptions options{confidence, {}, study.stop.has_value()};
  if (bootstrap) options.bootstrap = {study.seed, static_cast<std::uint32_t>(point)};
  return trials.statistics(options);
}

void StudyAccumulator::add(const reading::StudyFile& file, layout::RowRange rows) {
  const measures::MoveKind kind = measures::move_kind(study_, file.header().version);
  JerkStream jerks(file, rows);
  using Outcomes = std::span<const trial::MoveOutcome>;
  measures::visit_blocks(file, rows, [&](layout::RowRange block, Outcomes rest) {
    for (layout::RowRange of_point{block.first, 0}; of_point.first < block.end();
         of_point.first = of_point.end()) {
      of_point.count = std::min(study_.trials - of_point.first % study_.trials, block.end() - of_point.first);
      while (!point_ || complete_ < of_point.first / study_.trials) begin_point(kind, file.table());
      const auto count = static_cast<std::size_t>(of_point.count * file.moves());
      add_trials(*point_, file, of_point, rest.first(count), jerks);
      rest = rest.subspan(count);
    }
  });
  if (!jerks.at_end()) fail(file, "jerks are recorded beyond those that the trials counted");
}

void StudyAccumulator::begin_point(const measures::MoveKind& kind, const layout::MeasureTable& table) {
  finish();
  point_.emplace(kind, table);
}

void StudyAccumulator::end_point() {
  measures::StatisticsOptions options{confidence_, {}, study_.stop.has_value()};
  if (bootstrap_) options.bootstrap = {study_.seed, static_cast<std::uint32_t>(complete_)};
  take_(point_->statistics(options));
  ++complete_;
  point_.reset();
}

void StudyAccumulator::finish() {
  if (point_) end_point();
}

std::vector<measures::PointSummary> StudyAccumulator::statistics() {
  finish();
  return std::move(points_);
}

std::vector<measures::PointSummary> study_statistics(const reading::StudyFile& file,
                                                     const study::Study& study, double confidence,
                                                     bool bootstrap) {
  StudyAccumulator accumulator(study, confidence, bootstrap);
  require_all_trials(file);
  accumulator.add(file, file.rows());
  return accumulator.statistics();
}

layout::StoredStatistics stored_statistics(std::span<const measures::PointSummary> points,
                                           const study::Study& study,
                                           std::span<const theory::PointPrediction> predictions,
                                           const layout::MeasureTable& table, std::int64_t first) {
  layout::StoredStatistics stored;
  stored.points = measures::point_columns(points, study.features, table);
  const std::vector<layout::PointColumn> predicted = measures::prediction_columns(predictions);
  stored.points.insert(stored.points.end(), predicted.begin(), predicted.end());
  const std::vector<layout::PointColumn> observed = observed_columns(points, study, first);
  stored.points.insert(stored.points.end(), observed.begin(), observed.end());
  if (study.open_loop) stored.tables.push_back(measures::level_table(points, table));
  for (std::size_t point = 0; study.rigs > 0 && point < points.size(); ++point) {
    stored.rig_successes.push_back(points[point].rigs.successes_of_rigs);
    stored.rig_successes.back().resize(static_cast<std::size_t>(study.rigs));  // empty in an open loop
  }
  if (study.worlds > 0) stored.worlds = world_counts(points, study);
  if (!study.sequence.empty() && first == 0) {
    stored.groups = [&study](hdf5::File& part) { iso230::write_repeatability(part, study); };
  }
  return stored;
}

layout::StoredStatistics stored_statistics(const reading::StudyFile& file, const study::Study& study,
                                           std::span<const theory::PointPrediction> predictions) {
  const auto blocks = std::make_shared<StatisticsBlocks>(file, study, predictions);
  layout::StoredStatistics stored = blocks->next().value();
  stored.more = [blocks] { return blocks->next(); };
  return stored;
}

}  // namespace zerocount::summary
