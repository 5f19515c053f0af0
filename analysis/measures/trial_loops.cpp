#include "analysis/measures/trial_loops.hpp"

#include <utility>

#include "core/loop/controller.hpp"

namespace zerocount::measures {

std::string_view why_outside_theory(const trial::TrialParameters& parameters) {
  if (parameters.controller.user.plugin)
    return "the controller is a plugin, whose transfer function is not known";
  if (!parameters.command.torque.levels.empty()) return "the loop is open";
  switch (parameters.friction.model) {
    case friction::FrictionModel::presliding:
    case friction::FrictionModel::spring:
      return {};
    case friction::FrictionModel::coulomb:
      return "friction.model coulomb has no spring before it slides";
    case friction::FrictionModel::none:
      return "friction.model none has no spring, which criteria (6) and (7) are about";
    case friction::FrictionModel::dahl:
    case friction::FrictionModel::lugre:
    case friction::FrictionModel::gms:
      break;
  }
  return "the spring of this friction.model yields by degrees, from its full stiffness to none, not to k1";
}

theory::LinearDrive drive_of(const trial::TrialParameters& parameters) {
  return {1.0 + parameters.dac.gain_error, parameters.amplifier.bandwidth};
}

std::vector<TrialLoop> trial_loops(const trial::TrialParameters& parameters) {
  std::vector<TrialLoop> loops;
  if (!why_outside_theory(parameters).empty()) return loops;
  const motion::PlantParameters& plant = parameters.plant;
  const friction::FrictionParameters contact =
      friction::friction_at(parameters.friction, parameters.initial.position);
  const auto frozen = [&](double stiffness, double damping, loop::ControlPhase phase) {
    return theory::frozen_loop(stiffness, damping, plant, parameters.encoder,
                               loop::controller_in_phase(parameters.controller, phase), drive_of(parameters));
  };
  const auto add_spring = [&](const char* name, double stiffness) {
    loops.push_back({name, false, frozen(stiffness, plant.presliding_damping, loop::ControlPhase::fine)});
  };
  const auto add_sliding = [&](const char* name, loop::ControlPhase phase) {
    loops.push_back({name, true, frozen(0.0, plant.sliding_damping, phase)});
  };
  add_spring("at k1", contact.k1);
  add_spring("at k1 + k2", contact.k1 + contact.k2);
  if (loop::has_coarse_phase(parameters.controller)) {
    add_sliding("while sliding, the fine phase", loop::ControlPhase::fine);
    add_sliding("while sliding, the coarse phase", loop::ControlPhase::coarse);
  } else {
    add_sliding("while sliding, the loop", loop::ControlPhase::fine);
  }
  return loops;
}

}  // namespace zerocount::measures
