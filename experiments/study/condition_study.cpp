#include "experiments/study/condition_study.hpp"

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

/// A copy of the axis with only one of its options.
PlanAxis only_option(const PlanAxis& axis, std::size_t option) {
  PlanAxis only;
  for (std::size_t i = axis.first[option]; i < axis.first[option + 1]; ++i)
    only.assignments.push_back(axis.assignments[i]);
  only.first.push_back(static_cast<std::uint32_t>(only.assignments.size()));
  return only;
}

/// Removes the columns of other conditions, and the suffix of this condition from the names that stay.
void keep_condition(std::int64_t condition, std::vector<InputColumn>& columns,
                    std::vector<InputSource>& sources) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const bool overridden = sources[i].condition.has_value();
    if (overridden && sources[i].condition != condition) continue;
    columns[kept] = columns[i];
    sources[kept] = {sources[i].slot, sources[i].profile_mean};
    if (overridden) columns[kept].name.resize(columns[kept].name.find(under_suffix("")));
    ++kept;
  }
  columns.resize(kept);
  sources.resize(kept);
}

}  // namespace

Study under_condition(const Study& study, std::int64_t condition) {
  Study one = study;
  if (study.conditions.empty()) return one;
  auto plan = std::make_shared<StudyPlan>(*study.plan);
  PlanAxis& conditions = plan->axes[plan->condition_axis];
  conditions = only_option(conditions, static_cast<std::size_t>(condition));
  if (!plan->ages.empty()) plan->ages = {age_at(*plan, plan_point(*plan, 0, condition))};
  plan->conditions = 0;
  for (const GroupingTraits& of : groupings)
    keep_condition(condition, one.columns.shared[of.grouping], plan->shared_inputs[of.grouping]);
  one.plan = std::move(plan);
  one.trials = draw_count(study);
  one.conditions.clear();
  one.condition_names.clear();
  one.ages.at.clear();
  const TrialIndices indices = trial_indices(study);
  one.retained_trials.clear();
  for (const std::int64_t trial : study.retained_trials) {
    if (indices.condition_of(trial) == condition) one.retained_trials.push_back(indices.draw_of(trial));
  }
  return one;
}

bool differs_under_condition(const Study& one, std::size_t column) {
  const InputSource& source = one.plan->inputs[column];
  const Value::Kind kind = value_at_point(*one.plan, source.slot, 0)->kind;
  if (source.profile_mean) return kind == Value::Kind::profile;
  return kind != Value::Kind::number || std::ranges::find(one.points.axes, one.columns.inputs[column].name,
                                                          &SweepAxis::name) != one.points.axes.end();
}

std::string under_suffix(std::string_view place) {
  return fmt::format("@{}", place);
}

std::string label_under(std::string_view label, std::string_view condition) {
  return condition.empty() ? std::string(label) : fmt::format("{}, {}", label, condition);
}

std::int64_t setting_named(const Study& study, const std::optional<std::string>& condition,
                           const std::optional<double>& age) {
  const auto place_in = [&study](const auto& all, const auto& wanted, std::string_view noun,
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
  return place_in(study.condition_names, condition, "condition", "--condition") +
         conditions_of_age(study) * place_in(study.ages.at, age, "age", "--age");
}

std::int64_t condition_named(const Study& study, std::string_view name) {
  const auto found = std::ranges::find(study.conditions, name);
  if (found != study.conditions.end()) return found - study.conditions.begin();
  throw Failure(ExitCode::bad_input,
                study.conditions.empty()
                    ? fmt::format("{}: it has no conditions, and so no '{}'", study.name, name)
                    : fmt::format("{}: it has no condition '{}'; expected one of {}", study.name, name,
                                  fmt::join(study.conditions, ", ")));
}

}  // namespace zerocount::study
