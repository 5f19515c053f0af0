#include <fmt/format.h>

#include "core/failure.hpp"
#include "experiments/designs/latin_hypercube.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/plan/plan.hpp"
#include "experiments/study.hpp"

namespace zerocount {
namespace {

double design_uniform(const Study& study, const SlotRandomness& randomness, std::size_t point,
                      std::uint64_t index) {
  const RandomStream stream{.key = randomness.key,
                            .stream = study.independent_points ? static_cast<std::uint32_t>(point) + 1 : 0};
  switch (study.design) {
    case Design::monte_carlo:
      break;
    case Design::latin_hypercube:
      return latin_uniform(index, static_cast<std::uint64_t>(study.trials), stream);
    case Design::sobol:
      return sobol_uniform(index, randomness.directions, stream);
  }
  return open_uniform(random_bits(stream, index, Draw::trial));
}

void check_exists(const Study& study, std::int64_t point, std::int64_t index) {
  if (point < 0 || point >= point_count(study)) {
    throw Failure(ExitCode::bad_input, fmt::format("study {} has no design point {}; expected 0 to {}",
                                                   study.name, point, point_count(study) - 1));
  }
  if (index < 0 || index >= study.trials) {
    throw Failure(ExitCode::bad_input, fmt::format("study {} has no trial {}; expected 0 to {}", study.name,
                                                   index, study.trials - 1));
  }
}

}  // namespace

StudyTrial study_trial(const Study& study, std::int64_t point, std::int64_t index) {
  check_exists(study, point, index);
  const StudyPlan& plan = *study.plan;
  const auto table = parameter_table();
  const std::vector<const Value*> values = values_at(plan, static_cast<std::size_t>(point));
  std::vector<double> numbers(values.size());

  StudyTrial trial;
  trial.parameters.command.targets.resize(plan.moves);
  const auto set = [&](std::size_t slot, double number) {
    numbers[slot] = number;
    if (slot >= table.size()) {
      const std::size_t move = slot - table.size();
      trial.parameters.command.targets[move] = static_cast<std::int64_t>(number);
    } else if (!table[slot].per_move) {
      table[slot].set(trial.parameters, number);
    }
  };
  for (std::size_t slot = 0; slot < values.size(); ++slot) {
    const Value& value = *values[slot];
    if (value.kind == Value::Kind::number) {
      set(slot, value.number);
    } else if (value.kind == Value::Kind::distribution) {
      const double u = design_uniform(study, plan.randomness[slot], static_cast<std::size_t>(point),
                                      static_cast<std::uint64_t>(index));
      set(slot, quantile(plan.distributions[value.index], u));
    }
  }
  // The profiles last: where the trial starts on them is itself a parameter.
  for (std::size_t slot = 0; slot < table.size(); ++slot) {
    const Value& value = *values[slot];
    if (value.kind != Value::Kind::profile) continue;
    const std::shared_ptr<const Profile>& profile = plan.profiles[value.index];
    set(slot, value_at(*profile, trial.parameters.initial.position));
    trial.parameters.friction.profiled.push_back({table[slot].profiled, profile});
  }
  trial.inputs.reserve(plan.input_slots.size());
  for (const std::uint32_t slot : plan.input_slots) trial.inputs.push_back(numbers[slot]);
  return trial;
}

}  // namespace zerocount
