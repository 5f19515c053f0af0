#include "runners/tuning/worst_machine.hpp"

#include <algorithm>

namespace zerocount::tuning {
namespace {

/// Number of the move with the largest value.
std::int64_t latest_move(const UnitResult& unit) {
  return std::ranges::max_element(unit.values) - unit.values.begin();
}

double latest(const UnitResult& unit) {
  return unit.values.empty() ? 0.0 : *std::ranges::max_element(unit.values);
}

}  // namespace

WorstMachine worst_machine(const study::Study& study, std::int64_t point,
                           std::span<const UnitResult> results) {
  const auto worst = std::ranges::min_element(results, [](const UnitResult& a, const UnitResult& b) {
    return met_proportion(a) != met_proportion(b) ? met_proportion(a) < met_proportion(b)
                                                  : latest(a) > latest(b);
  });
  WorstMachine machine{worst - results.begin(), 0, met_proportion(*worst), {}};
  const auto machines = std::ssize(results);
  machine.trial = machine.rig + latest_move(*worst) / study.moves * machines;
  const bool of_rig =
      study.rigs > 0 && (!study.rig_columns.empty() || (study.worlds > 0 && !study.world_columns.empty()));
  const std::vector<study::InputColumn>& columns = of_rig ? study.rig_columns : study.input_columns;
  const std::vector<double> inputs =
      of_rig ? study::rig_inputs(study, machine.rig) : study::study_trial(study, point, machine.rig).inputs;
  for (std::size_t i = 0; i < inputs.size(); ++i) machine.inputs.emplace_back(columns[i].name, inputs[i]);
  if (of_rig && study.worlds > 0) {
    const std::vector<double> of_world = study::world_inputs(study, study::world_of(study, machine.rig));
    for (std::size_t i = 0; i < of_world.size(); ++i)
      machine.inputs.emplace_back(study.world_columns[i].name, of_world[i]);
  }
  return machine;
}

}  // namespace zerocount::tuning
