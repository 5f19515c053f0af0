#include "experiments/sections/goal.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/text/number_text.hpp"
#include "core/trial/named_measures.hpp"
#include "experiments/keys/key_reading.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/yaml/nearest_name.hpp"

namespace zerocount::sections {
namespace {

/// Adds the number where it belongs among rising ones, unless it is there already. False if there are too
/// many.
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
  study::ValueLimits shortest{.low = within};
  study::holds_somewhere(plan, "command.hold", [&shortest](const study::ValueLimits& hold) {
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

/// Reads the moves that a goal is about.
void read_moves(const yaml::Field& field, const study::StudyPlan& plan, std::vector<std::int64_t>& on,
                yaml::Problems& problems) {
  const std::string expected = "a list of moves of a trial, from 0, each once, such as [0, 1]";
  if (!yaml::check_list(field, expected, problems)) return;
  if (field.node->items.empty()) problems.add(field, "found an empty list", expected);
  const std::int64_t moves = move_count(plan);
  for (std::size_t i = 0; i < field.node->items.size(); ++i) {
    const yaml::Field item = yaml::item_of(field, i);
    const auto move = yaml::read_whole(item, 0, std::max<std::int64_t>(moves - 1, 0), problems);
    if (!move) continue;
    const auto place = std::ranges::lower_bound(on, *move);
    if (place != on.end() && *place == *move) {
      problems.add(item, fmt::format("move {} stands twice", *move), expected);
    } else {
      on.insert(place, *move);
    }
  }
}

/// The names of the measures that a limit can be of, in this study, but for those of tolerances.
std::vector<std::string> limited_measures(const study::StudyPlan& plan) {
  std::vector<std::string> names;
  for (const trial::NamedMeasure& measure : trial::named_measures()) names.emplace_back(measure.name);
  for (const std::string_view measure : trial::named_band_measures())
    for (const std::int64_t band : plan.common.verdict.bands.values())
      names.push_back(fmt::format("{}[{}]", measure, band));
  return names;
}

/// The tolerance (rad) in "tolerance_settling_time[1e-8]"; nothing in other names.
std::optional<double> limited_tolerance(std::string_view name) {
  if (!name.starts_with(trial::tolerance_measure)) return std::nullopt;
  name.remove_prefix(trial::tolerance_measure.size());
  if (!name.starts_with('[') || !name.ends_with(']')) return std::nullopt;
  const auto tolerance = text::parse_number<double>(name.substr(1, name.size() - 2));
  return tolerance && std::isfinite(*tolerance) && *tolerance > 0.0 ? tolerance : std::nullopt;
}

/// Lets the trials measure settling within the tolerance.
void measure_tolerance(const yaml::Field& field, double tolerance, keys::Reading& reading) {
  trial::VerdictParameters& verdict = reading.plan.common.verdict;
  verdict.position_error = true;
  if (!add_limit(verdict.tolerances, tolerance))
    reading.problems.add(field, "its tolerance is one too many",
                         fmt::format("at most {} different tolerances", verdict.tolerances.limits.size()));
}

bool measures_motion(const study::StudyPlan& plan) {
  return !study::holds_somewhere(plan, "verdict.motion",
                                 [](const study::ValueLimits& motion) { return motion.can_be_zero; });
}

void read_limits(const yaml::Field& of_goal, keys::Reading& reading, study::Goal& goal) {
  const auto limits = yaml::find_field(of_goal, "limits");
  if (!limits) return;
  const yaml::Field& field = *limits;
  const char* const expected = "a map of measures of a move and largest values, such as {overshoot: 200}";
  if (!yaml::check_map(field, expected, reading.problems)) return;
  if (field.node->entries.empty()) reading.problems.add(field, "found no measure", expected);
  const std::vector<std::string> known = limited_measures(reading.plan);
  for (const yaml::YamlEntry& entry : field.node->entries) {
    const yaml::Field item = yaml::entry_of(field, entry);
    std::string measure = entry.key;
    if (const auto tolerance = limited_tolerance(entry.key)) {
      measure_tolerance(item, *tolerance, reading);
      measure = fmt::format("{}[{}]", trial::tolerance_measure, *tolerance);  // one spelling
    } else if (std::ranges::find(known, entry.key) == known.end()) {
      const std::string_view nearest = yaml::nearest_name(entry.key, known);
      std::string names = "a measure of a move, such as overshoot or peak_torque";
      if (entry.key.starts_with(trial::tolerance_measure)) {
        names = fmt::format("{}[t] of a tolerance t above 0, in rad or m", trial::tolerance_measure);
      } else if (!nearest.empty()) {
        names = fmt::format("'{}'?", nearest);
      }
      reading.problems.add(item, "no measure of a move of this study has this name", names);
      continue;
    }
    const auto named = std::ranges::find(trial::named_measures(), entry.key, &trial::NamedMeasure::name);
    if (named != trial::named_measures().end()) {
      if (named->of_motion && !measures_motion(reading.plan))
        reading.problems.add(item, "the true motion is not measured", "verdict.motion: true");
      if (named->of_position) reading.plan.common.verdict.position_error = true;
    }
    if (const auto largest = yaml::read_real(item, numerics::at_least(0), reading.problems))
      goal.limits.push_back({std::move(measure), *largest});
  }
}

/// Lets the trials measure what the goal is judged by.
void measure_for(const yaml::Field& field, const study::Goal& goal, keys::Reading& reading) {
  trial::VerdictParameters& verdict = reading.plan.common.verdict;
  if (!goal.tolerance) {
    if (!add_limit(verdict.bands, goal.band))
      reading.problems.add(
          field, fmt::format("the band of {} counts is one too many", goal.band),
          fmt::format("at most {} error bands with those of the goals", verdict.bands.limits.size()));
    return;
  }
  if (const auto band = yaml::find_field(field, "band"))
    reading.problems.add(*band, "the goal has a tolerance too", "one of them");
  measure_tolerance(field, *goal.tolerance, reading);
}

/// Reads one goal, and adds its band, or its tolerance, to those of the plan.
void read_goal(const yaml::Field& field, std::string_view name, keys::Reading& reading) {
  study::Study& study = reading.study;
  yaml::Problems& problems = reading.problems;
  study::Goal& goal = study.goals.emplace_back();
  goal.name = name;
  goal.axis = reading.plan.units.axis;
  keys::read_key(field, *keys::find_general_key("goal"), reading);
  if (field.node->kind != yaml::YamlNode::Kind::map) return study.goals.pop_back();
  if (const auto within = yaml::find_field(field, "within"))
    check_within(*within, goal.within, reading.plan, problems);
  if (const auto on = yaml::find_field(field, "on")) read_moves(*on, reading.plan, goal.on, problems);
  const auto machines = yaml::find_field(field, "machines");
  if (machines && study.rigs == 0)
    problems.add(*machines, "without machines no trials share a machine",
                 "`rigs`, the number of machines, or the key left out");
  if (study.stop)
    problems.add(field, "its bounds need a number of trials that does not depend on the outcomes",
                 "no `stop`, or no goal");
  if (study.design == study::Design::saltelli)
    problems.add(field, "its bounds need trials that share no numbers", "another design, or no goal");
  if (reading.plan.open_loop)
    problems.add(field, "torque levels have no target", "command.targets, or no goal");
  measure_for(field, goal, reading);
}

}  // namespace

void read_bands(const yaml::Field& field, trial::ErrorBands& bands, yaml::Problems& problems) {
  const std::string expected =
      fmt::format("a list of 1 to {} increasing numbers of counts, such as [0, 1]", bands.limits.size());
  if (!yaml::check_list(field, expected, problems)) return;
  const std::size_t count = field.node->items.size();
  if (count < 1 || count > bands.limits.size()) {
    problems.add(field, fmt::format("found a list of {}", count), expected);
    return;
  }
  trial::ErrorBands read{.count = count};
  for (std::size_t i = 0; i < count; ++i) {
    const yaml::Field item = yaml::item_of(field, i);
    const auto limit = yaml::read_whole(item, 0, keys::max_band, problems);
    if (!limit) return;
    if (i > 0 && *limit <= read.limits[i - 1]) {
      problems.add(item, fmt::format("{} is not above {}", *limit, read.limits[i - 1]), expected);
      return;
    }
    read.limits[i] = *limit;
  }
  bands = read;
}

void read_goals(const yaml::Field& root, keys::Reading& reading) {
  const auto one = yaml::find_field(root, "goal");
  const auto several = yaml::find_field(root, "goals");
  if (one && several) {
    reading.problems.add(*several, "`goal` is there too", "one of them");
    return;
  }
  if (one) {
    read_goal(*one, "", reading);
    if (!reading.study.goals.empty()) read_limits(*one, reading, reading.study.goals.front());
  }
  if (!several) return;
  if (!yaml::check_map(*several,
                       "a map of goals by their names, such as {large: {within: 0.03, moves: 0.99}}",
                       reading.problems))
    return;
  if (several->node->entries.empty()) reading.problems.add(*several, "found no goal", "at least one");
  for (const yaml::YamlEntry& entry : several->node->entries) {
    if (entry.key.find_first_not_of(' ') == std::string::npos || entry.key.find('\n') != std::string::npos)
      reading.problems.add(yaml::entry_of(*several, entry), "the name of the goal is empty, or has two lines",
                           "a name such as large");
    read_goal(yaml::entry_of(*several, entry), entry.key, reading);
  }
  // A limit can be of the band of any goal.
  for (study::Goal& goal : reading.study.goals)
    read_limits(yaml::find_field(*several, goal.name).value(), reading, goal);
}

void read_stop(const yaml::Field& field, keys::Reading& reading) {
  study::Study& study = reading.study;
  study::StoppingRule& rule = study.stop.emplace();
  rule.block = study.trials;
  // If it cannot be read, no other fault follows from that.
  if (yaml::find_field(field, "max_trials")) rule.max_trials = keys::max_study_trials;
  keys::read_key(field, *keys::find_general_key("stop"), reading);
  if (field.node->kind != yaml::YamlNode::Kind::map) return study.stop.reset();
  check_order(field, rule, reading.problems);
  if (study.design != study::Design::monte_carlo) {
    reading.problems.add(field, "sequential stopping needs independently drawn trials",
                         "design: monte_carlo");
  }
  study.trials = rule.max_trials;
}

}  // namespace zerocount::sections
