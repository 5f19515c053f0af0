#include "analysis/study_statistics.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "analysis/assurance_section.hpp"
#include "analysis/level_statistics.hpp"
#include "analysis/point_accumulator.hpp"
#include "analysis/point_columns.hpp"
#include "analysis/repeatability_file.hpp"
#include "analysis/repeatability_summary.hpp"
#include "analysis/stopping_section.hpp"
#include "analysis/study_features.hpp"
#include "analysis/undecided.hpp"
#include "core/failure.hpp"
#include "experiments/language/manifest_keys.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount {
namespace {

constexpr std::int64_t jerks_at_once = 65536;

[[noreturn]] void fail(const StudyFile& file, const std::string& what) {
  throw Failure(ExitCode::bad_data, fmt::format("{}: {}", file.path().string(), what));
}

/// The jerks of a file, in the order of its trials, read in blocks of fixed size: a trial that never comes to
/// rest may have thousands.
class JerkStream {
 public:
  explicit JerkStream(const StudyFile& file) : file_(file), total_(file.jerk_count()) {}

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

  bool at_end() const { return next_ == block_.size() && read_ == total_; }

 private:
  bool refill() {
    const std::int64_t count = std::min(jerks_at_once, total_ - read_);
    block_ = file_.jerks_at(read_, count);
    read_ += count;
    next_ = 0;
    return !block_.empty();
  }

  const StudyFile& file_;
  std::int64_t total_;
  std::int64_t read_{0};
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

/// The hold of the moves at a point, s; NaN where trials differ in it.
double hold_of(const Study& study, std::int64_t point) {
  constexpr double differs = std::numeric_limits<double>::quiet_NaN();
  if (study.open_loop) return differs;
  const bool recorded = std::any_of(study.input_columns.begin(), study.input_columns.end(),
                                    [](const InputColumn& column) { return column.name == "command.hold"; });
  const double hold = study_trial(study, point, 0).parameters.command.hold;
  constexpr std::int64_t looked_at = 64;  // a hold that is drawn differs long before
  for (std::int64_t index = 1; recorded && index < std::min(looked_at, study.trials); ++index) {
    if (study_trial(study, point, index).parameters.command.hold != hold) return differs;
  }
  return hold;
}

}  // namespace

std::vector<PointSummary> study_statistics(const StudyFile& file, const Study& study, double confidence,
                                           bool bootstrap) {
  require_confidence(confidence);
  require_all_trials(file);
  const std::int64_t trials = file.header().trials;
  const std::int64_t moves = file.moves();
  std::vector<PointSummary> points;
  const MoveKind kind{study.open_loop, file.final_error_known(), study.rigs};
  PointAccumulator point(kind);
  JerkStream jerks(file);
  TrialOutcome trial;
  const std::int64_t trials_at_once = chunk_rows(moves);
  for (std::int64_t first = 0; first < file.rows().end(); first += trials_at_once) {
    const RowRange block{first, std::min(trials_at_once, file.rows().end() - first)};
    const std::vector<MoveOutcome> outcomes = file.outcomes(block);
    for (std::int64_t row = block.first; row < block.end(); ++row) {
      const auto begin = outcomes.begin() + (row - block.first) * moves;
      trial.moves.assign(begin, begin + moves);
      add_trial(point, file, row, trial, jerks);
      if ((row + 1) % trials != 0) continue;
      StatisticsOptions options{confidence, {}, study.stop.has_value()};
      if (bootstrap) options.bootstrap = {study.seed, static_cast<std::uint32_t>(points.size())};
      points.push_back(std::exchange(point, PointAccumulator(kind)).statistics(options));
    }
  }
  if (!jerks.at_end()) fail(file, "jerks are recorded beyond those that the trials counted");
  return points;
}

std::vector<TheoryPrediction> study_predictions(const Study& study) {
  std::vector<TheoryPrediction> predictions(study.point_labels.size());
  for (std::int64_t point = 0; point < point_count(study); ++point) {
    for (std::int64_t index = 0; index < study.trials; ++index) {
      predictions[static_cast<std::size_t>(point)].add(predict(study_trial(study, point, index).parameters));
    }
  }
  return predictions;
}

StoredStatistics stored_statistics(const StudyFile& file, const Study& study) {
  const std::vector<PointSummary> points = study_statistics(file, study);
  StoredStatistics stored;
  stored.points = point_columns(points, study_features(study));
  const std::vector<PointColumn> predictions = prediction_columns(study_predictions(study));
  stored.points.insert(stored.points.end(), predictions.begin(), predictions.end());
  if (study.open_loop) {
    stored.tables.push_back(level_table(points));
  }
  if (!study.sequence.empty()) {
    stored.groups = [&study](hdf5::File& part) { write_repeatability(part, study); };
  }
  return stored;
}

StudySummary summarise(const StudyFile& file, double confidence, bool bootstrap) {
  const FileHeader& header = file.header();
  const Study study = recorded_study(header, file.path());
  StudySummary summary;
  summary.name = header.name;
  summary.labels = file.point_labels();
  summary.axes = file.axes();
  summary.observed = study.observed;
  summary.confidence = confidence;
  summary.points = study_statistics(file, study, confidence, bootstrap);
  for (std::size_t point = 0; point < summary.points.size(); ++point)
    summary.points[point].hold = hold_of(study, static_cast<std::int64_t>(point));
  const std::vector<UndecidedMoves> undecided = undecided_moves(file, study);
  for (std::size_t point = 0; point < summary.points.size(); ++point)
    summary.points[point].undecided = undecided[point];
  summary.predictions = predictions_of(file.statistics(), header.trials, file.path());
  summary.features = study_features(study);
  summary.design = design_words()[static_cast<std::size_t>(study.design)];
  if (!study.open_loop) summary.sections.push_back(undecided_section(summary.points, summary.labels));
  if (!study.sequence.empty()) {
    summary.sections.push_back(
        repeatability_section(study_repeatability(file, study, confidence), summary.labels));
  }
  if (study.stop) {
    summary.sections.push_back(stopping_section(summary.points, summary.labels, *study.stop, confidence));
  }
  // It counts independent trials.
  if (!study.open_loop && !summary.features.dependent_trials) {
    summary.sections.push_back(assurance_section(summary.points, summary.labels));
  }
  return summary;
}

}  // namespace zerocount
