#include "analysis/summary_answer/selected_summary.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "analysis/measures/goal_counts.hpp"
#include "analysis/summary/chosen_point.hpp"
#include "analysis/summary/study_statistics.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::summary_answer {
namespace {

using summary::StudySummary;

/// Points whose statistics are computed one by one; with more it is quicker to read the file from end to end.
constexpr std::size_t max_selected = 200;

/// A statistic of the points in the file: [point], or of an error band "NAME[b]". Nothing where the file does
/// not have it.
std::optional<std::vector<double>> stored_statistic(const reading::AllTrialsFile& file,
                                                    const std::string& name) {
  const std::size_t open = name.find('[');
  const std::string dataset_name = name.substr(0, open);
  const hdf5::Group group = file.root().open_group("point");
  if (!group.contains(dataset_name)) return std::nullopt;
  const hdf5::Dataset dataset = group.open_dataset(dataset_name);
  if (dataset.element() != hdf5::Element::float64) return std::nullopt;
  const std::int64_t points = file.header().points;
  const std::span<const std::int64_t> bands = file.features().bands.values();
  const bool of_band = open != std::string::npos;
  const std::size_t width = of_band ? bands.size() : 1;
  const std::vector<hdf5::Size> extent = dataset.extent();
  if (extent.size() != (of_band ? 2U : 1U) || extent[0] != static_cast<hdf5::Size>(points))
    return std::nullopt;
  if (of_band && extent[1] != width) return std::nullopt;
  std::size_t slot = 0;
  while (of_band && slot < width && layout::name_of_band(dataset_name, bands[slot]) != name) ++slot;
  if (slot == width) return std::nullopt;
  std::vector<double> all(static_cast<std::size_t>(points) * width);
  dataset.read(0, points, all.data());
  if (!of_band) return all;
  std::vector<double> values;
  for (std::size_t i = slot; i < all.size(); i += width) values.push_back(all[i]);
  return values;
}

/// The only measure by which points are compared.
std::shared_ptr<const layout::MeasureTable> measures_of_merit(const reading::AllTrialsFile& file,
                                                              const goal::Question& question) {
  auto table = std::make_shared<layout::MeasureTable>();
  const std::string name = goal::settling_measure(question);
  for (const layout::Measure& measure : file.table()) {
    if (measure.field.column.name == name) table->push_back(measure);
  }
  return table;
}

/// Counts the moves of every point that meet the goal.
void count_goal(StudySummary& summary, const reading::AllTrialsFile& file, const study::Study& study) {
  const measures::CountedGoal counted = summary.question.counted();
  const auto moves = static_cast<std::size_t>(file.moves());
  const std::string name = goal::settling_measure(summary.question);
  const std::int64_t block = layout::chunk_rows(file.moves());
  for (std::int64_t first = 0; first < file.rows().count; first += block) {
    const std::int64_t count = std::min(block, file.rows().count - first);
    const std::vector<double> times = file.measure(name, {first, count});
    for (std::int64_t i = 0; i < count; ++i) {
      const auto begin = times.begin() + i * file.moves();
      const std::int64_t met = std::count_if(begin, begin + file.moves(),
                                             [&](double time) { return time <= measures::latest(counted); });
      summary.points[static_cast<std::size_t>((first + i) / study.trials)].goals.front().add(
          (first + i) % study.trials, static_cast<std::int64_t>(moves), met);
    }
  }
}

/// Whether more than the settling times of all moves is asked.
bool needs_outcomes(const measures::CountedGoal& goal) {
  return !goal.on.empty() || !goal.limits.empty() || goal.tolerance;
}

/// What points are compared by, of all points; nothing where the file does not store it.
bool outline_points(StudySummary& summary, const reading::AllTrialsFile& file, const study::Study& study,
                    const layout::MeasureTable& table) {
  if (has_several(summary.question) || needs_outcomes(summary.question.counted())) return false;
  const std::optional<std::vector<double>> successes = stored_statistic(file, "zero_count");
  const std::optional<std::vector<double>> times =
      stored_statistic(file, goal::settling_statistic(summary.question));
  if (!successes || !times) return false;
  measures::PointSummary outline;
  outline.table = &table;
  outline.measures.assign(table.size(), {});
  outline.measures.shrink_to_fit();
  outline.trials = outline.judged = study.trials;
  if (summary.question.claim()) outline.goals.emplace_back(measures::Shape{.rigs = study.rigs});
  summary.points.assign(summary.labels.size(), outline);
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    measures::PointSummary& point = summary.points[i];
    point.outcomes.zero_count = static_cast<std::int64_t>((*successes)[i]);
    (point.measures.back().*goal::settling_quantile(summary.question)).value = (*times)[i];
  }
  if (summary.question.claim()) count_goal(summary, file, study);
  if (study.rigs == 0) return true;
  const std::optional<reading::StoredGroups> rigs = file.rigs();
  if (!rigs || rigs->success.empty()) return false;
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    statistics::RigStatistics& of_point = summary.points[i].rigs;
    const auto begin = rigs->success.begin() + static_cast<std::ptrdiff_t>(i) * study.rigs;
    of_point.n = study.rigs;
    of_point.trials_of_rig = study.trials / study.rigs;
    of_point.successes_of_rigs.assign(begin, begin + study.rigs);
  }
  return true;
}

/// The predictions of all points, from the columns that the file stores.
bool read_predictions(StudySummary& summary, const reading::AllTrialsFile& file) {
  std::vector<layout::PointColumn> columns;
  for (const measures::PredictionField& field : measures::prediction_fields()) {
    std::optional<std::vector<double>> values = stored_statistic(file, std::string(field.name));
    if (!values) return false;
    columns.push_back({std::string(field.name), "1", "", *std::move(values)});
  }
  summary.predictions = measures::predictions_of(columns, file.header().trials, file.path());
  return true;
}

/// The summary of these points alone; its axes are those of all points.
StudySummary summary_of_points(const StudySummary& summary, const reading::AllTrialsFile& file,
                               const study::Study& study, std::span<const std::int64_t> numbers,
                               bool bootstrap) {
  StudySummary some = summary::summary_without_points(study, summary.confidence);
  some.labels.clear();
  some.axes = summary.axes;
  for (const std::int64_t point : numbers) {
    some.labels.push_back(summary.labels[static_cast<std::size_t>(point)]);
    some.points.push_back(summary::point_statistics(
        file, study, point, {.undecided = true, .confidence = summary.confidence, .bootstrap = bootstrap}));
  }
  summary::describe_points(some, study, numbers);
  return some;
}

/// Computes the statistics of the points `summary.complete`.
void complete(StudySummary& summary, const reading::AllTrialsFile& file, const study::Study& study,
              bool bootstrap) {
  StudySummary some = summary_of_points(summary, file, study, summary.complete, bootstrap);
  for (std::size_t i = 0; i < some.points.size(); ++i)
    summary.points[static_cast<std::size_t>(summary.complete[i])] = std::move(some.points[i]);
}

bool is_summarised_by_point(const study::Study& study) {
  return !study.open_loop && study.worlds == 0 && study.conditions.empty() && !study.stop &&
         study.sequence.empty();
}

}  // namespace

std::optional<SelectedSummary> summarise_selected(const std::filesystem::path& path, bool bootstrap,
                                                  const PointSelection& selection,
                                                  std::optional<std::int64_t> point) {
  if (!selection.sort && !selection.top && selection.where.empty()) return std::nullopt;
  if (!shards::keeps_every_trial(path)) return std::nullopt;
  const reading::AllTrialsFile file(path);
  const study::Study& study = file.study();
  if (!is_summarised_by_point(study) || file.moves() != study.moves) return std::nullopt;
  SelectedSummary selected{summary::summary_without_points(study, statistics::summary_confidence),
                           {},
                           measures_of_merit(file, goal::question_of(study))};
  StudySummary& summary = selected.summary;
  summary.name = file.header().name;
  summary.labels = file.point_labels();
  summary.axes = file.axes();
  std::map<std::string, std::vector<double>> known;
  for (const std::string& column : columns_needed(summary, selection)) {
    std::optional<std::vector<double>> values = stored_statistic(file, column);
    if (!values) {
      const std::int64_t first = 0;
      require_columns(summary_of_points(summary, file, study, {&first, 1}, false), selection);
      return std::nullopt;
    }
    known[column] = *std::move(values);
  }
  if (!read_predictions(summary, file) || !outline_points(summary, file, study, *selected.measures))
    return std::nullopt;
  selected.points = selected_points(summary, selection, known);
  if (selected.points.size() > max_selected) return std::nullopt;
  summary.complete = selected.points;
  summary.complete.push_back(summary::choose_point(summary, point).point);
  std::ranges::sort(summary.complete);
  summary.complete.erase(std::unique(summary.complete.begin(), summary.complete.end()),
                         summary.complete.end());
  complete(summary, file, study, bootstrap || study.features.motion || study.features.following);
  return selected;
}

}  // namespace zerocount::summary_answer
