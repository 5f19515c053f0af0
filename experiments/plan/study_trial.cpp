#include <span>

#include <fmt/format.h>

#include "core/failure.hpp"
#include "experiments/designs/latin_hypercube.hpp"
#include "experiments/designs/saltelli.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/plan/plan.hpp"
#include "experiments/plan/trial_completion.hpp"
#include "experiments/study.hpp"

namespace zerocount {
namespace {

double design_uniform(const Study& study, std::uint32_t slot, std::uint32_t stream_word,
                      std::uint64_t index) {
  const StudyPlan& plan = *study.plan;
  const SlotRandomness& randomness = plan.randomness[slot];
  const RandomStream stream{.key = randomness.key, .stream = stream_word};
  switch (study.design) {
    case Design::monte_carlo:
      break;
    case Design::latin_hypercube:
      return latin_uniform(index, static_cast<std::uint64_t>(study.trials), stream);
    case Design::sobol:
      return sobol_uniform(index, randomness.directions, stream);
    case Design::saltelli:
      index = saltelli_source(index, plan.factor_of[slot], factor_count(plan.factors));
      break;
  }
  return open_uniform(random_bits(stream, index, Draw::trial));
}

// Which trial's the numbers are that it draws while it runs.
std::uint64_t numbers_within_trial(const Study& study, std::uint64_t index) {
  if (study.design != Design::saltelli) return index;
  const TrialFactors& factors = study.plan->factors;
  return saltelli_source(index, factors.slots.size(), factor_count(factors));
}

void set_sequence_targets(const Study& study, const std::vector<double>& numbers, StudyTrial& trial) {
  static const std::size_t overrun = find_parameter("command.sequence.overrun").value();
  const std::span<const double> targets = std::span(numbers).subspan(parameter_table().size());
  for (std::size_t move = 0; move < study.sequence.size(); ++move) {
    trial.parameters.command.targets[move] =
        static_cast<std::int64_t>(sequence_position(study.sequence[move], targets, numbers[overrun]));
  }
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

StudyTrial study_trial_as_given(const Study& study, std::int64_t point, std::int64_t index) {
  check_exists(study, point, index);
  const StudyPlan& plan = *study.plan;
  const std::uint32_t stream = study.independent_points ? static_cast<std::uint32_t>(point) + 1 : 0;
  const std::vector<const Value*> values = values_at(plan, static_cast<std::size_t>(point));
  std::vector<double> numbers = plan.numbers;

  StudyTrial trial{.parameters = plan.common, .inputs = {}};
  trial.parameters.randomness.trial = numbers_within_trial(study, static_cast<std::uint64_t>(index));
  trial.parameters.randomness.stream = stream;
  const auto set = [&](std::size_t slot, double number) {
    numbers[slot] = number;
    set_number(plan, slot, number, trial.parameters);
  };
  for (const std::uint32_t slot : plan.input_slots) {
    const Value& value = *values[slot];
    if (value.kind == Value::Kind::number) {
      set(slot, value.number);
    } else if (value.kind == Value::Kind::distribution) {
      const double u = design_uniform(study, slot, stream, static_cast<std::uint64_t>(index));
      set(slot, quantile(plan.distributions[value.index], u));
    }
  }
  // The profiles last: where the trial starts on them is itself a parameter.
  for (const std::uint32_t slot : plan.input_slots) {
    const Value& value = *values[slot];
    if (value.kind != Value::Kind::profile) continue;
    const std::shared_ptr<const Profile>& profile = plan.profiles[value.index];
    set(slot, value_at(*profile, trial.parameters.initial.position));
    trial.parameters.friction.profiled.push_back({parameter_table()[slot].profiled, profile});
  }
  if (plan.sequence) set_sequence_targets(study, numbers, trial);
  trial.inputs.reserve(plan.input_slots.size());
  for (const std::uint32_t slot : plan.input_slots) trial.inputs.push_back(numbers[slot]);
  return trial;
}

StudyTrial study_trial(const Study& study, std::int64_t point, std::int64_t index) {
  StudyTrial trial = study_trial_as_given(study, point, index);
  complete_trial(study.units, trial.parameters);
  return trial;
}

}  // namespace zerocount
