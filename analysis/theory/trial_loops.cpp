#include "analysis/theory/trial_loops.hpp"

#include <utility>

#include <fmt/format.h>

#include "core/friction/law.hpp"
#include "core/loop/controller/controller.hpp"

namespace zerocount::theory {

bool has_no_linear_loop(const trial::TrialParameters& parameters) {
  return parameters.controller.user.plugin || !parameters.command.torque.levels.empty();
}

bool is_outside_theory(const trial::TrialParameters& parameters) {
  return has_no_linear_loop(parameters) || !friction::has_spring(parameters.friction.model);
}

std::string why_outside_theory(const trial::TrialParameters& parameters) {
  if (!is_outside_theory(parameters)) return "";
  if (parameters.controller.user.plugin)
    return "the controller is a plugin, whose transfer function is not known";
  if (!parameters.command.torque.levels.empty()) return "the loop is open";
  if (friction::traits_of(parameters.friction.model).has_presliding_motion)
    return "the spring of this friction.model yields by degrees, from its full stiffness to none, not to k1";
  return fmt::format("friction.model {} has no spring, which criteria (6) and (7) are about",
                     friction::traits_of(parameters.friction.model).word);
}

LinearDrive drive_of(const trial::TrialParameters& parameters) {
  return {1.0 + parameters.dac.gain_error, parameters.amplifier.bandwidth};
}

namespace {

friction::LinearContacts linear_contacts(const trial::TrialParameters& p) {
  return friction::traits_of(p.friction.model)
      .linear_contacts(p.plant, p.friction, friction::friction_at(p.friction, p.initial.position));
}

}  // namespace

std::vector<TrialLoop> trial_loops(const trial::TrialParameters& parameters) {
  std::vector<TrialLoop> loops;
  if (has_no_linear_loop(parameters)) return loops;
  const auto add_loop = [&](const friction::LinearContact& contact, const std::string& name,
                            const loop::ControllerParameters& controller) {
    loops.push_back({name, contact.slides, contact.stiffness,
                     frozen_loop(contact.stiffness, contact.damping, parameters.plant, parameters.encoder,
                                 controller, drive_of(parameters))});
  };
  const auto add = [&](const friction::LinearContact& contact, const std::string& name,
                       loop::ControlPhase phase) {
    const loop::ControllerParameters controller = loop::controller_in_phase(parameters.controller, phase);
    add_loop(contact, name, controller);
    const auto at_standstill = loop::controller_at_standstill(controller);
    if (at_standstill && !contact.slides)
      add_loop(contact, name + ", with the gains at standstill", *at_standstill);
  };
  const std::string with_phases = loop::has_coarse_phase(parameters.controller) ? ", the fine phase" : "";
  for (const friction::LinearContact& contact : linear_contacts(parameters)) {
    const std::string name(contact.name);
    add(contact, contact.slides ? name + with_phases : name, loop::ControlPhase::fine);
    if (contact.slides && !with_phases.empty())
      add(contact, name + ", the coarse phase", loop::ControlPhase::coarse);
  }
  return loops;
}

}  // namespace zerocount::theory
