#include "experiments/study/group_inputs.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/study/trial_draws.hpp"

namespace zerocount::study {

std::vector<double> group_inputs(const Study& study, Grouping grouping, std::int64_t group) {
  const std::int64_t count = group_count(study, grouping);
  if (group < 0 || group >= count) {
    throw Failure(ExitCode::bad_input, fmt::format("study {} has no {} {}; expected 0 to {}", study.name,
                                                   traits_of(grouping).name, group, count - 1));
  }
  const StudyPlan& plan = *study.plan;
  const GivenDraws none;
  const TrialDraws draws = draws_of(study, 0, group, none);  // of its first trial, which has its number
  std::vector<double> inputs;
  for (const InputSource& source : plan.shared_inputs[grouping]) {
    const std::size_t place = plan_point(plan, 0, source.setting.value_or(0));
    inputs.push_back(source.profile_mean ? profile_mean(draws, source.slot, place)
                                         : number_at(draws, source.slot, place));
  }
  return inputs;
}

std::vector<WorldValues> world_values(const Study& study, std::int64_t point) {
  std::vector<WorldValues> found;
  if (study.worlds == 0) return found;
  const StudyPlan& plan = *study.plan;
  const GivenDraws none;
  for (const std::uint32_t slot : plan.input_slots) {
    const Value& value = *value_at_point(plan, slot, plan_point(plan, point));
    if (value.kind != Value::Kind::distribution || value.level != DrawLevel::world) continue;
    const parameters::Parameter& parameter = plan.table.rows[slot];
    WorldValues& values = found.emplace_back(
        WorldValues{std::string(parameter.name), parameters::unit_of(parameter, plan.units), {}});
    for (std::int64_t world = 0; world < study.worlds; ++world) {
      values.values.push_back(
          distributions::quantile(plan.distributions[value.index],
                                  uniform_of(draws_of(study, point, world, none), slot, value.level)));
    }
  }
  return found;
}

namespace {

bool is_of_the_move(std::string_view name) {
  return name.starts_with("initial.") || name.starts_with("command.");
}

}  // namespace

bool differs_between_machines(const Study& study, DrawLevel level, std::string_view name) {
  switch (level) {
    case DrawLevel::world:
    case DrawLevel::machine:
      return true;
    case DrawLevel::trial:
      return study.machines == 0 && !is_of_the_move(name);
    case DrawLevel::study:
    case DrawLevel::contact:
      break;
  }
  return false;
}

std::vector<MachineInput> machine_inputs(const Study& study, std::int64_t point) {
  const StudyPlan& plan = *study.plan;
  const std::vector<const Value*> values = values_at(plan, plan_point(plan, point));
  std::vector<MachineInput> inputs;
  MachineInput joint;
  bool joint_differs = false;
  for (const std::uint32_t slot : plan.input_slots) {
    if (values[slot]->kind != Value::Kind::distribution) continue;
    const std::string name(plan.table.rows[slot].name);
    const bool differs = differs_between_machines(study, values[slot]->level, name);
    if (std::ranges::find(plan.sampled_slots, slot) != plan.sampled_slots.end()) {
      joint.name += (joint.name.empty() ? "" : ", ") + name;
      joint.slots.push_back(slot);
      joint_differs |= differs;
    } else if (differs) {
      inputs.push_back({name, {slot}});
    }
  }
  if (joint_differs) inputs.push_back(std::move(joint));
  return inputs;
}

std::vector<std::pair<std::string, double>> values_at_quantile(const Study& study, std::int64_t point,
                                                               const MachineInput& input, double quantile) {
  const StudyPlan& plan = *study.plan;
  const std::vector<const Value*> values = values_at(plan, plan_point(plan, point));
  std::vector<std::pair<std::string, double>> found;
  for (const std::uint32_t slot : input.slots) {
    found.emplace_back(plan.table.rows[slot].name,
                       distributions::quantile(plan.distributions[values[slot]->index], quantile));
  }
  return found;
}

std::vector<double> drawn_quantiles(const Study& study, std::int64_t point, std::int64_t index,
                                    const std::vector<MachineInput>& inputs) {
  const TrialPlace place = place_of(study, point, index);
  const GivenDraws none;
  const TrialDraws draws = draws_of(study, point, place.draw, none);
  std::vector<double> quantiles;
  for (const MachineInput& input : inputs) {
    const std::uint32_t slot = input.slots.front();
    const Value& value = *value_at_point(*study.plan, slot, place.point);
    quantiles.push_back(uniform_of(draws, slot, value.level));
  }
  return quantiles;
}

}  // namespace zerocount::study
