#include "experiments/study/plan.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {

std::int64_t group_count(const Study& study, Grouping grouping) {
  switch (grouping) {
    case Grouping::machine:
      return study.machines;
    case Grouping::world:
      return study.worlds;
    case Grouping::condition:
      return std::ssize(study.settings.conditions);
    case Grouping::age:
      break;
  }
  return std::ssize(study.settings.ages.at);
}

TrialIndices trial_indices(const Study& study) {
  const auto at_least_one = [](std::int64_t count) { return std::max<std::int64_t>(count, 1); };
  return {at_least_one(study.machines), study.settings.counts(), at_least_one(study.worlds)};
}

std::int64_t draw_count(const Study& study, DrawLevel level) {
  switch (level) {
    case DrawLevel::study:
      break;
    case DrawLevel::world:
      return study.worlds;
    case DrawLevel::machine:
      return study.machines;
    case DrawLevel::trial:
    case DrawLevel::contact:
      return draw_count(study);
  }
  return 1;
}

bool changes_with_age(const StudyPlan& plan, std::size_t slot) {
  if (plan.agings.empty()) return false;
  const Value& base = plan.base[slot];
  if (base.kind == Value::Kind::derived) {
    return std::ranges::any_of(plan.derived[base.index].from,
                               [&](std::uint32_t source) { return changes_with_age(plan, source); });
  }
  return base.aging || std::ranges::any_of(plan.axes, [slot](const PlanAxis& axis) {
           return std::ranges::any_of(axis.assignments, [slot](const Assignment& one) {
             return one.slot == slot && one.value.aging;
           });
         });
}

std::size_t option_at(const StudyPlan& plan, std::size_t axis, std::size_t point) {
  for (std::size_t faster = plan.axes.size() - 1; faster > axis; --faster)
    point /= option_count(plan.axes[faster]);
  return point % option_count(plan.axes[axis]);
}

const Value* value_at_point(const StudyPlan& plan, std::size_t slot, std::size_t point) {
  for (std::size_t a = plan.axes.size(); a-- > 0;) {
    const PlanAxis& axis = plan.axes[a];
    const std::size_t option = option_at(plan, a, point);
    for (std::size_t i = axis.first[option]; i < axis.first[option + 1]; ++i) {
      if (axis.assignments[i].slot == slot) return &axis.assignments[i].value;
    }
  }
  return &plan.base[slot];
}

std::vector<const Value*> values_at(const StudyPlan& plan, std::size_t point) {
  std::vector<const Value*> values;
  values.reserve(plan.base.size());
  for (const Value& value : plan.base) values.push_back(&value);
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    const PlanAxis& axis = plan.axes[a];
    const std::size_t option = option_at(plan, a, point);
    for (std::size_t i = axis.first[option]; i < axis.first[option + 1]; ++i) {
      values[axis.assignments[i].slot] = &axis.assignments[i].value;
    }
  }
  return values;
}

}  // namespace zerocount::study
