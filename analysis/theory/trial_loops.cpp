#include "analysis/theory/trial_loops.hpp"

#include <utility>

#include "core/loop/controller.hpp"

namespace zerocount::theory {

bool has_no_linear_loop(const trial::TrialParameters& parameters) {
  return parameters.controller.user.plugin || !parameters.command.torque.levels.empty();
}

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

LinearDrive drive_of(const trial::TrialParameters& parameters) {
  return {1.0 + parameters.dac.gain_error, parameters.amplifier.bandwidth};
}

namespace {

/// A contact that does not change: a spring and a damper, or the damper alone.
struct FrozenContact {
  const char* name;
  double stiffness;  ///< N m/rad
  double damping;    ///< N m s/rad
  bool slides{false};
};

double stiffness_of(const std::vector<friction::GmsElement>& elements) {
  double sum = 0.0;
  for (const friction::GmsElement& element : elements) sum += element.stiffness;
  return sum;
}

std::vector<FrozenContact> frozen_contacts(const trial::TrialParameters& p) {
  const friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
  const double c = p.plant.presliding_damping;
  const double cs = p.plant.sliding_damping;
  const FrozenContact sliding{"while sliding", 0.0, cs, true};
  switch (p.friction.model) {
    case friction::FrictionModel::presliding:
    case friction::FrictionModel::spring:
      return {{"at k1", contact.k1, c}, {"at k1 + k2", contact.k1 + contact.k2, c}, sliding};
    case friction::FrictionModel::dahl:
      return {{"at sigma0", contact.sigma0, c}, {"while sliding", 0.0, c, true}};
    case friction::FrictionModel::lugre:
      return {{"at sigma0", contact.sigma0, contact.sigma1 + cs}, sliding};
    case friction::FrictionModel::gms:
      return {{"while all elements stick", stiffness_of(friction::gms_elements_of(p.friction)), cs}, sliding};
    case friction::FrictionModel::coulomb:
      return {sliding};
    case friction::FrictionModel::none:
      break;
  }
  return {{"without friction", 0.0, c, true}};
}

}  // namespace

std::vector<TrialLoop> trial_loops(const trial::TrialParameters& parameters) {
  std::vector<TrialLoop> loops;
  if (has_no_linear_loop(parameters)) return loops;
  const auto add_loop = [&](const FrozenContact& contact, const std::string& name,
                            const loop::ControllerParameters& controller) {
    loops.push_back({name, contact.slides, contact.stiffness,
                     frozen_loop(contact.stiffness, contact.damping, parameters.plant, parameters.encoder,
                                 controller, drive_of(parameters))});
  };
  const auto add = [&](const FrozenContact& contact, const std::string& name, loop::ControlPhase phase) {
    const loop::ControllerParameters controller = loop::controller_in_phase(parameters.controller, phase);
    add_loop(contact, name, controller);
    const auto at_standstill = loop::controller_at_standstill(controller);
    if (at_standstill && !contact.slides)
      add_loop(contact, name + ", with the gains at standstill", *at_standstill);
  };
  const std::string with_phases = loop::has_coarse_phase(parameters.controller) ? ", the fine phase" : "";
  for (const FrozenContact& contact : frozen_contacts(parameters)) {
    add(contact, contact.slides ? contact.name + with_phases : contact.name, loop::ControlPhase::fine);
    if (contact.slides && !with_phases.empty())
      add(contact, std::string(contact.name) + ", the coarse phase", loop::ControlPhase::coarse);
  }
  return loops;
}

}  // namespace zerocount::theory
