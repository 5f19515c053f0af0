#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/loop/parameters.hpp"
#include "core/text/text.hpp"
#include "core/trial/move_measures.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/sections/sections.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/problems.hpp"

namespace zerocount::sections {
namespace {

/// Inserts a limit into the rising list, unless it is there already. Returns false if the list is full.
template <class Limits>
bool add_limit(Limits& limits, decltype(+limits.limits[0]) limit) {
  const auto begin = limits.limits.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(limits.count);
  const auto place = std::lower_bound(begin, end, limit);
  if (place != end && *place == limit) return true;
  if (limits.count == limits.limits.size()) return false;
  std::move_backward(place, end, end + 1);
  *place = limit;
  ++limits.count;
  return true;
}

void check_order(const yaml::Field& map, const study::StoppingRule& rule, yaml::Problems& problems) {
  const auto max_trials = yaml::find_field(map, "max_trials");
  const auto min_trials = yaml::find_field(map, "min_trials");
  if (max_trials && rule.max_trials < rule.block) {
    problems.add(
        *max_trials,
        fmt::format("{} trials are fewer than a block of {} (`trials`)", rule.max_trials, rule.block),
        fmt::format("at least {}", rule.block));
  } else if (max_trials && min_trials && rule.min_trials > rule.max_trials) {
    problems.add(*min_trials,
                 fmt::format("{} trials exceed max_trials, {}", rule.min_trials, rule.max_trials),
                 fmt::format("at most {}", rule.max_trials));
  }
}

void check_within(const yaml::Field& field, double within, const study::StudyPlan& plan,
                  yaml::Problems& problems) {
  study::ParameterRange shortest{.low = within};
  study::holds_somewhere(plan, parameter::command::hold, [&shortest](const study::ParameterRange& hold) {
    if (hold.low < shortest.low) shortest = hold;
    return false;
  });
  for (const rules::ValueFault& fault : rules::longer_than_the_move(within, shortest))
    problems.add(field, fault.what, fault.expected);
}

std::int64_t move_count(const study::StudyPlan& plan) {
  const auto listed = static_cast<std::int64_t>(plan.list.count);
  return plan.sequence ? std::ssize(study::sequence_moves(*plan.sequence, listed)) : listed;
}

/// The names of the measures for which a goal may set a limit in this study, except the settling times within
/// tolerances.
std::vector<std::string> limited_measures(const study::StudyPlan& plan) {
  std::vector<std::string> names;
  for (const trial::NamedMeasure& measure : trial::named_measures()) names.emplace_back(measure.name);
  for (const std::string_view measure : trial::named_band_measures())
    for (const std::int64_t band : plan.common.verdict.bands.values())
      names.push_back(fmt::format("{}[{}]", measure, band));
  return names;
}

/// The tolerance (rad, or m) that the name of a limited measure contains, as in
/// "tolerance_settling_time[1e-8]"; empty for other names.
std::optional<double> limited_tolerance(std::string_view name) {
  if (!name.starts_with(trial::tolerance_measure)) return std::nullopt;
  name.remove_prefix(trial::tolerance_measure.size());
  if (!name.starts_with('[') || !name.ends_with(']')) return std::nullopt;
  const auto tolerance = text::parse_number<double>(name.substr(1, name.size() - 2));
  return tolerance && std::isfinite(*tolerance) && *tolerance > 0.0 ? tolerance : std::nullopt;
}

/// Makes the trials measure settling of the position error within this tolerance (rad, or m).
void measure_tolerance(const yaml::Field& field, double tolerance, keys::StudyDraft& draft) {
  trial::VerdictParameters& verdict = draft.plan.common.verdict;
  verdict.position_error = true;
  if (!add_limit(verdict.tolerances, tolerance))
    draft.problems.add(field, "its tolerance is one too many",
                       fmt::format("at most {} different tolerances", verdict.tolerances.limits.size()));
}

bool measures_motion(const study::StudyPlan& plan) {
  return !study::holds_somewhere(plan, parameter::verdict::motion,
                                 [](const study::ParameterRange& motion) { return motion.can_be_zero; });
}

/// Reads the limits that a goal sets for measures, such as the overshoot.
void take_limits(const yaml::Field& of_goal, keys::StudyDraft& draft, study::Goal& goal) {
  const auto limits = yaml::find_field(of_goal, "limits");
  if (!limits) return;
  const std::vector<std::string> known = limited_measures(draft.plan);
  for (const yaml::YamlEntry& entry : limits->node->entries) {
    const yaml::Field item = yaml::entry_of(*limits, entry);
    std::string measure = entry.key;
    if (const auto tolerance = limited_tolerance(entry.key)) {
      measure_tolerance(item, *tolerance, draft);
      measure = fmt::format("{}[{}]", trial::tolerance_measure, *tolerance);  // one spelling
    } else if (std::ranges::find(known, entry.key) == known.end()) {
      const std::string_view nearest = yaml::nearest_name(entry.key, known);
      std::string names = "a measure of a move, such as overshoot or peak_torque";
      if (const std::string_view meanings = trial::meanings_of_settling_time(entry.key); !meanings.empty()) {
        names = meanings;
      } else if (entry.key.starts_with(trial::tolerance_measure)) {
        names = fmt::format("{}[t] of a tolerance t above 0, in rad or m", trial::tolerance_measure);
      } else if (!nearest.empty()) {
        names = fmt::format("'{}'?", nearest);
      }
      draft.problems.add(item, "no measure of a move of this study has this name", names);
      continue;
    }
    const auto named = std::ranges::find(trial::named_measures(), entry.key, &trial::NamedMeasure::name);
    if (named != trial::named_measures().end()) {
      if (named->of_motion && !measures_motion(draft.plan))
        draft.problems.add(item, "the true motion is not measured", "verdict.motion: true");
      if (named->of_position) draft.plan.common.verdict.position_error = true;
    }
    goal.limits.push_back({std::move(measure), {text::Relation::at_most, shapes::number_of(item)}});
  }
}

/// Makes the trials measure settling within the error band or the tolerance by which the goal is judged.
void measure_for(const yaml::Field& field, const study::Goal& goal, keys::StudyDraft& draft) {
  trial::VerdictParameters& verdict = draft.plan.common.verdict;
  if (!goal.tolerance) {
    if (!add_limit(verdict.bands, goal.band))
      draft.problems.add(
          field, fmt::format("the band of {} counts is one too many", goal.band),
          fmt::format("at most {} error bands with those of the goals", verdict.bands.limits.size()));
    return;
  }
  measure_tolerance(field, *goal.tolerance, draft);
}

/// Finds out which mass each goal judges, and makes the trials measure the position error of the other mass
/// if a goal needs it.
void choose_masses(const yaml::Field& of_goals, keys::StudyDraft& draft,
                   const std::function<yaml::Field(const study::Goal&)>& field_of) {
  using enum motion::EncoderPlace;
  const bool at_motor = study::closes_somewhere(draft.plan, motor);
  const bool at_load = study::closes_somewhere(draft.plan, load);
  std::optional<motion::EncoderPlace>& other = draft.plan.common.verdict.other_mass;
  for (study::Goal& goal : draft.study.goals) {
    const auto of = yaml::find_field(field_of(goal), "of");
    if (of && !at_motor && !at_load)
      draft.problems.add(*of, "the axis has one mass", "plant.load, or the key left out");
    if (!at_motor && !at_load) continue;
    if (!of && at_motor != at_load) goal.of = at_load ? load : motor;
    goal.of_either = !goal.of && at_motor && at_load;
    goal.of_other_mass = of && (goal.of == load ? at_motor : at_load);
    if (!goal.of_other_mass) continue;
    if (!goal.tolerance)
      draft.problems.add(*of,
                         "a band refers to the encoder that closes the loop, and that reads the other mass",
                         "tolerance, in place of band");
    if (other && other != goal.of)
      draft.problems.add(of_goals,
                         "goals of both masses, although the loop is closed on the motor in some cases and "
                         "on the load in others",
                         "one encoder that closes the loop everywhere");
    other = goal.of;
  }
  const auto is_beside_load = [&](const study::Goal& goal) {
    return goal.of == motor && goal.tolerance && at_motor != at_load;
  };
  for (study::Goal& goal : draft.study.goals) goal.beside_load = is_beside_load(goal);
  if (at_motor && std::ranges::any_of(draft.study.goals, is_beside_load)) other = load;
  if (other) draft.plan.common.verdict.position_error = true;
}

/// Checks a goal, and makes the trials measure its error band or tolerance.
void check_goal(const yaml::Field& field, study::Goal& goal, keys::StudyDraft& draft) {
  for (const char* const key : {"within", "after_profile"})
    if (const auto within = yaml::find_field(field, key))
      check_within(*within, goal.within.time, draft.plan, draft.problems);
  const auto is_sine = [](const study::ParameterRange& shape) {
    return shape.low == static_cast<double>(loop::ReferenceShape::sine);
  };
  if (goal.within.after_profile &&
      study::holds_somewhere(draft.plan, parameter::command::profile::shape, is_sine))
    draft.problems.add(field, "after_profile: a sine has no end", "within");
  std::ranges::sort(goal.on);
  measure_for(field, goal, draft);
}

}  // namespace

void read_goals(const yaml::Field& root, keys::StudyDraft& draft) {
  const auto one = yaml::find_field(root, "goal");
  const auto several = yaml::find_field(root, "goals");
  if (one.has_value() == several.has_value()) return;  // both are reported
  std::vector<study::Goal>& goals = draft.study.goals;
  if (one) goals.push_back({.axis = draft.plan.units.axis});
  const yaml::Field& field = one ? *one : *several;
  shapes::Shape shape = keys::shape_of(one ? "goal" : "goals");
  shapes::limit_items(one ? shape : shape.parts.front(), "on", move_count(draft.plan) - 1);
  shapes::read(field, shape, draft.problems, &draft);
  const auto field_of = [&](const study::Goal& goal) {
    return one ? field : yaml::find_field(field, goal.name).value();
  };
  for (study::Goal& goal : goals) check_goal(field_of(goal), goal, draft);
  choose_masses(field, draft, field_of);
  // A limit can be of the band of any goal.
  for (study::Goal& goal : goals) take_limits(field_of(goal), draft, goal);
}

void measure_both_masses(study::StudyPlan& plan) {
  trial::VerdictParameters& verdict = plan.common.verdict;
  if (!plan.sequence || verdict.other_mass || !study::closes_somewhere(plan, motion::EncoderPlace::motor))
    return;
  verdict.other_mass = motion::EncoderPlace::load;
  verdict.position_error = true;
}

void read_stop(const yaml::Field& field, keys::StudyDraft& draft) {
  study::Study& study = draft.study;
  study::StoppingRule& rule = study.stop.emplace();
  rule.block = study.trials;
  // If it cannot be read, no other fault follows from that.
  if (yaml::find_field(field, "max_trials")) rule.max_trials = keys::max_study_trials;
  shapes::read(field, keys::shape_of("stop"), draft.problems, &draft);
  if (field.node->kind != yaml::YamlNode::Kind::map) return study.stop.reset();
  check_order(field, rule, draft.problems);
  study.trials = rule.max_trials;
}

}  // namespace zerocount::sections
