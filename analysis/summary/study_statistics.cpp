#include "analysis/summary/study_statistics.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "analysis/iso230/repeatability_file.hpp"
#include "analysis/measures/point_columns.hpp"
#include "core/failure/failure.hpp"
#include "experiments/study/study_features.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount {
namespace {

constexpr std::int64_t jerks_at_once = 65536;

[[noreturn]] void fail(const StudyFile& file, const std::string& what) {
  throw Failure(ExitCode::bad_data, fmt::format("{}: {}", file.path().string(), what));
}

/// The jerks of some trials of a file, in their order, read in blocks of fixed size: a trial that never comes
/// to rest may have thousands.
class JerkStream {
 public:
  JerkStream(const StudyFile& file, RowRange rows)
      : file_(file), end_(file.first_jerk_from(rows.end())), read_(file.first_jerk_from(rows.first)) {}

  /// The next `count` jerks, which must belong to the trial of the global row `row`. Valid until the next
  /// call.
  std::span<const Jerk> take(std::int64_t row, std::int64_t count) {
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

  const StudyFile& file_;
  std::int64_t end_;   ///< position in the table
  std::int64_t read_;  ///< likewise: of the first that is not in the block
  std::vector<JerkRecord> block_;
  std::size_t next_{0};
  std::vector<Jerk> taken_;
};

void add_trial(PointAccumulator& point, const StudyFile& file, std::int64_t row, const TrialOutcome& trial,
               JerkStream& jerk_stream) {
  std::int64_t count = 0;
  for (const MoveOutcome& move : trial.moves) count += move.jerk_count;
  const std::span<const Jerk> jerks = jerk_stream.take(row, count);
  try {
    point.add(trial, jerks);
  } catch (const Failure& failure) {
    fail(file, fmt::format("trial {}: {}", row, failure.what()));
  }
}

void require_all_trials(const StudyFile& file) {
  const FileHeader& header = file.header();
  if (file.rows() == RowRange{0, header.points * header.trials} && header.trials > 0) return;
  fail(file, fmt::format("trials {} to {}; expected all {} trials of the study", file.rows().first,
                         file.rows().end() - 1, header.points * header.trials));
}

}  // namespace

StudyAccumulator::StudyAccumulator(const Study& study, double confidence, bool bootstrap)
    : study_(study), confidence_(confidence), bootstrap_(bootstrap) {
  require_confidence(confidence);
}

void StudyAccumulator::add(const StudyFile& file, RowRange rows) {
  const std::int64_t moves = file.moves();
  const MoveKind kind{study_.open_loop, file.header().version, study_.rigs};
  JerkStream jerks(file, rows);
  TrialOutcome trial;
  const std::int64_t trials_at_once = chunk_rows(moves);
  for (std::int64_t first = rows.first; first < rows.end(); first += trials_at_once) {
    const RowRange block{first, std::min(trials_at_once, rows.end() - first)};
    const std::vector<MoveOutcome> outcomes = file.outcomes(block);
    for (std::int64_t row = block.first; row < block.end(); ++row) {
      while (!point_ || std::ssize(points_) < row / study_.trials) begin_point(kind, file.table());
      const auto begin = outcomes.begin() + (row - block.first) * moves;
      trial.moves.assign(begin, begin + moves);
      add_trial(*point_, file, row, trial, jerks);
    }
  }
  if (!jerks.at_end()) fail(file, "jerks are recorded beyond those that the trials counted");
}

void StudyAccumulator::begin_point(const MoveKind& kind, const MeasureTable& table) {
  if (point_) end_point();
  point_.emplace(kind, table);
}

void StudyAccumulator::end_point() {
  StatisticsOptions options{confidence_, {}, study_.stop.has_value()};
  if (bootstrap_) options.bootstrap = {study_.seed, static_cast<std::uint32_t>(points_.size())};
  points_.push_back(point_->statistics(options));
  point_.reset();
}

std::vector<PointSummary> StudyAccumulator::statistics() {
  if (point_) end_point();
  return std::move(points_);
}

std::vector<PointSummary> study_statistics(const StudyFile& file, const Study& study, double confidence,
                                           bool bootstrap) {
  StudyAccumulator accumulator(study, confidence, bootstrap);
  require_all_trials(file);
  accumulator.add(file, file.rows());
  return accumulator.statistics();
}

TheoryPrediction point_prediction(const Study& study, std::int64_t point, std::int64_t trials) {
  TheoryPrediction prediction;
  for (std::int64_t index = 0; index < trials; ++index)
    prediction.add(predict(study_trial(study, point, index).parameters));
  return prediction;
}

std::vector<TheoryPrediction> study_predictions(const Study& study) {
  std::vector<TheoryPrediction> predictions;
  predictions.reserve(study.point_labels.size());
  for (std::int64_t point = 0; point < point_count(study); ++point)
    predictions.push_back(point_prediction(study, point, study.trials));
  return predictions;
}

StoredStatistics stored_statistics(const StudyFile& file, const Study& study) {
  const std::vector<PointSummary> points = study_statistics(file, study);
  StoredStatistics stored;
  stored.points = point_columns(points, study_features(study), file.table());
  const std::vector<PointColumn> predictions = prediction_columns(study_predictions(study));
  stored.points.insert(stored.points.end(), predictions.begin(), predictions.end());
  if (study.open_loop) {
    stored.tables.push_back(level_table(points, file.table()));
  }
  if (!study.sequence.empty()) {
    stored.groups = [&study](hdf5::File& part) { write_repeatability(part, study); };
  }
  return stored;
}

}  // namespace zerocount
