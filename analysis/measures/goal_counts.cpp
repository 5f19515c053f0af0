#include "analysis/measures/goal_counts.hpp"

#include <cmath>

#include "core/trial/named_measures.hpp"
#include "results/layout/fields.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::measures {
namespace {

/// The place of a value in a list.
template <class Value>
std::optional<std::size_t> slot_of(std::span<const Value> values, Value value) {
  const auto place = std::ranges::find(values, value);
  if (place == values.end()) return std::nullopt;
  return static_cast<std::size_t>(place - values.begin());
}

std::optional<CountedLimit> counted_limit(const study::GoalLimit& limit,
                                          const study::StudyFeatures& features) {
  const auto named = std::ranges::find(trial::named_measures(), limit.measure, &trial::NamedMeasure::name);
  if (named != trial::named_measures().end() &&
      ((named->of_motion && !features.motion) || (named->of_position && !features.position_error)))
    return std::nullopt;
  for (const layout::Measure& measure : layout::measure_table(features)) {
    if (measure.field.column.name == limit.measure)
      return CountedLimit{
          [&field = measure.field](const trial::MoveOutcome& move) { return layout::value_of(field, move); },
          limit.largest};
  }
  return std::nullopt;
}

}  // namespace

std::optional<CountedGoal> counted_by(const study::Goal& goal, const study::StudyFeatures& features) {
  CountedGoal counted{.within = goal.within, .on = goal.on};
  if (goal.tolerance) {
    counted.tolerance = slot_of(features.tolerances.values(), *goal.tolerance);
  } else {
    counted.slot = slot_of(features.bands.values(), goal.band);
  }
  if (!counted.slot && !counted.tolerance) return std::nullopt;
  for (const study::GoalLimit& limit : goal.limits) {
    const auto of_file = counted_limit(limit, features);
    if (!of_file) return std::nullopt;
    counted.limits.push_back(*of_file);
  }
  return counted;
}

std::vector<CountedGoal> counted_goals(const study::Study& study) {
  std::vector<CountedGoal> counted;
  for (const study::Goal& goal : study.goals) counted.push_back(counted_by(goal, study.features).value());
  return counted;
}

std::vector<CountedGoal> asked_of_moves(const study::Study& study) {
  return study.goals.empty() ? std::vector{CountedGoal{}} : counted_goals(study);
}

bool meets(const CountedGoal& goal, const trial::MoveOutcome& move) {
  if (!goal.slot && !goal.tolerance) return trial::is_success(move.outcome);
  if (!(settling_time(goal, move) <= latest(goal))) return false;  // or NaN
  return std::ranges::all_of(
      goal.limits, [&](const CountedLimit& limit) { return std::abs(limit.value(move)) <= limit.largest; });
}

std::int64_t count_moves(CellCounts& counts, const CountedGoal& goal, std::int64_t trial,
                         std::span<const trial::MoveOutcome> moves) {
  const auto met = std::ranges::count_if(
      moves, [&](const trial::MoveOutcome& move) { return asks(goal, move) && meets(goal, move); });
  counts.add(trial, asked_moves(goal, std::ssize(moves)), met);
  return met;
}

}  // namespace zerocount::measures
