#include "runners/tuning/worst_machines/machine_of_study.hpp"

#include <algorithm>

#include "analysis/measures/goal_counts.hpp"
#include "experiments/study/condition_study.hpp"
#include "experiments/study/plan.hpp"
#include "runners/tuning/worst_machines/machine_failures.hpp"

namespace zerocount::tuning {
namespace {

/// Values of what differs between the machines of the study, by their names.
std::vector<std::pair<std::string, double>> inputs_of_machine(const study::Study& study, std::int64_t point,
                                                              const WorstMachine& machine) {
  std::vector<std::pair<std::string, double>> named;
  const bool of_rig =
      study.rigs > 0 && (!study.columns.rigs.empty() || (study.worlds > 0 && !study.columns.worlds.empty()));
  const bool has_conditions = !study.conditions.empty();  // what they override is an input of trials
  const std::vector<study::InputColumn>& columns =
      of_rig && !has_conditions ? study.columns.rigs : study.columns.inputs;
  const std::vector<double> inputs = of_rig && !has_conditions
                                         ? study::rig_inputs(study, machine.rig)
                                         : study::study_trial(study, point, machine.trial).inputs;
  const auto is_of_machine = [&](const study::InputColumn& column) {
    return !of_rig || !has_conditions || column.level < study::DrawLevel::trial;
  };
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (is_of_machine(columns[i])) named.emplace_back(columns[i].name, inputs[i]);
  }
  if (of_rig && !has_conditions && study.worlds > 0) {
    const std::vector<double> of_world = study::world_inputs(study, study::world_of(study, machine.rig));
    for (std::size_t i = 0; i < of_world.size(); ++i)
      named.emplace_back(study.columns.worlds[i].name, of_world[i]);
  }
  return named;
}

}  // namespace

WorstMachine worst_machine(const study::Study& study, std::int64_t point,
                           std::span<const UnitResult> results) {
  const auto worst = std::ranges::min_element(results, [](const UnitResult& a, const UnitResult& b) {
    const ClaimResult& of_a = a.claims[worst_claim(a)];
    const ClaimResult& of_b = b.claims[worst_claim(b)];
    return met_proportion(of_a) != met_proportion(of_b) ? met_proportion(of_a) < met_proportion(of_b)
                                                        : latest(of_a) > latest(of_b);
  });
  const std::size_t claim = worst_claim(*worst);
  const ClaimResult& result = worst->claims[claim];
  WorstMachine machine{worst - results.begin(), 0, met_proportion(result), {}, place_of_claim(study, claim)};
  const std::int64_t asked =
      measures::asked_moves(measures::asked_of_moves(study)[machine.claim.goal], study.moves);
  const std::int64_t trial_under_condition =
      (std::ranges::max_element(result.values) - result.values.begin()) / asked;
  machine.trial = trials::trial_of_replicate(study, {.count = std::ssize(results)}, machine.rig,
                                             trial_under_condition * study::condition_count(study) +
                                                 static_cast<std::int64_t>(machine.claim.condition));
  machine.inputs = inputs_of_machine(study, point, machine);
  name_claim(study, machine);
  return machine;
}

void name_claim(const study::Study& study, WorstMachine& machine) {
  if (has_named_claims(study)) machine.goal = goal_name(study, machine.claim);
  machine.condition = condition_name(study, machine.claim);
}

}  // namespace zerocount::tuning
