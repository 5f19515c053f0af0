#include "analysis/trials/theory/trial_loops.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "analysis/trials/theory/theory_prediction.hpp"
#include "core/friction/law.hpp"
#include "core/loop/controller/controller.hpp"

namespace zerocount::theory {
namespace {

/// Controller parameters in one phase or state of a trial (fine or coarse phase, at standstill), and their
/// name.
struct NamedControl {
  loop::ControllerParameters controller;
  std::string name;
  loop::ControlPhase phase;
};

std::vector<NamedControl> controls_of(const trial::TrialParameters& p, bool slides) {
  const bool has_phases = loop::has_coarse_phase(p.controller);
  std::vector<NamedControl> controls;
  const auto add = [&](loop::ControlPhase phase, const std::string& name) {
    const loop::ControllerParameters controller = loop::controller_in_phase(p.controller, phase);
    controls.push_back({controller, name, phase});
    const auto at_standstill = loop::controller_at_standstill(controller);
    if (at_standstill && !slides)
      controls.push_back({*at_standstill, name + ", with the gains at standstill", phase});
  };
  add(loop::ControlPhase::fine, slides && has_phases ? ", the fine phase" : "");
  if (slides && has_phases) add(loop::ControlPhase::coarse, ", the coarse phase");
  return controls;
}

}  // namespace

std::pair<double, double> stiffness_range(const trial::TrialParameters& p) {
  constexpr int places_on_profile = 64;
  double softest = std::numeric_limits<double>::infinity();
  double stiffest = 0.0;
  const double period = p.friction.profiled.empty() ? 0.0 : p.friction.profiled.front().profile->period;
  const int places = p.friction.profiled.empty() ? 1 : places_on_profile;
  for (int place = 0; place < places; ++place) {
    const friction::FrictionParameters contact =
        friction::friction_at(p.friction, p.initial.position + period * place / places);
    softest = std::min(softest, contact.k1);
    stiffest = std::max(stiffest, contact.k1 + contact.k2);
  }
  return {softest, stiffest};
}

friction::LinearContacts linear_contacts_of(const trial::TrialParameters& p) {
  friction::LinearContacts contacts =
      friction::traits_of(p.friction.model)
          .linear_contacts(p.plant, p.friction, friction::friction_at(p.friction, p.initial.position));
  const auto shapes_stiffness = [](const friction::ProfiledParameter& entry) {
    return entry.parameter == &friction::FrictionParameters::k1 ||
           entry.parameter == &friction::FrictionParameters::k2;
  };
  if (!friction::has_spring(p.friction.model) || std::ranges::none_of(p.friction.profiled, shapes_stiffness))
    return contacts;
  const auto [softest, stiffest] = stiffness_range(p);
  const double damping = p.plant.presliding_damping;
  const auto sliding = std::ranges::find(contacts, true, &friction::LinearContact::slides);
  contacts.insert(sliding, {{at_softest, softest, damping}, {at_stiffest, stiffest, damping}});
  return contacts;
}

std::vector<LoadState> load_states(const trial::TrialParameters& p) {
  if (!motion::has_load(p.plant)) return {{}};
  const motion::LoadParameters& load = p.plant.load;
  const friction::FrictionParameters& contact = p.load_side.friction.contact;
  std::vector<LoadState> states;
  switch (p.load_side.friction.model) {
    case friction::LoadFrictionModel::none:
      states.emplace_back();
      break;
    case friction::LoadFrictionModel::coulomb:
      states.push_back({.name = ", the load slides"});
      states.push_back({", the load stands", true, {load.stiffness, load.damping}});
      break;
    case friction::LoadFrictionModel::dahl:
    case friction::LoadFrictionModel::lugre: {
      const bool is_damped = p.load_side.friction.model == friction::LoadFrictionModel::lugre;
      states.push_back({.name = ", the load slides"});
      states.push_back(
          {", the load held by its friction",
           false,
           {.load_stiffness = contact.sigma0, .load_damping = is_damped ? contact.sigma1 : 0.0}});
      break;
    }
  }
  if (load.gap > 0.0) states.push_back({.name = ", the motor alone in the gap", .motor_alone = true});
  return states;
}

std::optional<FrozenLoop> loop_in_state(const friction::LinearContact& contact, const LoadState& state,
                                        const trial::TrialParameters& p,
                                        const loop::ControllerParameters& controller) {
  FrozenFriction friction = state.friction;
  friction.stiffness += contact.stiffness;
  friction.damping += contact.damping;
  if (state.motor_alone) return loop_of_motor_alone(friction, p.plant, p.encoder, controller, drive_of(p));
  return frozen_loop(friction, p.plant, p.encoder, controller, drive_of(p));
}

std::vector<TrialLoop> loops_about(const friction::LinearContacts& contacts,
                                   const trial::TrialParameters& p) {
  std::vector<TrialLoop> loops;
  if (has_no_linear_loop(p)) return loops;
  const std::vector<LoadState> states = load_states(p);
  for (std::size_t state = 0; state < states.size(); ++state) {
    for (const friction::LinearContact& contact : contacts) {
      for (const NamedControl& control : controls_of(p, contact.slides)) {
        std::optional<FrozenLoop> loop = loop_in_state(contact, states[state], p, control.controller);
        if (!loop) continue;
        loops.push_back({std::string(contact.name) + control.name + states[state].name, contact.slides,
                         contact.stiffness, *std::move(loop), control.phase, state});
      }
    }
  }
  return loops;
}

std::vector<TrialLoop> trial_loops(const trial::TrialParameters& p) {
  return loops_about(linear_contacts_of(p), p);
}

std::vector<std::string> states_without_loop(const trial::TrialParameters& p) {
  std::vector<std::string> names;
  if (has_no_linear_loop(p)) return names;
  for (const LoadState& state : load_states(p)) {
    constexpr std::size_t comma = 2;
    if (!loop_in_state({"", 0.0, 0.0}, state, p, p.controller)) names.push_back(state.name.substr(comma));
  }
  return names;
}

}  // namespace zerocount::theory
