#include "analysis/summary/stored_statistics.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/goal/lives.hpp"
#include "analysis/measures/point_columns.hpp"
#include "analysis/summary/observed_comparison.hpp"
#include "analysis/summary/study_statistics.hpp"

namespace zerocount::summary {
namespace {

constexpr std::size_t points_at_once = 256;  ///< that are held with all their statistics

/// The trials of the groups (worlds or conditions) at each point; of an open loop none is judged.
/// @param groups of the trials of a point
layout::GroupCounts group_counts(
    std::span<const measures::PointSummary> points, std::int64_t count, bool has_goal,
    const std::function<std::vector<measures::MoveCounts>(const measures::CellCounts&)>& groups) {
  using measures::CellCounts;
  using measures::GroupTrials;
  using measures::MoveCounts;
  layout::GroupCounts counts;
  for (const measures::PointSummary& point : points) {
    const auto numbers = [&](CellCounts GroupTrials::*which, std::int64_t MoveCounts::*number) {
      std::vector<std::int64_t> found;
      if (point.trials_of_groups) {
        for (const MoveCounts& group : groups((*point.trials_of_groups).*which))
          found.push_back(group.*number);
      }
      found.resize(static_cast<std::size_t>(count));  // none in an open loop
      return found;
    };
    counts.trials.push_back(numbers(&GroupTrials::succeeded, &MoveCounts::moves));
    counts.success.push_back(numbers(&GroupTrials::succeeded, &MoveCounts::met));
    if (has_goal) counts.goal_met.push_back(numbers(&GroupTrials::meeting, &MoveCounts::met));
  }
  return counts;
}

/// The sums of the groups with the same `sum_of`, [point][sum].
layout::GroupCounts sums_of(const layout::GroupCounts& groups, std::int64_t sums,
                            const std::function<std::size_t(std::size_t group)>& sum_of) {
  using Counts = std::vector<std::vector<std::int64_t>>;
  const auto sum = [&](const Counts& counts) {
    Counts found;
    for (const std::vector<std::int64_t>& of_point : counts) {
      std::vector<std::int64_t>& row = found.emplace_back(static_cast<std::size_t>(sums));
      for (std::size_t group = 0; group < of_point.size(); ++group) row[sum_of(group)] += of_point[group];
    }
    return found;
  };
  return {sum(groups.trials), sum(groups.success), sum(groups.goal_met)};
}

/// What is stored of the ages. @param turns the trials under each condition at each age
layout::AgeCounts age_counts(std::span<const measures::PointSummary> points, const study::Study& study,
                             const layout::GroupCounts& turns) {
  const auto of_age = static_cast<std::size_t>(study::conditions_of_age(study));
  const std::size_t ages = study.ages.at.size();
  layout::AgeCounts counts{.trials = sums_of(turns, std::ssize(study.ages.at),
                                             [of_age](std::size_t turn) { return turn / of_age; })};
  if (study.goals.empty()) return counts;
  const goal::Question question = goal::question_of(study);
  for (const measures::PointSummary& point : points) {
    counts.machines.emplace_back(ages, statistics::unknown);
    counts.machines_low.push_back(counts.machines.back());
    counts.machines_high.push_back(counts.machines.back());
    counts.lives.emplace_back(static_cast<std::size_t>(study.rigs), statistics::unknown);
    if (point.judged == 0) continue;
    const std::vector<goal::BoundedProportion> machines = goal::machines_at_ages(question, point.goals);
    for (std::size_t age = 0; age < ages; ++age) {
      counts.machines.back()[age] = machines[age].value;
      counts.machines_low.back()[age] = machines[age].low;
      counts.machines_high.back()[age] = machines[age].high;
    }
    counts.lives.back() = goal::lives_of_rigs(question, point.goals);
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
  const auto append_counts = [&](layout::GroupCounts& counts, layout::GroupCounts& more) {
    append_to(counts.trials, more.trials);
    append_to(counts.success, more.success);
    append_to(counts.goal_met, more.goal_met);
  };
  for (auto groups : {&layout::StoredStatistics::worlds, &layout::StoredStatistics::conditions}) {
    if (stored.*groups) append_counts(*(stored.*groups), *(next.*groups));
  }
  if (!stored.ages) return;
  append_counts(stored.ages->trials, next.ages->trials);
  for (auto values : {&layout::AgeCounts::machines, &layout::AgeCounts::machines_low,
                      &layout::AgeCounts::machines_high, &layout::AgeCounts::lives})
    append_to((*stored.ages).*values, (*next.ages).*values);
}

}  // namespace

layout::StoredStatistics stored_statistics(std::span<const measures::PointSummary> points,
                                           const study::Study& study,
                                           std::span<const theory::PointPrediction> predictions,
                                           const layout::MeasureTable& table, std::int64_t first) {
  layout::StoredStatistics stored;
  stored.points = measures::point_columns(points, study.features, table);
  for (layout::PointColumn& column : measures::prediction_columns(predictions))
    stored.points.push_back(std::move(column));
  for (layout::PointColumn& column : observed_columns(points, study, first))
    stored.points.push_back(std::move(column));
  if (study.open_loop) stored.tables.push_back(measures::level_table(points, table));
  for (std::size_t point = 0; study.rigs > 0 && point < points.size(); ++point) {
    stored.rig_successes.push_back(points[point].rigs.successes_of_rigs);
    stored.rig_successes.back().resize(static_cast<std::size_t>(study.rigs));  // empty in an open loop
  }
  if (study.worlds > 0)
    stored.worlds = group_counts(points, study.worlds, !study.goals.empty(),
                                 [](const measures::CellCounts& counts) { return counts.by_world(); });
  if (study.conditions.empty()) return stored;
  const layout::GroupCounts turns = group_counts(points, std::ssize(study.conditions), !study.goals.empty(),
                                                 std::mem_fn(&measures::CellCounts::by_condition));
  const std::size_t names = study.condition_names.size();
  if (names > 0)
    stored.conditions =
        sums_of(turns, std::ssize(study.condition_names), [names](std::size_t turn) { return turn % names; });
  if (!study.ages.at.empty()) stored.ages = age_counts(points, study, turns);
  return stored;
}

void take_stored_statistics(const reading::AllTrialsFile& file, const study::Study& study,
                            std::span<const theory::PointPrediction> known,
                            const std::function<void(const layout::StoredStatistics&)>& take,
                            timeline::Timeline* timeline) {
  const std::vector<theory::PointPrediction> predictions = theory::study_predictions(study, known);
  std::vector<measures::PointSummary> points;
  std::optional<layout::StoredStatistics> block;
  std::int64_t stored = 0;  // points
  const auto add_to_block = [&] {
    if (points.empty()) return;
    layout::StoredStatistics next = stored_statistics(
        points, study, std::span(predictions).subspan(static_cast<std::size_t>(stored), points.size()),
        file.table(), stored);
    if (block) {
      append(*block, std::move(next));
    } else {
      block = std::move(next);
    }
    stored += std::ssize(points);
    points.clear();
  };
  StudyAccumulator accumulator(study, {.timeline = timeline}, [&](PointResults&& point) {
    points.push_back(std::move(point.statistics));
    if (points.size() == points_at_once) add_to_block();
  });
  require_all_trials(file);
  for (std::int64_t first = 0; first < study::point_count(study); first += layout::chunk_elements) {
    const std::int64_t count = std::min(layout::chunk_elements, study::point_count(study) - first);
    accumulator.add(file, {first * study.trials, count * study.trials});
    const timeline::TimeSpan span(timeline, "write statistics", timeline::Work::serial);
    accumulator.finish();
    add_to_block();
    take(*std::exchange(block, std::nullopt));
  }
}

}  // namespace zerocount::summary
