#include <algorithm>
#include <cmath>

#include "analysis/record/experiment_design/expected_widths.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::experiment_design {
namespace {

Machine machine_of(const study::Study& study, study::StudyTrial trial) {
  Machine machine{study.units.axis, std::move(trial.parameters), {}};
  trial::TrialParameters& parameters = machine.parameters;
  const trial::InitialConditions& initial = parameters.initial;
  trial::InitialConditions virgin;
  virgin.encoder_phase = initial.encoder_phase;
  virgin.position = initial.position;
  virgin.holding = initial.holding;
  parameters.initial = virgin;
  parameters.verdict = {};
  machine.contact = {parameters.plant, friction::friction_at(parameters.friction, initial.position)};
  return machine;
}

}  // namespace

Machine median_machine(const study::Study& study, std::int64_t point) {
  study::GivenDraws medians;
  for (const study::MachineInput& input : study::machine_inputs(study, point)) {
    for (const std::uint32_t slot : input.slots) medians.uniforms[slot] = 0.5;
  }
  return machine_of(study, study::study_trial(study, point, 0, medians));
}

std::vector<Machine> drawn_machines(const study::Study& study, std::int64_t point, std::int64_t count) {
  count = std::min(count, study.machines > 0 ? study.machines : study.trials);
  std::vector<Machine> machines;
  for (std::int64_t index = 0; index < count; ++index)
    machines.push_back(machine_of(study, study::study_trial(study, point, index)));
  return machines;
}

SimulatedRecord simulate(const Machine& machine, const TorqueProtocol& protocol) {
  trial::TrialParameters parameters = machine.parameters;
  // One level for each sample, reached at once and held for one sample.
  parameters.command = {};
  parameters.command.torque.levels = protocol.torque;
  parameters.command.torque.rate = 1e300;
  parameters.command.hold = protocol.sample_time;
  SimulatedRecord record;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& sample) {
    record.counts.push_back(sample.count);
    record.angle.push_back(sample.theta);
    record.travel = std::max(record.travel, std::abs(sample.theta));
    record.slid = record.slid || sample.mode == trial::HookMode::slide;
  };
  const trial::TrialOutcome outcome = trial::run_trial(parameters, observers);
  record.slid = record.slid || record.counts.size() < protocol.torque.size() ||
                std::any_of(outcome.moves.begin(), outcome.moves.end(),
                            [](const trial::MoveOutcome& move) { return move.broke_away; });
  return record;
}

}  // namespace zerocount::experiment_design
