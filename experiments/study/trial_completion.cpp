#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

#include "core/loop/encoder.hpp"
#include "core/theory/gains.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/trial_draws.hpp"

namespace zerocount::study {
namespace {

/// Converts the gains of a phase of the control from SI units to units per count and sample.
/// @tparam Phase ControllerParameters or CoarsePhaseParameters; both have kp, ki and kd
template <class Phase>
void convert_gains(Phase& phase, const trial::TrialParameters& trial) {
  const loop::PidGains gains =
      theory::sampled_gains({phase.kp, phase.ki, phase.kd}, trial.controller, trial.encoder);
  phase.kp = gains.kp;
  phase.ki = gains.ki;
  phase.kd = gains.kd;
}

/// Gives each loop the encoder of its mass. Of two encoders, the one that closes the (position) loop becomes
/// the fine one.
void choose_encoders(trial::TrialParameters& trial) {
  motion::EncoderPlace& closing = trial.plant.load.encoder;
  motion::EncoderPlace of_velocity = closing;
  if (trial.controller.blocks.structure == loop::ControlStructure::cascade) {
    const auto place = [of_plant = closing](loop::LoopEncoder choice) {
      switch (choice) {
        case loop::LoopEncoder::motor:
          return motion::EncoderPlace::motor;
        case loop::LoopEncoder::load:
          return motion::EncoderPlace::load;
        case loop::LoopEncoder::of_the_plant:
          break;
      }
      return of_plant;
    };
    const loop::CascadeParameters& cascade = trial.controller.blocks.cascade;
    closing = place(cascade.position);
    of_velocity = place(cascade.velocity);
  }
  loop::EncoderParameters& encoder = trial.encoder;
  if (!motion::has_load(trial.plant)) encoder.other.counts = 0.0;
  if (!loop::has_other(encoder)) return;
  trial.controller.velocity_by_other = of_velocity != closing;
  if (closing == motion::EncoderPlace::load) trial::exchange_encoders(trial);
  // None is coarse: it reads as the fine one would without errors.
  encoder.coarse = encoder.fine;
  encoder.coarse_length = encoder.fine_length;
}

// Target of a move in the manifest's unit.
double listed_target(const Study& study, const std::vector<double>& numbers, std::size_t move) {
  static const std::size_t overrun =
      parameters::find_parameter(parameter::command::sequence::overrun).value();
  const std::span<const double> targets = std::span(numbers).subspan(study.plan->list.first);
  if (!study.plan->sequence) return targets[move];
  return sequence_position(study.sequence[move], targets, numbers[overrun]);
}

}  // namespace

void complete_trial(const parameters::StudyUnits& units, trial::TrialParameters& trial) {
  switch (units.axis) {
    case parameters::AxisKind::rotary:
      trial.encoder.other.length = 2.0 * std::numbers::pi;
      break;
    case parameters::AxisKind::linear: {
      loop::EncoderParameters& encoder = trial.encoder;
      encoder.fine = encoder.coarse = 1.0;
      encoder.other.counts = encoder.other.length > 0.0 ? 1.0 : 0.0;
      if (encoder.coarse_length == 0.0) encoder.coarse_length = encoder.fine_length;
      break;
    }
  }
  choose_encoders(trial);
  switch (units.gains) {
    case parameters::GainUnits::count:
      break;
    case parameters::GainUnits::si:
      convert_gains(trial.controller, trial);
      convert_gains(trial.controller.coarse, trial);
      convert_gains(trial.controller.blocks.standstill, trial);
      convert_gains(trial.controller.coarse.blocks.standstill, trial);
      break;
  }
}

void set_targets(const Study& study, const std::vector<double>& numbers, StudyTrial& trial) {
  std::vector<std::int64_t>& targets = trial.parameters.command.targets;
  const bool si = study.units.targets == parameters::TargetUnits::si;
  if (!si && !study.plan->sequence) return;
  for (std::size_t move = 0; move < targets.size(); ++move) {
    const double target = listed_target(study, numbers, move);
    if (si) {
      trial.target_positions.push_back(target);
    } else {
      targets[move] = static_cast<std::int64_t>(target);
    }
  }
}

void complete_targets(StudyTrial& trial) {
  const double count = loop::fine_resolution(trial.parameters.encoder);
  for (std::size_t move = 0; move < trial.target_positions.size(); ++move)
    trial.parameters.command.targets[move] = std::llrint(trial.target_positions[move] / count);
  if (trial.parameters.verdict.position_error)
    trial.parameters.command.exact_targets = trial.target_positions;
}

}  // namespace zerocount::study
