#include "experiments/study/condition_study.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/failure/failure.hpp"
#include "experiments/study/plan.hpp"

namespace zerocount::study {
namespace {

/// The axis with one of its options only.
PlanAxis only_option(const PlanAxis& axis, std::size_t option) {
  PlanAxis only;
  for (std::size_t i = axis.first[option]; i < axis.first[option + 1]; ++i)
    only.assignments.push_back(axis.assignments[i]);
  only.first.push_back(static_cast<std::uint32_t>(only.assignments.size()));
  return only;
}

}  // namespace

Study under_condition(const Study& study, std::int64_t condition) {
  Study one = study;
  if (study.conditions.empty()) return one;
  auto plan = std::make_shared<StudyPlan>(*study.plan);
  PlanAxis& conditions = plan->axes[plan->condition_axis];
  conditions = only_option(conditions, static_cast<std::size_t>(condition));
  plan->conditions = 0;
  one.plan = std::move(plan);
  one.trials = draw_count(study);
  one.conditions.clear();
  const TrialTurns turns = turns_of(study);
  one.retained_trials.clear();
  for (const std::int64_t trial : study.retained_trials) {
    if (turns.condition_of(trial) == condition) one.retained_trials.push_back(turns.draw_of(trial));
  }
  return one;
}

std::string label_under(std::string_view label, std::string_view condition) {
  return condition.empty() ? std::string(label) : fmt::format("{}, {}", label, condition);
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
