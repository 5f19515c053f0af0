#include "analysis/comparison/compared_data.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/goal/goal_text.hpp"
#include "analysis/goal/question.hpp"
#include "core/failure/failure.hpp"
#include "experiments/keys/manifest_keys.hpp"

namespace zerocount::comparison {
namespace {

std::int64_t whole_value(const manifest_text::ManifestValues& values, const std::string& key) {
  return std::stoll(manifest_text::value_or(values, key, "0"));
}

/// The number of rigs that the trials of a study run on, 0 without. Where two studies have different worlds,
/// these are the groups of trials that are not independent.
std::int64_t rigs_of(const manifest_text::ManifestValues& values, bool other_worlds) {
  const std::int64_t worlds = whole_value(values, "worlds");
  return other_worlds && worlds > 0 ? worlds : whole_value(values, "rigs");
}

/// Whether studies have worlds, and not the same ones.
bool have_other_worlds(const reading::AllTrialsFile& baseline,
                       const manifest_text::ManifestValues& old_values, const reading::AllTrialsFile& current,
                       const manifest_text::ManifestValues& new_values) {
  const std::string before = manifest_text::value_or(old_values, "worlds", "0");
  const std::string after = manifest_text::value_or(new_values, "worlds", "0");
  return before != after || (after != "0" && baseline.header().seed != current.header().seed);
}

/// The trials of each point of a file that are compared: of every rig at least one.
std::int64_t compared_trials(const GateRules& rules, const reading::AllTrialsFile& file, std::int64_t rigs) {
  return std::min(file.header().trials, std::max(trial_limit(rules, file), rigs));
}

/// The measure of the file's own error bands or tolerances in place of the one that a requirement names.
GateMeasure in_file(const reading::AllTrialsFile& file, const GateMeasure& wanted) {
  const bool of_tolerance = wanted.measure->tolerance.has_value();
  std::string limits;
  for (const layout::Measure& measure : file.table()) {
    if (measure.field.column.name == wanted.name) return {&measure, wanted.name, wanted.unit, wanted.margin};
    const bool is_limit =
        of_tolerance ? measure.tolerance.has_value() : measure.field.column.name.starts_with("band_exits");
    if (!is_limit) continue;
    limits += (limits.empty() ? "" : ", ") +
              (of_tolerance ? fmt::format("{}", *measure.tolerance) : std::to_string(measure.band.value()));
  }
  throw Failure(
      ExitCode::bad_input,
      fmt::format("{}: it has no {}; expected a requirement of one of its {}: {}", file.path().string(),
                  wanted.name, of_tolerance ? "tolerances" : "bands", limits.empty() ? "none" : limits));
}

constexpr const char* expected_goal = "expected one such as goal: {band: 1, within: 0.05, moves: 0.99}";

/// The goals of the manifest.
std::vector<study::Goal> goals_of(const reading::AllTrialsFile& file,
                                  const manifest_text::ManifestValues& values) {
  const bool has_goal = std::any_of(values.begin(), values.end(), [](const auto& value) {
    return keys::is_within(value.first, "goal") || keys::is_within(value.first, "goals");
  });
  return has_goal ? file.study().goals : std::vector<study::Goal>();
}

/// The goal as the moves of the file are counted by it.
/// @throws Failure (bad_data) where the file does not have what it is judged by
TrialGoal counted_in(const reading::AllTrialsFile& file, const study::Goal& goal) {
  if (const auto counted = measures::counted_by(goal, file.features())) return {goal, *counted};
  throw Failure(
      ExitCode::bad_data,
      fmt::format("{}: it cannot be judged by the goal of the other ({}): it lacks its band, tolerance or "
                  "limits; expected a study that measures them, or measures without the goal",
                  file.path().string(), goal::goal_sentence(goal)));
}

std::vector<TrialGoal> all_counted_in(const reading::AllTrialsFile& file,
                                      const std::vector<study::Goal>& goals) {
  std::vector<TrialGoal> counted;
  counted.reserve(goals.size());
  for (const study::Goal& goal : goals) counted.push_back(counted_in(file, goal));
  return counted;
}

/// The goals that a requirement asks for.
std::vector<TrialGoal> required_goals(const GateRules& rules, const reading::AllTrialsFile& file,
                                      const std::vector<study::Goal>& goals) {
  if (!requires_goal(rules)) return {};
  if (!goals.empty()) return all_counted_in(file, goals);
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: its manifest has no goal, which a requirement asks for; {}",
                            file.path().string(), expected_goal));
}

/// The goals whose measures are judged: those of the baseline, else those of the current file.
std::vector<study::Goal> judged_goals(const GateRules& rules, const reading::AllTrialsFile& current,
                                      const std::vector<study::Goal>& before,
                                      const std::vector<study::Goal>& after) {
  if (!judges_by_goal(rules)) return {};
  const std::vector<study::Goal>& goals = before.empty() ? after : before;
  if (goals.empty() && names_goal_measure(rules)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: its manifest has no goal, by whose measures it is to be judged; {}",
                              current.path().string(), expected_goal));
  }
  return goals;
}

/// The trials of a file that its judgement by the goals needs.
AlsoRead read_by(const std::vector<study::Goal>& goals, const reading::AllTrialsFile& file,
                 const manifest_text::ManifestValues& values, std::int64_t clusters) {
  AlsoRead also;
  also.rigs = clusters;
  also.goal_rigs = whole_value(values, "rigs");
  also.worlds = whole_value(values, "worlds");
  also.judged = all_counted_in(file, goals);
  return also;
}

std::vector<std::string> names_of(const std::vector<TrialGoal>& goals) {
  std::vector<std::string> names;
  names.reserve(goals.size());
  for (const TrialGoal& one : goals) names.push_back(one.goal.name);
  return names;
}

/// Number of different conditions of the points.
std::int64_t conditions_of(const std::vector<MatchedPoint>& points) {
  std::set<std::string> names;
  for (const MatchedPoint& point : points) names.insert(point.condition);
  return std::ssize(names);
}

}  // namespace

std::int64_t trial_limit(const GateRules& rules, const reading::AllTrialsFile& file) {
  return std::max(std::int64_t{1}, rules.max_trials.value_or(default_compared_moves / file.moves()));
}

ComparedData compared_data(const reading::AllTrialsFile& baseline,
                           const manifest_text::ManifestValues& old_values,
                           const reading::AllTrialsFile& current,
                           const manifest_text::ManifestValues& new_values, std::vector<MatchedPoint> points,
                           const GateRules& rules) {
  const bool other = have_other_worlds(baseline, old_values, current, new_values);
  ComparedData data{baseline, current, std::move(points), rigs_of(old_values, other),
                    rigs_of(new_values, other)};
  data.other_worlds = other;
  data.in_worlds = manifest_text::value_or(new_values, "worlds", "0") != "0" ||
                   manifest_text::value_or(old_values, "worlds", "0") != "0";
  data.conditions = conditions_of(data.points);
  const MatchedPoint& first = data.points.front();
  data.baseline_trials = compared_trials(rules, *first.in_baseline, data.baseline_rigs);
  data.current_trials = compared_trials(rules, *first.in_current, data.current_rigs);
  const std::vector<study::Goal> before = goals_of(baseline, old_values);
  const std::vector<study::Goal> after = &baseline == &current ? before : goals_of(current, new_values);
  data.goals = judged_goals(rules, current, before, after);
  data.goals_of_baseline = !before.empty();
  data.of_baseline = read_by(data.goals, baseline, old_values, data.baseline_rigs);
  data.of_current = read_by(data.goals, current, new_values, data.current_rigs);
  data.of_current.required = required_goals(rules, current, after);
  data.of_current.claims = std::max(after.size(), std::size_t{1}) * static_cast<std::size_t>(data.conditions);
  for (const GateMeasure& measure : measures_of_limits(rules))
    data.of_current.bands.push_back(in_file(current, measure));
  return data;
}

GateRules rules_for(const ComparedData& data, const GateRules& rules) {
  require_named_goals(rules, names_of(data.of_current.judged), data.current.path().string());
  std::multimap<std::string, std::string> labels;
  for (const MatchedPoint& point : data.points) labels.emplace(point.design_point, point.label);
  return expanded(rules, labels, names_of(data.of_current.required));
}

TrialsOfBoth read_trials(const ComparedData& data, const MatchedPoint& point) {
  return {read_point_trials(*point.in_baseline, point.baseline, data.baseline_trials, data.of_baseline),
          read_point_trials(*point.in_current, point.current, data.current_trials, data.of_current)};
}

}  // namespace zerocount::comparison
