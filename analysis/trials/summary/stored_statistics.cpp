#include "analysis/trials/summary/stored_statistics.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/summary/observed_comparison.hpp"
#include "analysis/trials/summary/study_statistics.hpp"

namespace zerocount::summary {
namespace {

/// Number of design points that are held in memory at once with all their statistics.
constexpr std::size_t points_at_once = 256;

/// Appends the values of the next design points to the columns. The columns of both have the same order.
void add_columns(std::vector<layout::PointColumn>& columns, std::vector<layout::PointColumn>&& next) {
  if (columns.empty()) columns.resize(next.size());
  for (std::size_t i = 0; i < next.size(); ++i) {
    std::vector<double> values = std::move(columns[i].values);
    values.insert(values.end(), next[i].values.begin(), next[i].values.end());
    columns[i] = std::move(next[i]);
    columns[i].values = std::move(values);
  }
}

/// Adds the numbers of trials of a design point to the stored rows of its groups: worlds (draws of what all
/// machines share), settings or ages. Nothing for an open-loop study, which has no judged trials.
/// @param rows number of rows for each point
/// @param groups member that returns the counts by world, or by setting
/// @param row_of returns the row to which a group is added
void add_groups(layout::GroupCounts& stored, const measures::PointSummary& point, std::int64_t rows,
                std::vector<measures::MoveCounts> (measures::CellCounts::*groups)() const,
                const std::function<std::size_t(std::size_t group)>& row_of) {
  using measures::GroupTrials;
  using measures::MoveCounts;
  const auto numbers = [&](measures::CellCounts GroupTrials::*which, std::int64_t MoveCounts::*number) {
    std::vector<std::int64_t> found(static_cast<std::size_t>(rows));
    if (!point.trials_of_groups) return found;
    const std::vector<MoveCounts> counts = (((*point.trials_of_groups).*which).*groups)();
    for (std::size_t group = 0; group < counts.size(); ++group) found[row_of(group)] += counts[group].*number;
    return found;
  };
  stored.trials.push_back(numbers(&GroupTrials::succeeded, &MoveCounts::moves));
  stored.success.push_back(numbers(&GroupTrials::succeeded, &MoveCounts::met));
  if (!point.goals.empty()) stored.goal_met.push_back(numbers(&GroupTrials::meeting, &MoveCounts::met));
}

/// Adds the counts of a design point for each machine.
void add_machines(layout::GroupCounts& stored, const measures::PointSummary& point,
                  const study::Study& study) {
  const auto machines = static_cast<std::size_t>(study.machines);
  stored.trials.emplace_back(machines, study.open_loop ? 0 : study.trials / study.machines);
  stored.success.push_back(point.machines.successes_of_machines);
  stored.success.back().resize(machines);  // empty in an open loop
}

/// Adds the proportion of machines of a design point that meet the goal at each age, and the life of each
/// machine (the age up to which it does).
/// @param study study with a claim
void add_lives(layout::GroupCounts& ages, layout::GroupCounts& machines, const measures::PointSummary& point,
               const study::Study& study) {
  if (ages.statistics.empty()) {
    ages.statistics = {
        {"machines", "1", "proportion of machines that meet the goal at the age under every condition", {}},
        {"machines_low", "1", "lower bound of the proportion of machines, one-sided", {}},
        {"machines_high", "1", "upper bound of the proportion of machines, one-sided", {}}};
    machines.statistics = {
        {"life",
         study.settings.ages.unit,
         "last age up to and including which the machine meets the goal under every condition, NaN if it does not at the first",
         {}}};
  }
  const bool judged = point.judged > 0;
  const goal::Question question = goal::question_of(study);
  const goal::BoundedProportion unknown{statistics::unknown, statistics::unknown, statistics::unknown};
  for (const goal::BoundedProportion& at_age : judged ? goal::machines_at_ages(question, point.goals)
                                                      : std::vector(study.settings.ages.at.size(), unknown)) {
    ages.statistics[0].values.push_back(at_age.value);
    ages.statistics[1].values.push_back(at_age.low);
    ages.statistics[2].values.push_back(at_age.high);
  }
  for (const double life : judged ? goal::lives_of_machines(question, point.goals)
                                  : std::vector(static_cast<std::size_t>(study.machines), unknown.value))
    machines.statistics[0].values.push_back(life);
}

/// Adds the counts of a design point by machine, world (draw of what all machines share), setting and age.
void add_counts(layout::StoredStatistics& stored, const measures::PointSummary& point,
                const study::Study& study) {
  using measures::CellCounts;
  const auto by_world =
      static_cast<std::vector<measures::MoveCounts> (CellCounts::*)() const>(&CellCounts::by_world);
  if (study.machines > 0) add_machines(stored.groups["machine"], point, study);
  if (study.worlds > 0) add_groups(stored.groups["world"], point, study.worlds, by_world, std::identity());
  const study::SettingCounts counts = study.settings.counts();
  if (!study.settings.conditions.empty())
    add_groups(
        stored.groups["condition"], point, counts.conditions, &CellCounts::by_setting,
        [counts](std::int64_t setting) { return static_cast<std::size_t>(counts.at(setting).condition); });
  if (study.settings.ages.at.empty()) return;
  add_groups(stored.groups["age"], point, counts.ages, &CellCounts::by_setting,
             [counts](std::int64_t setting) { return static_cast<std::size_t>(counts.at(setting).age); });
  if (!study.goals.empty()) add_lives(stored.groups["age"], stored.groups["machine"], point, study);
}

/// Adds the statistics of the next design points.
/// @param first index of the first of these points
void add_points(layout::StoredStatistics& stored, std::span<const measures::PointSummary> points,
                const study::Study& study, std::span<const theory::PointPrediction> predictions,
                const layout::MeasureTable& table, std::int64_t first) {
  std::vector<layout::PointColumn> columns = measures::point_columns(points, study.features, table);
  std::ranges::move(measures::prediction_columns(predictions), std::back_inserter(columns));
  std::ranges::move(observed_columns(points, study, first), std::back_inserter(columns));
  add_columns(stored.points, std::move(columns));
  if (study.open_loop) {
    layout::StatisticTable levels = measures::level_table(points, table);
    if (stored.tables.empty()) {
      stored.tables.push_back(std::move(levels));
    } else {
      add_columns(stored.tables.front().columns, std::move(levels.columns));
    }
  }
  for (const measures::PointSummary& point : points) add_counts(stored, point, study);
}

}  // namespace

layout::StoredStatistics stored_statistics(std::span<const measures::PointSummary> points,
                                           const study::Study& study,
                                           std::span<const theory::PointPrediction> predictions,
                                           const layout::MeasureTable& table) {
  layout::StoredStatistics stored;
  add_points(stored, points, study, predictions, table, 0);
  return stored;
}

void take_stored_statistics(const reading::AllTrialsFile& file, const study::Study& study,
                            std::span<const theory::PointPrediction> known,
                            const std::function<void(const layout::StoredStatistics&)>& take,
                            const StatisticsWork& work) {
  const std::vector<theory::PointPrediction> predictions = theory::study_predictions(study, known);
  std::vector<measures::PointSummary> points;
  layout::StoredStatistics block;
  std::int64_t stored = 0;  // points
  const auto add_to_block = [&] {
    if (points.empty()) return;
    add_points(block, points, study,
               std::span(predictions).subspan(static_cast<std::size_t>(stored), points.size()), file.table(),
               stored);
    stored += std::ssize(points);
    points.clear();
  };
  StudyAccumulator accumulator(study, {.timeline = work.timeline, .stop = work.stop},
                               [&](PointResults&& point) {
                                 points.push_back(std::move(point.statistics));
                                 if (points.size() == points_at_once) add_to_block();
                               });
  require_all_trials(file);
  for (std::int64_t first = 0; first < study::point_count(study); first += layout::chunk_elements) {
    const std::int64_t count = std::min(layout::chunk_elements, study::point_count(study) - first);
    accumulator.add(file, {first * study.trials, count * study.trials});
    const timeline::TimeSpan span(work.timeline, "write statistics", timeline::Work::serial);
    accumulator.finish();
    add_to_block();
    take(std::exchange(block, {}));
  }
}

}  // namespace zerocount::summary
