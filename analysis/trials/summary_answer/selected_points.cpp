#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "analysis/basis/document/answer.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary/study_statistics.hpp"
#include "analysis/trials/summary_answer/parts.hpp"
#include "analysis/trials/summary_answer/point_selection.hpp"
#include "core/text/text.hpp"
#include "core/trial/move_measures.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::summary_answer {
namespace {

using summary::StudySummary;

/// Largest number of design points whose statistics are computed one by one. For more points it is quicker to
/// read the file from end to end.
constexpr std::size_t max_selected = 200;

/// [point] A statistic that the file stores for every design point; "NAME[b]" for the statistic of an error
/// band. Empty if the file does not store it.
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

/// A table with only the measure by which design points are compared: settling_measure().
std::shared_ptr<const layout::MeasureTable> measures_of_merit(const reading::AllTrialsFile& file,
                                                              const goal::Question& question) {
  auto table = std::make_shared<layout::MeasureTable>();
  const std::string name = goal::settling_measure(question);
  for (const layout::Measure& measure : file.table()) {
    if (measure.field.column.name == name) table->push_back(measure);
  }
  return table;
}

/// Counts, for every design point of the summary, the moves that meet the goal, from the stored settling
/// times.
void count_goal(StudySummary& summary, const reading::AllTrialsFile& file, const study::Study& study) {
  const double allowed = summary.question.criterion().within.time;
  const auto moves = static_cast<std::size_t>(file.moves());
  const std::string name = goal::settling_measure(summary.question);
  const std::int64_t block = layout::chunk_rows(file.moves());
  for (std::int64_t first = 0; first < file.rows().count; first += block) {
    const std::int64_t count = std::min(block, file.rows().count - first);
    const std::vector<double> times = file.measure(name, {first, count});
    for (std::int64_t i = 0; i < count; ++i) {
      const auto begin = times.begin() + i * file.moves();
      const std::int64_t met = std::count_if(
          begin, begin + file.moves(), [&](double time) { return measures::is_in_time(time, allowed); });
      summary.points[static_cast<std::size_t>((first + i) / study.trials)].goals.front().add(
          (first + i) % study.trials, static_cast<std::int64_t>(moves), met);
    }
  }
}

/// Whether the goal cannot be judged from the settling times of all moves in its band alone: it has selected
/// moves, further limits or a tolerance, or its time counts from the end of the motion profile.
bool needs_outcomes(const measures::MoveCriterion& goal) {
  return !goal.on.empty() || !goal.limits.empty() || goal.settling == measures::Settling::in_tolerance ||
         goal.within.after_profile;
}

/// Reads the statistics of all design points by which points are compared into the summary. Returns false if
/// the file does not store them.
bool outline_points(StudySummary& summary, const reading::AllTrialsFile& file, const study::Study& study,
                    const layout::MeasureTable& table) {
  if (has_several(summary.question) || needs_outcomes(summary.question.criterion())) return false;
  const std::optional<std::vector<double>> successes = stored_statistic(file, "zero_count");
  const std::optional<std::vector<double>> times =
      stored_statistic(file, goal::settling_statistic(summary.question));
  if (!successes || !times) return false;
  measures::PointSummary outline;
  outline.table = &table;
  outline.measures.assign(table.size(), {});
  outline.measures.shrink_to_fit();
  outline.trials = outline.judged = study.trials;
  if (summary.question.goal()) outline.goals.emplace_back(measures::Shape{.machines = study.machines});
  summary.points.assign(summary.labels.size(), outline);
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    measures::PointSummary& point = summary.points[i];
    point.outcomes.zero_count = static_cast<std::int64_t>((*successes)[i]);
    (point.measures.back().*goal::settling_quantile(summary.question)).value = (*times)[i];
  }
  if (summary.question.goal()) count_goal(summary, file, study);
  if (study.machines == 0) return true;
  const std::optional<reading::StoredGroups> machines = file.groups("machine");
  if (!machines || machines->success.empty()) return false;
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    statistics::MachineStatistics& of_point = summary.points[i].machines;
    const auto begin = machines->success.begin() + static_cast<std::ptrdiff_t>(i) * study.machines;
    of_point.n = study.machines;
    of_point.trials_of_machine = study.trials / study.machines;
    of_point.successes_of_machines.assign(begin, begin + study.machines);
  }
  return true;
}

/// Reads the stability predictions of all design points from the columns that the file stores into the
/// summary. Returns false if it has none.
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

/// A summary of the first design point alone. Its axes still have the values of all points.
StudySummary summary_of_first_point(const StudySummary& summary, const reading::AllTrialsFile& file) {
  StudySummary first = summary;
  first.labels.resize(1);
  first.points.resize(1);
  summary::complete_points(first, file, {0}, false);
  return first;
}

bool is_summarised_by_point(const study::Study& study) {
  return !study.open_loop && study.worlds == 0 && study.settings.empty() && !study.stop &&
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
  SelectedSummary selected{summary::summary_without_points(file, statistics::summary_confidence),
                           {},
                           0,
                           measures_of_merit(file, goal::question_of(study))};
  StudySummary& summary = selected.summary;
  std::map<std::string, std::vector<double>> known;
  for (const std::string& column : columns_needed(summary, selection)) {
    std::optional<std::vector<double>> values = stored_statistic(file, column);
    if (!values) {
      require_columns(summary_of_first_point(summary, file), selection);
      return std::nullopt;
    }
    known[column] = *std::move(values);
  }
  if (!read_predictions(summary, file) || !outline_points(summary, file, study, *selected.measures))
    return std::nullopt;
  std::vector<std::int64_t> matching = matching_points(summary, selection, known);
  selected.matching = std::ssize(matching);
  selected.points = first_points(std::move(matching), selection);
  if (selected.points.size() > max_selected) return std::nullopt;
  std::vector<std::int64_t> complete = selected.points;
  complete.push_back(summary::choose_point(summary, point).point);
  std::ranges::sort(complete);
  complete.erase(std::unique(complete.begin(), complete.end()), complete.end());
  summary::complete_points(summary, file, std::move(complete),
                           bootstrap || study.features.motion || study.features.following);
  return selected;
}

}  // namespace zerocount::summary_answer
