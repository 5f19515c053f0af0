#include "analysis/trials/measures/move_criterion.hpp"

#include <cstdlib>

#include "analysis/trials/measures/trial_value.hpp"
#include "core/trial/divergence.hpp"
#include "core/trial/move_measures.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::measures {
namespace {

/// Index of a value in a list; null if the list lacks it.
template <class Value>
std::optional<std::size_t> slot_of(std::span<const Value> values, Value value) {
  const auto place = std::ranges::find(values, value);
  if (place == values.end()) return std::nullopt;
  return static_cast<std::size_t>(place - values.begin());
}

std::optional<MeasureLimit> limit_of(const study::Goal& goal, const study::GoalLimit& limit,
                                     const study::StudyFeatures& features) {
  const auto named = std::ranges::find(trial::named_measures(), limit.measure, &trial::NamedMeasure::name);
  if (named != trial::named_measures().end() &&
      ((named->of_motion && !features.motion) || (named->of_position && !features.position_error)))
    return std::nullopt;
  for (const layout::Measure& measure : layout::measure_table(features)) {
    if (measure.field.column.name == study::name_in(goal, limit.measure))
      return MeasureLimit{&measure, true, limit.limit};
  }
  return std::nullopt;
}

bool settles(const MoveCriterion& criterion, const trial::MoveOutcome& move) {
  switch (criterion.settling) {
    case Settling::not_demanded:
      return true;
    case Settling::at_zero_counts:
      return trial::is_success(move.outcome);
    case Settling::in_band:
    case Settling::in_tolerance:
      return trial::was_run(move) &&
             is_in_time(settling_time(criterion, move), allowed_time(criterion, move));
  }
  return false;
}

}  // namespace

bool keeps(const trial::MoveOutcome& move, const MeasureLimit& limit) {
  const std::optional<double> value = ranked_value(*limit.measure, move);
  return !value || text::keeps(limit.of_magnitude ? std::abs(*value) : *value, limit.limit);
}

std::optional<MoveCriterion> move_criterion_of(const study::Goal& goal,
                                               const study::StudyFeatures& features) {
  MoveCriterion criterion{.of_other_mass = goal.of_other_mass, .within = goal.within, .on = goal.on};
  if (goal.of_other_mass &&
      !(goal.of == motion::EncoderPlace::load ? features.load_error : features.motor_error))
    return std::nullopt;
  criterion.settling = goal.tolerance ? Settling::in_tolerance : Settling::in_band;
  const std::optional<std::size_t> slot = goal.tolerance
                                              ? slot_of(features.tolerances.values(), *goal.tolerance)
                                              : slot_of(features.bands.values(), goal.band);
  if (!slot) return std::nullopt;
  criterion.slot = *slot;
  for (const study::GoalLimit& limit : goal.limits) {
    const auto of_file = limit_of(goal, limit, features);
    if (!of_file) return std::nullopt;
    criterion.limits.push_back(*of_file);
  }
  return criterion;
}

std::vector<MoveCriterion> criteria_of_goals(const study::Study& study) {
  std::vector<MoveCriterion> criteria;
  for (const study::Goal& goal : study.goals)
    criteria.push_back(move_criterion_of(goal, study.features).value());
  return criteria;
}

std::vector<MoveCriterion> move_criteria_of(const study::Study& study) {
  return study.goals.empty() ? std::vector{MoveCriterion{}} : criteria_of_goals(study);
}

bool meets(const MoveCriterion& criterion, const trial::MoveOutcome& move) {
  return settles(criterion, move) &&
         std::ranges::all_of(criterion.limits, [&](const MeasureLimit& limit) { return keeps(move, limit); });
}

std::int64_t count_moves(CellCounts& counts, const MoveCriterion& criterion, std::int64_t trial,
                         std::span<const trial::MoveOutcome> moves) {
  const auto met = std::ranges::count_if(
      moves, [&](const trial::MoveOutcome& move) { return asks(criterion, move) && meets(criterion, move); });
  counts.add(trial, asked_moves(criterion, std::ssize(moves)), met);
  return met;
}

}  // namespace zerocount::measures
