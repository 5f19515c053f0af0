#include "analysis/theory/hunting_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "analysis/theory/trial_loops.hpp"
#include "core/friction/law.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/describing_function.hpp"
#include "core/theory/frozen_loop.hpp"

namespace zerocount::theory {
namespace {

/// In the fine phase, which comes first of the loops that slide.
bool is_stable_while_sliding(const trial::TrialParameters& trial) {
  const std::vector<TrialLoop> loops = trial_loops(trial);
  const auto sliding = std::ranges::find_if(loops, &TrialLoop::slides);
  return sliding != loops.end() && stability_of(sliding->loop, trial.command.hold) == LoopStability::stable;
}

bool is_disturbed(const trial::TrialParameters& trial) {
  const trial::DisturbanceParameters& d = trial.disturbance;
  return d.torque != 0.0 || !d.ripple.empty() || !d.vibration.empty() || !d.spectra.empty();
}

/// Stiffness of the contact before it slides, N m/rad; 0 for a relay.
double stiffest_stiffness(const trial::TrialParameters& trial, const friction::FrictionParameters& contact) {
  const friction::LawTraits& law = friction::traits_of(trial.friction.model);
  return friction::stiffest_of(law.linear_contacts(trial.plant, trial.friction, contact)).stiffness;
}

/// Counts.
double first_step(const trial::TrialParameters& trial) {
  const std::vector<std::int64_t>& targets = trial.command.targets;
  const auto moved = std::ranges::find_if(targets, [](std::int64_t target) { return target != 0; });
  return moved == targets.end() ? 0.0 : std::abs(static_cast<double>(*moved));
}

}  // namespace

Roughness roughness_of(const LimitCycle& cycle, const HuntingPrediction& hunting) {
  constexpr double counts = 10.0;
  constexpr double samples = 10.0;
  if (cycle.amplitude < counts * hunting.count_angle) return Roughness::few_counts;
  if (cycle.period < samples * hunting.sample_time) return Roughness::few_samples;
  return hunting.range > 0.0 && cycle.amplitude > hunting.range ? Roughness::bristle : Roughness::none;
}

std::optional<HuntingPrediction> predict_hunting(const trial::TrialParameters& trial) {
  const friction::FrictionModel model = trial.friction.model;
  if (has_no_linear_loop(trial) || !has_describing_function(model)) return std::nullopt;
  const loop::ControllerParameters controller =
      loop::controller_in_phase(trial.controller, loop::ControlPhase::fine);
  HuntingPrediction prediction;
  prediction.left_out = left_out_of_hunting(trial.plant, controller);
  if (prediction.left_out.empty() && is_disturbed(trial)) prediction.left_out = "the disturbance";
  if (!prediction.left_out.empty()) return prediction;
  const friction::FrictionParameters contact = friction::friction_at(trial.friction, trial.initial.position);
  prediction.count_angle = loop::fine_resolution(trial.encoder);
  prediction.sample_time = 1.0 / trial.controller.sample_rate;
  prediction.grows_while_sliding = !is_stable_while_sliding(trial);
  prediction.by_function =
      harmonic_balance(model, contact, trial.plant, trial.encoder, controller, drive_of(trial));
  const double stiffness = stiffest_stiffness(trial, contact);
  prediction.range = stiffness > 0.0 ? contact.breakaway / stiffness : 0.0;
  const double step = first_step(trial);
  prediction.sticks = step * prediction.count_angle > prediction.range;
  if (!prediction.sticks) return prediction;
  for (const LimitCycle& cycle :
       stick_slip_cycle(model, contact, trial.plant, trial.encoder, controller, drive_of(trial), step)) {
    if (cycle.amplitude > prediction.range) prediction.by_stick_slip.push_back(cycle);
  }
  return prediction;
}

}  // namespace zerocount::theory
