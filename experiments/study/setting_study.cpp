#include "experiments/study/setting_study.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/failure/failure.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {
namespace {

/// A copy of the plan's axis with only one of its options.
PlanAxis only_option(const PlanAxis& axis, std::size_t option) {
  PlanAxis only;
  for (std::size_t i = axis.first[option]; i < axis.first[option + 1]; ++i)
    only.assignments.push_back(axis.assignments[i]);
  only.first.push_back(static_cast<std::uint32_t>(only.assignments.size()));
  return only;
}

/// Removes the columns that belong to other settings (conditions at an age), and the suffix of this setting
/// from the names of the columns that stay.
void keep_setting(std::int64_t setting, std::vector<InputColumn>& columns,
                  std::vector<InputSource>& sources) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const bool of_one_setting = sources[i].setting.has_value();
    if (of_one_setting && sources[i].setting != setting) continue;
    columns[kept] = columns[i];
    sources[kept] = {sources[i].slot, sources[i].profile_mean};
    if (of_one_setting) columns[kept].name.resize(columns[kept].name.find(under_suffix("")));
    ++kept;
  }
  columns.resize(kept);
  sources.resize(kept);
}

}  // namespace

Study in_setting(const Study& study, std::int64_t setting) {
  Study one = study;
  if (study.settings.empty()) return one;
  auto plan = std::make_shared<StudyPlan>(*study.plan);
  PlanAxis& axis = plan->axes[plan->settings_axis.value()];
  axis = only_option(axis, static_cast<std::size_t>(setting));
  if (!plan->ages.empty()) plan->ages = {age_at(*plan, plan_point(*plan, 0, setting))};
  plan->settings = {};
  plan->settings_axis.reset();
  for (const GroupingTraits& of : groupings)
    keep_setting(setting, one.columns.shared[of.grouping], plan->shared_inputs[of.grouping]);
  one.plan = std::move(plan);
  one.trials = draw_count(study);
  one.settings.conditions.clear();
  one.settings.ages.at.clear();
  const TrialIndices indices = trial_indices(study);
  one.retained_trials.clear();
  for (const std::int64_t trial : study.retained_trials) {
    if (indices.setting_of(trial) == setting) one.retained_trials.push_back(indices.draw_of(trial));
  }
  return one;
}

bool differs_in_setting(const Study& one, std::size_t column) {
  const InputSource& source = one.plan->inputs[column];
  const Value::Kind kind = value_at_point(*one.plan, source.slot, 0)->kind;
  if (source.profile_mean) return kind == Value::Kind::profile;
  return kind != Value::Kind::number || std::ranges::find(one.points.axes, one.columns.inputs[column].name,
                                                          &SweepAxis::name) != one.points.axes.end();
}

std::string under_suffix(std::string_view place) {
  return fmt::format("@{}", place);
}

std::string label_under(std::string_view label, std::string_view setting) {
  return setting.empty() ? std::string(label) : fmt::format("{}, {}", label, setting);
}

std::int64_t setting_named(const Study& study, const std::optional<std::string>& condition,
                           const std::optional<double>& age) {
  const auto index_in = [&study](const auto& all, const auto& wanted, std::string_view noun,
                                 std::string_view option) -> std::int64_t {
    if (all.empty() && wanted)
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: it has no {}s; expected no {}", study.name, noun, option));
    if (all.size() < 2 && !wanted) return 0;
    const auto found = wanted ? std::ranges::find(all, *wanted) : all.end();
    if (found != all.end()) return found - all.begin();
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: every machine is simulated at each of its {} {}s; expected {} "
                              "with one of {}",
                              study.name, all.size(), noun, option, fmt::join(all, ", ")));
  };
  const Settings& settings = study.settings;
  return settings.counts().index_of(
      {.condition = index_in(settings.conditions, condition, "condition", "--condition"),
       .age = index_in(settings.ages.at, age, "age", "--age")});
}

std::int64_t setting_labelled(const Study& study, std::string_view label) {
  const std::vector<std::string> labels = labels_of(study.settings);
  const auto found = std::ranges::find(labels, label);
  if (found != labels.end()) return found - labels.begin();
  throw Failure(ExitCode::bad_input,
                labels.empty() ? fmt::format("{}: it has no conditions, and so no '{}'", study.name, label)
                               : fmt::format("{}: it has no condition '{}'; expected one of {}", study.name,
                                             label, fmt::join(labels, ", ")));
}

}  // namespace zerocount::study
