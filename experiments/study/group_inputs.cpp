#include "experiments/study/group_inputs.hpp"

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
    const std::size_t place = plan_point(plan, 0, source.condition.value_or(0));
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

}  // namespace zerocount::study
