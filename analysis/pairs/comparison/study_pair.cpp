#include "analysis/pairs/comparison/study_pair.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "core/failure/failure.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/study/setting_study.hpp"
#include "results/layout/recorded_values.hpp"

namespace zerocount::comparison {
namespace {

using manifest_text::value_or;
using reading::AllTrialsFile;

std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t max_named = 8;
  const std::size_t shown = std::min(names.size(), max_named);
  const std::string text =
      fmt::format("'{}'", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(shown), "', '"));
  return names.size() > shown ? fmt::format("{} and {} more", text, names.size() - shown) : text;
}

/// Requires that both files have the same names of something, such as design points.
/// @param before names in the baseline
/// @param after names in the current file
/// @param what noun for the things with these names: "design points"
/// @throws Failure (bad_data) with a list of the names without a partner
void require_same_names(const StudyPair& pair, const std::vector<std::string>& before,
                        const std::vector<std::string>& after, std::string_view what) {
  std::string problem;
  const auto add_lonely = [&](const ComparedStudy& study, std::vector<std::string> names,
                              const std::vector<std::string>& others) {
    const std::set<std::string_view> known(others.begin(), others.end());
    std::erase_if(names, [&](const std::string& name) { return known.contains(name); });
    if (!names.empty())
      problem += fmt::format("; only {} has {}", study.file.path().string(), some_of(names));
  };
  add_lonely(pair.baseline, before, after);
  add_lonely(pair.current, after, before);
  if (!problem.empty())
    throw Failure(ExitCode::bad_data,
                  fmt::format("the files cannot be compared: not the same {}{}", what, problem));
}

std::map<std::string, std::int64_t> points_by_label(const AllTrialsFile& file) {
  std::map<std::string, std::int64_t> points;
  const std::vector<std::string> labels = file.point_labels();
  for (std::size_t point = 0; point < labels.size(); ++point) {
    if (!points.emplace(labels[point], static_cast<std::int64_t>(point)).second)
      throw Failure(ExitCode::bad_data, fmt::format("{}: two design points have the label '{}'",
                                                    file.path().string(), labels[point]));
  }
  return points;
}

/// Text of a swept value that reads back to the same number; "drawn" for any NaN, which marks a value that is
/// drawn at random.
std::string exact_text(double value) {
  return std::isnan(value) ? "drawn" : fmt::format("{}", value);
}

void require_equal_axes(const StudyPair& pair) {
  const std::vector<study::SweepAxis> before = pair.baseline.file.axes();
  const std::vector<study::SweepAxis> after = pair.current.file.axes();
  const auto is_case = [](const study::SweepAxis& axis) { return axis.name == "case"; };
  if (std::ranges::any_of(before, is_case) && std::ranges::any_of(after, is_case)) return;
  std::set<std::string> names;
  for (const auto* axes : {&before, &after}) {
    for (const study::SweepAxis& axis : *axes) names.insert(axis.name);
  }
  for (const MatchedPoint& point : pair.points) {
    for (const std::string& name : names) {
      const std::string one = axis_value(before, name, point.baseline);
      const std::string two = axis_value(after, name, point.current);
      if (one == two) continue;
      throw Failure(
          ExitCode::bad_data,
          fmt::format("{}: its design point '{}' is not that of {}: the axis {} is {} there and {} here",
                      pair.current.file.path().string(), point.label, pair.baseline.file.path().string(),
                      name, one, two));
    }
  }
}

void match_points(StudyPair& pair) {
  const std::map<std::string, std::int64_t> old_points = points_by_label(pair.baseline.file);
  const std::map<std::string, std::int64_t> new_points = points_by_label(pair.current.file);
  const std::vector<std::string> labels = pair.baseline.file.point_labels();
  require_same_names(pair, labels, pair.current.file.point_labels(), "design points");
  for (const std::string& label : labels)
    pair.points.push_back({.label = label,
                           .baseline = old_points.at(label),
                           .current = new_points.at(label),
                           .design_point = label});
  require_equal_axes(pair);
}

/// The labels of the settings (conditions at ages) of the study. Empty without settings; the manifest is then
/// not parsed.
std::vector<std::string> labels_of_settings(const AllTrialsFile& file) {
  const bool any = file.root().contains("condition") || file.root().contains("age");
  return any ? study::labels_of(file.study().settings) : std::vector<std::string>();
}

/// Replaces each matched design point of the pair by one entry for each setting that it has; ordered by
/// point, then by setting.
/// @throws Failure (bad_data) if the files have different settings
void match_settings(StudyPair& pair) {
  const std::vector<std::string> names = labels_of_settings(pair.baseline.file);
  require_same_names(pair, names, labels_of_settings(pair.current.file), "conditions");
  if (names.empty()) return;
  for (ComparedStudy* study : {&pair.baseline, &pair.current}) {
    for (const std::string& name : names)
      study->under.push_back(study::setting_labelled(study->file.study(), name));
  }
  pair.settings = std::ssize(names);
  for (const MatchedPoint& point : std::exchange(pair.points, {})) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      MatchedPoint& one = pair.points.emplace_back(point);
      one.label = study::label_under(point.label, names[i]);
      one.setting = names[i];
      one.setting_at = i;
    }
  }
}

void require_same_kind(const StudyPair& pair) {
  const auto open_loop = [](const ComparedStudy& study) {
    return std::ranges::any_of(study.values,
                               [](const auto& value) { return value.first.starts_with("command.torque."); });
  };
  if (open_loop(pair.baseline) == open_loop(pair.current)) return;
  throw Failure(ExitCode::bad_data,
                fmt::format("{} and {} cannot be compared: one has targets, the other torque levels",
                            pair.baseline.file.path().string(), pair.current.file.path().string()));
}

constexpr const char* expected_goal = "expected one such as goal: {band: 1, within: 0.05, moves: 0.99}";

/// The goals in the manifest of the study; empty if it has none.
std::vector<study::Goal> goals_of(const ComparedStudy& study) {
  const bool has_goal = std::ranges::any_of(study.values, [](const auto& value) {
    return keys::is_within(value.first, "goal") || keys::is_within(value.first, "goals");
  });
  return has_goal ? study.file.study().goals : std::vector<study::Goal>();
}

std::int64_t whole_value(const ComparedStudy& study, const std::string& key) {
  return std::stoll(value_or(study.values, key, "0"));
}

/// Copy of the goal for this file. It judges the same mass as `goal`, but Goal::of_other_mass says whether,
/// in this file, the encoder of the other mass closes the loop.
study::Goal for_loop_of(const ComparedStudy& study, study::Goal goal) {
  const std::vector<study::Goal>& goals = study.file.study().goals;
  const auto own = std::ranges::find_if(goals, [](const study::Goal& one) { return one.of.has_value(); });
  if (goal.of && own != goals.end()) goal.of_other_mass = (goal.of == own->of) == own->of_other_mass;
  return goal;
}

/// The goals with the criteria by which the moves of this file are counted.
std::vector<GoalTrials> counted_in(const ComparedStudy& study, const std::vector<study::Goal>& goals) {
  std::vector<GoalTrials> all;
  for (const study::Goal& of_both : goals) {
    const study::Goal goal = for_loop_of(study, of_both);
    const std::optional<measures::MoveCriterion> criterion =
        measures::move_criterion_of(goal, study.file.features());
    if (!criterion)
      throw Failure(ExitCode::bad_data,
                    fmt::format("{}: it cannot be judged by the goal of the other ({}): it lacks its band, "
                                "tolerance or limits; expected a study that measures them, or measures "
                                "without the goal",
                                study.file.path().string(), goal::goal_sentence(goal)));
    const std::int64_t machines = whole_value(study, "machines");
    all.push_back(
        {goal, *criterion, machines, measures::CellCounts({machines, whole_value(study, "worlds"), 0})});
  }
  return all;
}

/// Throws the message that the manifest of the file has no goal, although one is needed.
/// @param purpose clause that says what the goal is needed for
/// @throws Failure (bad_input) always
[[noreturn]] void refuse_without_goal(const AllTrialsFile& file, std::string_view purpose) {
  throw Failure(ExitCode::bad_input, fmt::format("{}: its manifest has no goal, {}; {}", file.path().string(),
                                                 purpose, expected_goal));
}

/// The measure with the same band or tolerance in the file's own table.
/// @param wanted measure of an error band or tolerance that a requirement names
/// @throws Failure (bad_input) if the file lacks it
GateMeasure in_file(const AllTrialsFile& file, const GateMeasure& wanted) {
  const bool of_tolerance = wanted.measure->tolerance.has_value();
  std::vector<std::string> limits;
  for (const layout::Measure& measure : file.table()) {
    if (!layout::is_in_file(measure, file.features())) continue;
    if (measure.field.column.name == wanted.name) return {&measure, wanted.name, wanted.unit, wanted.margin};
    if (of_tolerance && measure.tolerance) limits.push_back(fmt::format("{}", *measure.tolerance));
    if (!of_tolerance && measure.field.column.name.starts_with("band_exits"))
      limits.push_back(std::to_string(measure.band.value()));
  }
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: it has no {}; expected a requirement of one of its {}: {}",
                            file.path().string(), wanted.name, of_tolerance ? "tolerances" : "bands",
                            limits.empty() ? "none" : fmt::format("{}", fmt::join(limits, ", "))));
}

/// Sets the goals whose measures are judged, and the values that the requirements need. The goals are those
/// of the baseline or, if it has none, of the current file.
void take_goals(StudyPair& pair, const GateRules& rules) {
  const std::vector<study::Goal> before = goals_of(pair.baseline);
  const std::vector<study::Goal> after = goals_of(pair.current);
  pair.goals_of_baseline = !before.empty();
  if (judges_by_goal(rules)) {
    pair.goals = before.empty() ? after : before;
    if (pair.goals.empty() && names_goal_measure(rules))
      refuse_without_goal(pair.current.file, "by whose measures it is to be judged");
  }
  for (ComparedStudy* study : {&pair.baseline, &pair.current})
    study->also.judged = counted_in(*study, pair.goals);
  AlsoRead& also = pair.current.also;
  also.claims = std::max(after.size(), std::size_t{1}) * static_cast<std::size_t>(pair.settings);
  if (requires_goal(rules)) {
    if (after.empty()) refuse_without_goal(pair.current.file, "which a requirement asks for");
    also.required = counted_in(pair.current, after);
  }
  for (const GateMeasure& measure : measures_of_limits(rules))
    also.bands.push_back(in_file(pair.current.file, measure));
}

/// Sets the number of compared trials of each point, and the clusters of dependent trials. If the studies
/// have different worlds (draws of what all machines share), the trials in one world are dependent; otherwise
/// the trials on one machine.
void take_trials(StudyPair& pair, const GateRules& rules) {
  const std::string before = value_or(pair.baseline.values, "worlds", "0");
  const std::string after = value_or(pair.current.values, "worlds", "0");
  pair.in_worlds = before != "0" || after != "0";
  const bool same_seed = pair.baseline.file.header().seed == pair.current.file.header().seed;
  pair.other_worlds = before != after || (after != "0" && !same_seed);
  for (ComparedStudy* study : {&pair.baseline, &pair.current}) {
    const std::int64_t worlds = whole_value(*study, "worlds");
    study->machines = pair.other_worlds && worlds > 0 ? worlds : whole_value(*study, "machines");
    study->also.machines = study->machines;
    const AllTrialsFile under = study->trials_of(pair.points.front());
    study->trials = std::min(under.header().trials, std::max(trial_limit(rules, under), study->machines));
  }
}

std::vector<std::string> names_of(const std::vector<GoalTrials>& goals) {
  std::vector<std::string> names;
  for (const GoalTrials& one : goals) names.push_back(one.goal.name);
  return names;
}

/// Relation between the values of one random parameter in the two files, trial by trial; the worst relation
/// comes last. same_order: the values differ, but sort the trials in the same order.
enum class InputRelation { equal, same_order, different };

InputRelation relation_of(const std::vector<double>& before, const std::vector<double>& after) {
  if (before == after) return InputRelation::equal;
  std::vector<std::size_t> order(before.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return before[a] != before[b] ? before[a] < before[b] : after[a] < after[b];
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (after[order[i]] < after[order[i - 1]]) return InputRelation::different;
  }
  return InputRelation::same_order;
}

/// The worst relation between the values of one random parameter in the two files, over all points.
InputRelation relation_over_points(const StudyPair& pair, std::pair<std::size_t, std::size_t> columns) {
  const std::int64_t trials = std::min(pair.baseline.trials, pair.current.trials);
  const auto values = [&](const ComparedStudy& study, const MatchedPoint& point, std::int64_t at,
                          std::size_t column) {
    const AllTrialsFile file = study.trials_of(point);
    return file.input(column, {at * file.header().trials, trials});
  };
  InputRelation worst = InputRelation::equal;
  for (const MatchedPoint& point : pair.points)
    worst = std::max(worst, relation_of(values(pair.baseline, point, point.baseline, columns.first),
                                        values(pair.current, point, point.current, columns.second)));
  return worst;
}

}  // namespace

std::string axis_value(const std::vector<study::SweepAxis>& axes, const std::string& name,
                       std::int64_t point) {
  const auto at = static_cast<std::size_t>(point);
  for (const study::SweepAxis& axis : axes) {
    if (axis.name != name) continue;
    return axis.kind == study::SweepAxis::Kind::text ? axis.texts.at(at) : exact_text(axis.numbers.at(at));
  }
  return "missing";
}

std::int64_t trial_limit(const GateRules& rules, const AllTrialsFile& file) {
  return std::max(std::int64_t{1}, rules.max_trials.value_or(default_compared_moves / file.moves()));
}

void require_independent_trials(const ComparedStudy& study) {
  if (value_or(study.values, "design", "") != "saltelli") return;
  throw Failure(ExitCode::bad_data,
                fmt::format("{}: cannot be compared: the trials of `design: saltelli` are not independent; "
                            "expected a study of another design",
                            study.file.path().string()));
}

StudyPair pair_studies(const AllTrialsFile& baseline, const AllTrialsFile& current, const GateRules& rules) {
  StudyPair pair{{baseline}, {current}};
  match_points(pair);
  for (ComparedStudy* study : {&pair.baseline, &pair.current})
    study->values = layout::manifest_values(study->file.header(), study->file.path().string());
  require_same_kind(pair);
  match_settings(pair);
  take_trials(pair, rules);
  take_goals(pair, rules);
  return pair;
}

StudyPair pair_points(const AllTrialsFile& file, std::int64_t baseline, std::int64_t current,
                      const GateRules& rules) {
  StudyPair pair{{file}, {file}};
  const std::string label = file.point_labels()[static_cast<std::size_t>(current)];
  pair.points = {{.label = label, .baseline = baseline, .current = current, .design_point = label}};
  pair.baseline.values = layout::manifest_values(file.header(), file.path().string());
  pair.current.values = pair.baseline.values;
  require_independent_trials(pair.current);
  match_settings(pair);
  take_trials(pair, rules);
  take_goals(pair, rules);
  return pair;
}

GateRules rules_for(const StudyPair& pair, const GateRules& rules) {
  require_named_goals(rules, names_of(pair.current.also.judged), pair.current.file.path().string());
  std::multimap<std::string, std::string> labels;
  for (const MatchedPoint& point : pair.points) labels.emplace(point.design_point, point.label);
  return expanded(rules, labels, names_of(pair.current.also.required));
}

DrawComparison compare_draws(const StudyPair& pair) {
  const auto differ = [&](const char* key, const char* absent) {
    return value_or(pair.baseline.values, key, absent) != value_or(pair.current.values, key, absent);
  };
  const AllTrialsFile& baseline = pair.baseline.file;
  const AllTrialsFile& current = pair.current.file;
  if (&baseline == &current && value_or(pair.current.values, "independent_points", "false") == "true")
    return {false, "the points have random numbers of their own"};
  if (baseline.header().seed != current.header().seed) return {false, "the seeds differ"};
  for (const auto& [key, absent] :
       {std::pair{"design", "monte_carlo"}, std::pair{"independent_points", "false"},
        std::pair{"worlds", "0"}, std::pair{"machines", "0"}}) {
    if (differ(key, absent)) return {false, fmt::format("the manifests differ in {}", key)};
  }
  DrawComparison result{true, "trial i drew the same random numbers in both"};
  const std::vector<study::InputColumn>& partners = current.input_columns();
  for (std::size_t column = 0; column < baseline.input_columns().size(); ++column) {
    const std::string& name = baseline.input_columns()[column].name;
    const auto partner = std::ranges::find(partners, name, &study::InputColumn::name);
    if (partner == partners.end()) continue;
    const InputRelation relation =
        relation_over_points(pair, {column, static_cast<std::size_t>(partner - partners.begin())});
    if (relation == InputRelation::different)
      return {false, fmt::format("trial i has other values of {}", name)};
    if (relation == InputRelation::same_order) result.changed_inputs.push_back(name);
  }
  return result;
}

}  // namespace zerocount::comparison
