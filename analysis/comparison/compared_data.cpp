#include "analysis/comparison/compared_data.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

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

/// The measure of the file's own bands in place of the one that a requirement names.
GateMeasure in_file(const reading::AllTrialsFile& file, const GateMeasure& wanted) {
  std::string bands;
  for (const layout::Measure& measure : file.table()) {
    if (measure.field.column.name == wanted.name) return {&measure, wanted.name, wanted.unit, wanted.margin};
    if (measure.band && measure.field.column.name.starts_with("band_exits"))
      bands += (bands.empty() ? "" : ", ") + std::to_string(*measure.band);
  }
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: it has no {}; expected a requirement of one of its bands: {}",
                            file.path().string(), wanted.name, bands.empty() ? "none" : bands));
}

constexpr const char* expected_goal = "expected one such as goal: {band: 1, within: 0.05, moves: 0.99}";

/// The goal of the manifest.
std::optional<study::Goal> goal_of(const reading::AllTrialsFile& file,
                                   const manifest_text::ManifestValues& values) {
  const bool has_goal = std::any_of(values.begin(), values.end(), [](const auto& value) {
    return keys::is_within(value.first, "goal") || keys::is_within(value.first, "goals");
  });
  if (!has_goal) return std::nullopt;
  goal::require_one_goal(file.study(), file.path().string());
  return file.study().goals.front();
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

/// The goal that a requirement asks for.
std::optional<TrialGoal> required_goal(const GateRules& rules, const reading::AllTrialsFile& file,
                                       const std::optional<study::Goal>& goal) {
  if (!requires_goal(rules)) return std::nullopt;
  if (goal) return counted_in(file, *goal);
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: its manifest has no goal, which a requirement asks for; {}",
                            file.path().string(), expected_goal));
}

/// The goal whose measures are judged: that of the baseline, else that of the current file.
std::optional<study::Goal> judged_goal(const GateRules& rules, const reading::AllTrialsFile& current,
                                       const std::optional<study::Goal>& old_goal,
                                       const std::optional<study::Goal>& new_goal) {
  if (!judges_by_goal(rules)) return std::nullopt;
  const std::optional<study::Goal>& goal = old_goal ? old_goal : new_goal;
  if (!goal && names_goal_measure(rules)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: its manifest has no goal, by whose measures it is to be judged; {}",
                              current.path().string(), expected_goal));
  }
  return goal;
}

/// The trials of a file that its judgement by the goal needs.
AlsoRead read_by(const std::optional<study::Goal>& goal, const reading::AllTrialsFile& file,
                 const manifest_text::ManifestValues& values, std::int64_t clusters) {
  AlsoRead also;
  also.rigs = clusters;
  also.goal_rigs = whole_value(values, "rigs");
  also.worlds = whole_value(values, "worlds");
  if (goal) also.judged = counted_in(file, *goal);
  return also;
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
  data.baseline_trials = compared_trials(rules, baseline, data.baseline_rigs);
  data.current_trials = compared_trials(rules, current, data.current_rigs);
  const std::optional<study::Goal> old_goal = goal_of(baseline, old_values);
  const std::optional<study::Goal> new_goal = &baseline == &current ? old_goal : goal_of(current, new_values);
  data.goal = judged_goal(rules, current, old_goal, new_goal);
  data.goal_of_baseline = old_goal.has_value();
  data.of_baseline = read_by(data.goal, baseline, old_values, data.baseline_rigs);
  data.of_current = read_by(data.goal, current, new_values, data.current_rigs);
  data.of_current.required = required_goal(rules, current, new_goal);
  for (const GateMeasure& measure : measures_of_bands(rules))
    data.of_current.bands.push_back(in_file(current, measure));
  return data;
}

TrialsOfBoth read_trials(const ComparedData& data, const MatchedPoint& point) {
  return {read_point_trials(data.baseline, point.baseline, data.baseline_trials, data.of_baseline),
          read_point_trials(data.current, point.current, data.current_trials, data.of_current)};
}

}  // namespace zerocount::comparison
