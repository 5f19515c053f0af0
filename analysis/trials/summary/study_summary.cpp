#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/iso230/columns.hpp"
#include "analysis/trials/iso230/results_group.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/summary/study_statistics.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "analysis/trials/worlds/derived_quantities.hpp"
#include "core/failure/failure.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/header.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/pieces.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::summary {
namespace {

/// The hold (duration of a move, from one target to the next) of the moves at a design point, s; NaN if the
/// trials differ in it, or if the study is open-loop.
double hold_of(const study::Study& study, std::int64_t point) {
  if (study.open_loop) return statistics::unknown;
  const bool recorded =
      std::any_of(study.columns.inputs.begin(), study.columns.inputs.end(),
                  [](const study::InputColumn& column) { return column.name == parameter::command::hold; });
  const double hold = study::study_trial(study, point, 0).parameters.command.hold;
  constexpr std::int64_t looked_at = 64;  // a hold that is drawn differs long before
  const study::TrialIndices indices = study::trial_indices(study);
  for (std::int64_t i = 1; recorded && i < std::min(looked_at * indices.settings.total(), study.trials);
       ++i) {
    const std::int64_t index = indices.trial_of(i / indices.settings.total(), i % indices.settings.total());
    if (study::study_trial(study, point, index).parameters.command.hold != hold) return statistics::unknown;
  }
  return hold;
}

/// The unknown parameters that differ between worlds (draws of what all machines share) at a design point,
/// and the quantities derived from those of the friction.
std::vector<worlds::WorldInput> inputs_of_worlds(const study::Study& study, std::int64_t point,
                                                 const measures::PointSummary& statistics) {
  std::vector<worlds::WorldInput> inputs = worlds::unknowns_of(study, point);
  const bool friction = std::ranges::any_of(
      inputs, [](const worlds::WorldInput& input) { return input.name.starts_with("friction."); });
  if (friction && !study.open_loop)
    std::ranges::move(
        worlds::derived_of_worlds(study, point, statistics.of(&trial::MoveOutcome::holding_torque)),
        std::back_inserter(inputs));
  return inputs;
}

/// Sets the hold time of a design point and, if the study has worlds, its StudySummary::world_inputs.
void describe_point(StudySummary& summary, const study::Study& study, std::int64_t number) {
  const auto point = static_cast<std::size_t>(number);
  summary.points[point].hold = hold_of(study, number);
  if (study.worlds == 0) return;
  summary.world_inputs.resize(summary.points.size());
  summary.world_inputs[point] = inputs_of_worlds(study, number, summary.points[point]);
}

void describe_points(StudySummary& summary, const study::Study& study) {
  for (std::int64_t point = 0; point < std::ssize(summary.points); ++point)
    describe_point(summary, study, point);
}

/// Removes the labels and axis values of all but the first `points` design points.
void shorten(StudySummary& summary, std::size_t points) {
  summary.labels.resize(points);
  for (study::SweepAxis& axis : summary.axes) {
    if (axis.kind == study::SweepAxis::Kind::text) axis.texts.resize(points);
    if (axis.kind == study::SweepAxis::Kind::number) axis.numbers.resize(points);
  }
}

/// Whether the statistics of a design point need its trials from the first one on, without gaps: with
/// machines, worlds, or a design that is spread evenly.
bool depend_on_order(const study::Study& study) {
  return study.machines > 0 || study.worlds > 0 || study.design != study::Design::monte_carlo;
}

/// An accumulator that appends each completed point to the summary.
StudyAccumulator accumulator_of(const study::Study& study, StudySummary& summary, const Wanted& wanted) {
  return StudyAccumulator(study, wanted, [&summary, wanted](PointResults&& point) {
    summary.points.push_back(std::move(point.statistics));
    if (wanted.predictions) summary.predictions.push_back(point.prediction);
  });
}

/// Collects the finished trials of an unfinished study, file after file in order of rows.
class TrialsSoFar {
 public:
  TrialsSoFar(const study::Study& study, double confidence, bool bootstrap)
      : study_(study),
        in_order_(depend_on_order(study)),
        counts_(study.points.labels.size()),
        summary_(summary_without_points(study, confidence)),
        accumulator_(accumulator_of(
            study, summary_,
            {.undecided = true, .predictions = true, .confidence = confidence, .bootstrap = bootstrap})) {}
  TrialsSoFar(const TrialsSoFar&) = delete;
  TrialsSoFar& operator=(const TrialsSoFar&) = delete;

  void add(const std::filesystem::path& path) {
    constexpr auto part = reading::Require::any_part;
    if (study_.retention != study::Retention::trials) {
      const reading::ResultsFile file(path, part, nullptr, &study_);
      add(file, false, [&](std::int64_t point, layout::RowRange) { accumulator_.add(file, point); });
    } else {
      const reading::AllTrialsFile file(path, part, nullptr, &study_);
      add(file, true, [&](std::int64_t, layout::RowRange rows) { accumulator_.add(file, rows); });
    }
  }

  /// The summary of the trials taken so far; empty if no trial is finished.
  std::optional<StudySummary> summary() {
    if (count_ == 0) return std::nullopt;
    accumulator_.finish();
    shorten(summary_, summary_.points.size());
    describe_points(summary_, study_);
    summary_.unfinished = UnfinishedStudy{count_, study::trial_count(study_), study::point_count(study_)};
    return std::move(summary_);
  }

 private:
  /// Takes the trials of a file that were not taken before. If the statistics depend on the order of trials
  /// (depend_on_order()), only trials that continue those taken are used: machines then have equal numbers of
  /// trials, and a design is spread evenly.
  /// @param divisible whether some trials of a design point can be taken without its other trials
  /// @param take adds trials to the sums
  template <class Take>
  void add(const reading::ResultsFile& file, bool divisible, const Take& take) {
    for (std::int64_t i = 0; i < file.points(); ++i) {
      const std::int64_t point = file.first_point() + i;
      const layout::RowRange rows = file.rows_of(point);
      std::int64_t& count = counts_[static_cast<std::size_t>(point)];
      const std::int64_t next = in_order_ ? point * study_.trials + count : std::max(rows.first, next_row_);
      if (next < rows.first || next >= rows.end() || (next > rows.first && !divisible)) continue;
      const layout::RowRange taken{next, rows.end() - next};
      take(point, taken);
      count += taken.count;
      count_ += taken.count;
      next_row_ = taken.end();
    }
  }

  const study::Study& study_;
  bool in_order_;
  std::vector<std::int64_t> counts_;  ///< [point] Number of trials taken.
  std::int64_t count_{0};
  std::int64_t next_row_{0};  ///< Index of the study's row (trial) after those that were taken.
  StudySummary summary_;
  StudyAccumulator accumulator_;
};

StudySummary summary_of_pieces(const std::filesystem::path& output, double confidence, bool bootstrap) {
  const std::vector<std::filesystem::path> pieces = shards::finished_pieces(output);
  std::optional<study::Study> study;
  for (const std::filesystem::path& path : pieces) {
    const layout::FileHeader header = shards::inspect_header(path, layout::Checksum::not_yet);
    if (!study) study = layout::recorded_study(header, path);
    if (header.study_sha256 == study->study_sha256) continue;
    throw Failure(ExitCode::bad_data, fmt::format("{}: is from another study than the others of {}",
                                                  path.string(), output.string()));
  }
  if (study) {
    TrialsSoFar trials(*study, confidence, bootstrap);
    for (const std::filesystem::path& path : pieces) trials.add(path);
    if (std::optional<StudySummary> summary = trials.summary()) return *std::move(summary);
  }
  throw Failure(ExitCode::bad_data, fmt::format("{}: no trial of this run is finished yet", output.string()));
}

measures::PointSummary all_statistics(const reading::AllTrialsFile& file, std::int64_t point,
                                      double confidence, bool bootstrap) {
  return point_statistics(file, file.study(), point,
                          {.undecided = true, .confidence = confidence, .bootstrap = bootstrap});
}
measures::PointSummary all_statistics(const reading::ResultsFile& file, std::int64_t point, double confidence,
                                      bool bootstrap) {
  return restored_point(file, file.study(), point).statistics(confidence, bootstrap);
}

void add_predictions(StudySummary& summary, const reading::ResultsFile& file) {
  const std::vector<layout::PointColumn> columns = file.statistics();
  if (!columns.empty())
    summary.predictions = measures::predictions_of(columns, file.header().trials, file.path());
}

template <class File>
void complete(StudySummary& summary, const File& file, std::vector<std::int64_t> points, bool bootstrap) {
  for (const std::int64_t point : points) {
    summary.points[static_cast<std::size_t>(point)] =
        all_statistics(file, point, summary.confidence, bootstrap);
    describe_point(summary, file.study(), point);
  }
  summary.complete = std::move(points);
}

}  // namespace

StudySummary summary_without_points(const study::Study& study, double confidence) {
  StudySummary summary;
  summary.name = study.name;
  summary.labels = study.points.labels;
  summary.axes = study.points.axes;
  summary.observed = study.observed;
  // Trials of a saltelli design are not independent: no test applies to them.
  if (!study.features.dependent_trials) summary.observed_counts = study.observed_counts;
  summary.confidence = confidence;
  summary.features = study.features;
  summary.question = goal::question_of(study);
  summary.seed = study.seed;
  summary.design = keys::design_labels[static_cast<std::size_t>(study.design)];
  return summary;
}

StudySummary summary_without_points(const reading::ResultsFile& file, double confidence) {
  StudySummary summary = summary_without_points(file.study(), confidence);
  summary.name = file.header().name;
  summary.labels = file.point_labels();
  summary.axes = file.axes();
  return summary;
}

StudySummary summary_without_points(const reading::AllTrialsFile& file, double confidence) {
  require_all_trials(file);
  if (file.moves() != file.study().moves) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: damaged: its trials have {} moves, and its manifest {}",
                              file.path().string(), file.moves(), file.study().moves));
  }
  StudySummary summary = summary_without_points(static_cast<const reading::ResultsFile&>(file), confidence);
  summary.stop = file.study().stop;
  return summary;
}

void complete_points(StudySummary& summary, const reading::AllTrialsFile& file,
                     std::vector<std::int64_t> points, bool bootstrap) {
  complete(summary, file, std::move(points), bootstrap);
}

void complete_points(StudySummary& summary, const reading::ResultsFile& file,
                     std::vector<std::int64_t> points, bool bootstrap) {
  complete(summary, file, std::move(points), bootstrap);
}

StudySummary summarise(const reading::AllTrialsFile& file, double confidence, bool bootstrap) {
  const study::Study& study = file.study();
  StudySummary summary = summary_without_points(file, confidence);
  add_predictions(summary, file);
  summary.points =
      study_statistics(file, study, {.undecided = true, .confidence = confidence, .bootstrap = bootstrap});
  describe_points(summary, study);
  if (!study.sequence.empty()) summary.repeatability = iso230::study_repeatability(file, study, confidence);
  return summary;
}

StudySummary summarise(const reading::ResultsFile& file, double confidence, bool bootstrap) {
  const study::Study& study = file.study();
  StudySummary summary = summary_without_points(file, confidence);
  add_predictions(summary, file);
  StudyAccumulator sums = accumulator_of(study, summary, {.confidence = confidence, .bootstrap = bootstrap});
  sums.add(file);
  sums.finish();
  describe_points(summary, study);
  return summary;
}

StudySummary summarise_file(const std::filesystem::path& path, double confidence, bool bootstrap) {
  return shards::keeps_every_trial(path) ? summarise(reading::AllTrialsFile(path), confidence, bootstrap)
                                         : summarise(reading::ResultsFile(path), confidence, bootstrap);
}

void add_mean_bounds(StudySummary& summary, const std::filesystem::path& path,
                     std::span<const std::int64_t> points) {
  const auto add = [&](const auto& file) {
    for (const std::int64_t number : points) {
      measures::PointSummary& point = summary.points[static_cast<std::size_t>(number)];
      const double hold = point.hold;
      point = all_statistics(file, number, summary.confidence, true);
      point.hold = hold;
    }
  };
  if (shards::keeps_every_trial(path)) {
    add(reading::AllTrialsFile(path));
  } else {
    add(reading::ResultsFile(path));
  }
}

StudySummary summarise_unfinished(const std::filesystem::path& output, double confidence, bool bootstrap) {
  constexpr int tries = 5;
  for (int i = 1;; ++i) {
    try {
      return summary_of_pieces(output, confidence, bootstrap);
    } catch (const Failure& failure) {
      // A file that is not there was joined to others in the meantime.
      if (failure.code() != ExitCode::bad_input || i == tries || !shards::has_begun(output)) throw;
    }
  }
}

void require_consistent(const StudySummary& summary) {
  const std::size_t points = summary.points.size();
  bool consistent = summary.labels.size() == points;
  consistent = consistent && (summary.predictions.empty() || summary.predictions.size() == points);
  for (const study::SweepAxis& axis : summary.axes) {
    const bool text = axis.kind == study::SweepAxis::Kind::text;
    consistent = consistent && (text ? axis.texts.size() : axis.numbers.size()) == points;
  }
  if (!consistent) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("study {}: labels, axes and statistics are not of the same {} points",
                              text::printable(summary.name), points));
  }
}

std::string observed_at(const StudySummary& summary, std::int64_t point) {
  const auto entry = summary.observed.find(summary.labels[static_cast<std::size_t>(point)]);
  return entry != summary.observed.end() ? entry->second : std::string{};
}

std::vector<std::int64_t> points_with_all_statistics(const StudySummary& summary) {
  if (!summary.complete.empty()) return summary.complete;
  std::vector<std::int64_t> all(summary.points.size());
  std::iota(all.begin(), all.end(), std::int64_t{0});
  return all;
}

}  // namespace zerocount::summary
