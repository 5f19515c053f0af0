#include "analysis/theory/hunting_prediction.hpp"

#include <algorithm>

#include "analysis/theory/trial_loops.hpp"
#include "core/friction/law.hpp"
#include "core/loop/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/describing_function.hpp"
#include "core/theory/frozen_loop.hpp"

namespace zerocount::theory {
namespace {

/// In the fine phase, which comes first of the loops that slide.
bool is_stable_while_sliding(const trial::TrialParameters& trial) {
  const std::vector<TrialLoop> loops = trial_loops(trial);
  const auto sliding = std::ranges::find_if(loops, &TrialLoop::slides);
  return sliding != loops.end() && stability_of(sliding->loop, longest_hold(trial)) == LoopStability::stable;
}

bool is_disturbed(const trial::TrialParameters& trial) {
  const trial::DisturbanceParameters& d = trial.disturbance;
  return d.torque != 0.0 || !d.ripple.empty() || !d.vibration.empty() || !d.spectra.empty();
}

}  // namespace

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
  prediction.grows_while_sliding = !is_stable_while_sliding(trial);
  prediction.by_function =
      harmonic_balance(model, contact, trial.plant, trial.encoder, controller, drive_of(trial));
  prediction.sticks = friction::is_relay(friction::traits_of(model));
  if (!prediction.sticks) return prediction;
  if (const auto cycle = stick_slip_cycle(contact, trial.plant, trial.encoder, controller))
    prediction.by_stick_slip.push_back(*cycle);
  return prediction;
}

}  // namespace zerocount::theory
