#include "core/friction/friction_model.hpp"
#include "core/trial/machine.hpp"
#include "experiments/parameters/element_lists.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"
#include "runners/tuning/effects/idealisations.hpp"

// A second mass whose coupling is rigid: one mass with the inertia, the damping, the friction and the
// disturbances of both. One mass has one friction, and neither a gap nor a kinematic error. An axis that has
// these, or friction on both masses, gets a stiffer coupling and stays what it is otherwise.

namespace zerocount::tuning {
namespace {

using friction::FrictionModel;
using friction::LoadFrictionModel;

constexpr double stiffness_ratio = 100.0;  // ten times the natural frequency

bool has_kinematic_error(const study::PointEdit& at) {
  bool found = false;
  visit_values(at, [&](std::size_t, const parameters::Parameter& row) {
    found = found || (parameters::without_indices(row.name) == parameter::plant::load::error::amplitude &&
                      can_differ_from(0.0, at.limits(row.name)));
  });
  return found;
}

bool fits_one_mass(const study::PointEdit& at) {
  const bool has_two_frictions =
      can_differ_from(static_cast<double>(FrictionModel::none), at.limits(parameter::friction::model)) &&
      can_differ_from(static_cast<double>(LoadFrictionModel::none),
                      at.limits(parameter::plant::load::friction::model));
  return !has_two_frictions && !can_differ_from(0.0, at.limits(parameter::plant::load::gap)) &&
         !has_kinematic_error(at);
}

FrictionModel same_law(LoadFrictionModel model) {
  switch (model) {
    case LoadFrictionModel::none:
      break;
    case LoadFrictionModel::coulomb:
      return FrictionModel::coulomb;
    case LoadFrictionModel::dahl:
      return FrictionModel::dahl;
    case LoadFrictionModel::lugre:
      return FrictionModel::lugre;
  }
  return FrictionModel::none;
}

/// Adds to the controller's initial integral the torque that must be held at the start and that the friction
/// contact does not carry.
void keep_start(trial::TrialParameters& p) {
  const trial::HeldStart held = trial::held_start(p);
  p.initial.integral += held.integral;
  p.initial.holding = held.contact != 0.0;
}

/// Replaces the friction of the one mass of the rigid axis by that of the load, if the load has friction. The
/// friction starts virgin and unloaded, as on the load.
void take_over_friction(trial::TrialParameters& p) {
  if (p.load_side.friction.model == LoadFrictionModel::none) return;
  p.friction = {
      .uniform = p.load_side.friction.contact, .profiled = {}, .model = same_law(p.load_side.friction.model)};
  p.plant.sliding_damping = p.plant.presliding_damping;
  p.initial.hardening = p.initial.preload = 0.0;
  p.initial.history = {};
  p.initial.mode = trial::InitialMode::stick;
}

/// Moves the disturbance torques of the load to the one mass of the rigid axis. If the study starts in
/// equilibrium (initial.holding), the integral of the controller starts with the constant torque that the
/// friction contact does not carry.
void take_over_disturbances(trial::TrialParameters& p) {
  const trial::HeldStart held = trial::held_start(p);
  const trial::DisturbanceParameters& of_load = p.load_side.disturbance;
  p.disturbance.torque += of_load.torque;
  if (p.initial.holding) p.initial.integral += p.disturbance.torque - held.contact;
  const auto append = [](auto& to, const auto& more) { to.insert(to.end(), more.begin(), more.end()); };
  append(p.disturbance.ripple, of_load.ripple);
  append(p.disturbance.vibration, of_load.vibration);
  append(p.disturbance.spectra, of_load.spectra);
}

void with_a_rigid_load(trial::TrialParameters& p) {
  if (!motion::has_load(p.plant)) return;
  keep_start(p);
  take_over_friction(p);
  take_over_disturbances(p);
  p.plant.inertia += p.plant.load.inertia;
  p.plant.presliding_damping += p.plant.load.damping_to_ground;
  p.plant.sliding_damping += p.plant.load.damping_to_ground;
  p.plant.load = {};
  p.load_side = {};
}

}  // namespace

void add_rigid_axis(const IdealisedPoint& point, std::vector<Effect>& all) {
  if (!can_differ_from(0.0, point.at.limits(parameter::plant::load::inertia))) return;
  if (fits_one_mass(point.at)) {
    all.push_back(
        {.name = std::string(parameters::rigid_axis), .note = not_tuned_again, .change = with_a_rigid_load});
  } else {
    all.push_back(
        {.name = std::string(parameters::stiffer_coupling),
         .note = not_tuned_again,
         .edit = [](study::PointEdit& at) { at.scale(parameter::plant::load::stiffness, stiffness_ratio); }});
  }
}

}  // namespace zerocount::tuning
