#include "analysis/measures/goal_counts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

#include "analysis/measures/trial_value.hpp"
#include "analysis/statistics/unknown.hpp"
#include "core/failure/failure.hpp"
#include "core/text/text.hpp"
#include "core/trial/divergence.hpp"
#include "core/trial/move_measures.hpp"
#include "experiments/yaml/problems.hpp"
#include "results/layout/fields.hpp"
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

std::optional<CountedLimit> counted_limit(const study::Goal& goal, const study::GoalLimit& limit,
                                          const study::StudyFeatures& features) {
  const auto named = std::ranges::find(trial::named_measures(), limit.measure, &trial::NamedMeasure::name);
  if (named != trial::named_measures().end() &&
      ((named->of_motion && !features.motion) || (named->of_position && !features.position_error)))
    return std::nullopt;
  for (const layout::Measure& measure : layout::measure_table(features)) {
    if (measure.field.column.name == study::name_in(goal, limit.measure))
      return CountedLimit{&measure, limit.largest};
  }
  return std::nullopt;
}

}  // namespace

std::optional<CountedGoal> counted_by(const study::Goal& goal, const study::StudyFeatures& features) {
  CountedGoal counted{.within = goal.within, .of_other_mass = goal.of_other_mass, .on = goal.on};
  if (goal.of_other_mass &&
      !(goal.of == motion::EncoderPlace::load ? features.load_error : features.motor_error))
    return std::nullopt;
  if (goal.tolerance) {
    counted.tolerance = slot_of(features.tolerances.values(), *goal.tolerance);
  } else {
    counted.slot = slot_of(features.bands.values(), goal.band);
  }
  if (!counted.slot && !counted.tolerance) return std::nullopt;
  for (const study::GoalLimit& limit : goal.limits) {
    const auto of_file = counted_limit(goal, limit, features);
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
  if (!is_in_time(settling_time(goal, move), allowed_time(goal, move))) return false;
  return std::ranges::all_of(goal.limits, [&](const CountedLimit& limit) {
    return trial::was_run(move) && is_within(ranked_value(*limit.measure, move), limit.largest);
  });
}

std::int64_t count_moves(CellCounts& counts, const CountedGoal& goal, std::int64_t trial,
                         std::span<const trial::MoveOutcome> moves) {
  const auto met = std::ranges::count_if(
      moves, [&](const trial::MoveOutcome& move) { return asks(goal, move) && meets(goal, move); });
  counts.add(trial, asked_moves(goal, std::ssize(moves)), met);
  return met;
}

GoalSettling::GoalSettling(const CountedGoal& goal, const Shape& shape)
    : machines_(shape.machines), within_(goal.within) {
  if (goal.on.empty() && shape.settings == 0 && !within_.after_profile) return;
  times_.assign(static_cast<std::size_t>(std::max<std::int64_t>(shape.settings, 1)),
                statistics::TrialClusters(shape.machines));
  if (!within_.after_profile) return;
  time_ratios_ = times_;
  allowed_.assign(times_.size(), 0.0);
}

void GoalSettling::add(std::int64_t trial, const CountedGoal& goal,
                       std::span<const trial::MoveOutcome> moves) {
  if (times_.empty()) return;
  const study::TrialIndices indices{std::max<std::int64_t>(machines_, 1), std::ssize(times_)};
  const auto setting = static_cast<std::size_t>(indices.setting_of(trial));
  const auto add_to = [&](statistics::TrialClusters& clusters, auto value) {
    values_.clear();
    for (const trial::MoveOutcome& move : moves)
      if (asks(goal, move) && !std::isnan(settling_time(goal, move))) values_.push_back(value(move));
    clusters.add_trial(indices.draw_of(trial), values_, asked_moves(goal, std::ssize(moves)));
  };
  add_to(times_[setting], [&](const trial::MoveOutcome& move) { return settling_time(goal, move); });
  if (time_ratios_.empty()) return;
  add_to(time_ratios_[setting], [&](const trial::MoveOutcome& move) {
    return settling_time(goal, move) / allowed_time(goal, move);
  });
  for (const trial::MoveOutcome& move : moves)
    if (asks(goal, move)) allowed_[setting] = std::max(allowed_[setting], allowed_time(goal, move));
}

GoalSettling& GoalSettling::operator+=(const GoalSettling& next) {
  for (std::size_t i = 0; i < times_.size(); ++i) times_[i] += next.times_[i];
  for (std::size_t i = 0; i < time_ratios_.size(); ++i) {
    time_ratios_[i] += next.time_ratios_[i];
    allowed_[i] = std::max(allowed_[i], next.allowed_[i]);
  }
  return *this;
}

bool GoalSettling::is_valid(std::int64_t moves) const {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < time_ratios_.size(); ++i)
    if (time_ratios_[i].size() != times_[i].size()) return false;
  for (const statistics::TrialClusters& times : times_) {
    if (times.size() < 0 || times.size() > moves - sum) return false;
    sum += times.size();
  }
  return times_.empty() || sum == moves;
}

std::vector<SettlingTimes> GoalSettling::statistics(double confidence) const {
  std::vector<SettlingTimes> all;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const statistics::ClusteredSample sample = times_[i].sample();
    MeasureStatistics& one = all.emplace_back().times;
    one.n = sample.observed().size;
    one.moves = sample.size();
    one.min = statistics::smallest(sample.observed());
    one.max = statistics::largest(sample.observed());
    one.median = statistics::clustered_quantile(sample, 0.5, confidence);
    one.p95 = statistics::clustered_quantile(sample, 0.95, confidence);
    all.back().allowed = allowed_.empty() ? within_.time : allowed_[i];
    all.back().time_ratio =
        lateness(time_ratios_.empty()
                     ? one.p95.value / within_.time
                     : statistics::clustered_quantile(time_ratios_[i].sample(), 0.95, confidence).value);
  }
  return all;
}

namespace {

/// Whether the event means that the value is above its limit (true) or below (false).
bool is_above(const MoveEvent& event) {
  return event.sign == text::Sign::above || event.sign == text::Sign::at_least;
}

[[noreturn]] void fail(std::string_view text, std::string_view what) {
  throw Failure(
      ExitCode::bad_input,
      fmt::format("option '--event': '{}' {}; expected a measure of a move, one of > >= < <=, and a "
                  "number, such as 'arrival_time > 0.5'",
                  text, what));
}

double value_of(const layout::Measure& measure, const trial::MoveOutcome& move) {
  return ranked_value(measure, move).value_or(statistics::unknown);
}

/// Whether the goals of the event may allow different times for different moves.
bool allows_several_times(const MoveEvent& event) {
  return event.goals.size() > 1 || event.goals.front().within.after_profile;
}

/// Number that ranks moves by how late they settle. If the event has one goal with the same allowed time for
/// all moves: the settling time, s. Otherwise the settling time divided by the allowed time, the largest over
/// all goals. NaN if the move does not settle for one of the goals.
double lateness_of(const MoveEvent& event, const trial::MoveOutcome& move) {
  const bool by_ratio = allows_several_times(event);
  double latest = event.goals.size() > 1 ? 0.0 : statistics::unknown;
  for (const CountedGoal& goal : event.goals) {
    if (!asks(goal, move)) continue;
    const double time = settling_time(goal, move);
    if (!by_ratio || std::isnan(time)) return time;
    latest = std::fmax(latest, time / allowed_time(goal, move));
  }
  return latest;
}

layout::Measure measure_named(const study::Study& study, std::string_view text, std::string_view name) {
  std::vector<std::string> names;
  for (const layout::Measure& measure : layout::measure_table(study.features)) {
    if (!layout::is_in_file(measure, study.features)) continue;
    names.push_back(measure.field.column.name);
    if (names.back() == name) return measure;
  }
  if (const std::string_view meanings = trial::meanings_of_settling_time(name); !meanings.empty())
    fail(text, fmt::format("may mean two measures, {}", meanings));
  const std::string nearest(yaml::nearest_name(name, names));
  fail(text, fmt::format("names no measure of a move of this study: '{}'{}", name,
                         nearest.empty() ? "" : fmt::format(" (did you mean '{}'?)", nearest)));
}

}  // namespace

MoveEvent missed_question(const study::Study& study) {
  MoveEvent event;
  event.goals = asked_of_moves(study);
  return event;
}

MoveEvent parse_event(const study::Study& study, std::string_view text) {
  const auto relation = text::parse_relation(text);
  if (!relation || relation->sign == text::Sign::equal || relation->sign == text::Sign::unequal)
    fail(text, "compares nothing");
  const auto limit = text::parse_number<double>(relation->limit);
  if (!limit || !std::isfinite(*limit)) fail(text, "has no number behind the sign");
  MoveEvent event{.text = std::string(text::trimmed(text)),
                  .measure = measure_named(study, text, relation->name),
                  .sign = relation->sign,
                  .limit = *limit};
  if (study.open_loop && event.measure.values.needs_target)
    fail(text, "needs targets, but torque levels have none");
  if (event.measure.values.magnitude && event.limit < 0.0)
    fail(text, "compares a magnitude with a negative number");
  return event;
}

bool is_asked(const MoveEvent& event, const trial::MoveOutcome& move) {
  return !event.text.empty() ||
         std::ranges::any_of(event.goals, [&](const CountedGoal& goal) { return asks(goal, move); });
}

bool happens(const MoveEvent& event, const trial::MoveOutcome& move) {
  if (event.text.empty())
    return std::ranges::any_of(
        event.goals, [&](const CountedGoal& goal) { return asks(goal, move) && !meets(goal, move); });
  return text::holds(event.sign, value_of(event.measure, move), event.limit);
}

std::string name_of(MoveScore score, const MoveEvent& event) {
  switch (score) {
    case MoveScore::event:
      if (!event.text.empty()) return event.measure.field.column.name;
      if (allows_several_times(event)) return "settling time as a proportion of what a goal allows";
      return event.goals.front().tolerance ? "settling time in the tolerance"
             : event.goals.front().slot    ? "settling time in the band"
                                           : "time until arrival";
    case MoveScore::peak_torque:
      return "largest torque";
    case MoveScore::final_error:
      return "true error at the end";
    case MoveScore::restlessness:
      return "time at other counts after arrival";
  }
  return "";
}

double score_of(MoveScore score, const MoveEvent& event, const trial::MoveOutcome& move) {
  switch (score) {
    case MoveScore::event:
      if (event.text.empty()) return lateness_of(event, move);
      return is_above(event) ? value_of(event.measure, move) : -value_of(event.measure, move);
    case MoveScore::peak_torque:
      return move.peak_torque;
    case MoveScore::final_error:
      return std::abs(move.true_error);
    case MoveScore::restlessness:
      return 1.0 - move.zero_fraction;
  }
  return statistics::unknown;
}

}  // namespace zerocount::measures
