#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "core/friction/friction_model.hpp"
#include "core/friction/law.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/encoder.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"
#include "runners/tuning/effects/idealisations.hpp"

// The control law and its reference.

namespace zerocount::tuning {
namespace {

using loop::ControlPhase;
using study::PointEdit;

constexpr std::string_view path_of(ControlPhase phase) {
  return phase == ControlPhase::fine ? "controller" : "controller.coarse";
}

constexpr std::array phases{ControlPhase::fine, ControlPhase::coarse};

std::string key_of(ControlPhase phase, std::string_view key) {
  return fmt::format("{}.{}", path_of(phase), key);
}

loop::ControlBlocks& blocks_of(ControlPhase phase, loop::ControllerParameters& controller) {
  return phase == ControlPhase::fine ? controller.blocks : controller.coarse.blocks;
}

bool can_be_positive(const IdealisedPoint& point, std::string_view key) {
  return acts(point, key) && point.at.limits(key).high > 0.0;
}

// Filters. One that is switched off stays in the list, so that the others keep their numbers.

void without_filter(ControlPhase phase, std::size_t number, trial::TrialParameters& p) {
  blocks_of(phase, p.controller).filters[number] = {.kind = loop::FilterKind::biquad};
}

void add_filters(const IdealisedPoint& point, std::vector<Effect>& all) {
  loop::ControllerParameters controller = point.at.plan().common.controller;
  for (const ControlPhase phase : phases) {
    if (!acts(point, key_of(phase, "filters"))) continue;
    for (std::size_t i = 0; i < blocks_of(phase, controller).filters.size(); ++i)
      all.push_back({.name = fmt::format("{} {}.{}", parameters::no_filter, key_of(phase, "filters"), i),
                     .note = not_tuned_again,
                     .change = [phase, i](trial::TrialParameters& p) { without_filter(phase, i, p); }});
  }
}

// The integral, by which an axis with friction hunts. Without another term there would be no control.

bool has_contact(const PointEdit& at) {
  const auto no_friction = static_cast<double>(friction::FrictionModel::none);
  const auto no_load_friction = static_cast<double>(friction::LoadFrictionModel::none);
  return can_differ_from(no_friction, at.limits(parameter::friction::model)) ||
         (at.limits(parameter::plant::load::inertia).high > 0.0 &&
          can_differ_from(no_load_friction, at.limits(parameter::plant::load::friction::model)));
}

bool is_proportional_too(const IdealisedPoint& point) {
  return can_be_positive(point, parameter::controller::kp) ||
         (can_be_positive(point, parameter::controller::cascade::kv) &&
          can_be_positive(point, parameter::controller::cascade::kp));
}

void add_no_integral(const IdealisedPoint& point, std::vector<Effect>& all) {
  std::vector<std::string> gains;
  for (const ControlPhase phase : phases) {
    for (const char* const gain : {"ki", "cascade.ki", "standstill.ki"})
      if (can_be_positive(point, key_of(phase, gain))) gains.push_back(key_of(phase, gain));
  }
  if (gains.empty() || !has_contact(point.at) || !is_proportional_too(point)) return;
  all.push_back(
      {.name = std::string(parameters::no_integral), .note = not_tuned_again, .edit = [gains](PointEdit& at) {
         for (const std::string& gain : gains) at.set(gain, 0.0);
       }});
}

// Feed-forward: the torque that the axis needs to follow a moving reference.

/// Viscous damping of the axis while it slides, N m s/rad, including the damping of a load to ground.
double damping_of(const trial::TrialParameters& p) {
  const friction::LawTraits& law = friction::traits_of(p.friction.model);
  const double of_rotor = law.has_sliding_damping      ? p.plant.sliding_damping
                          : law.has_presliding_damping ? p.plant.presliding_damping
                                                       : 0.0;
  return of_rotor + (motion::has_load(p.plant) ? p.plant.load.damping_to_ground : 0.0);
}

/// Friction torque of the axis while it slides fast (Coulomb level), N m. Includes the friction of a load.
double friction_of(const trial::TrialParameters& p) {
  const auto level = [](const friction::FrictionParameters& contact) {
    return contact.breakaway * contact.coulomb_ratio;
  };
  const friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
  const bool of_load =
      motion::has_load(p.plant) && p.load_side.friction.model != friction::LoadFrictionModel::none;
  return (friction::has_friction(p.friction.model) ? level(contact) : 0.0) +
         (of_load ? level(p.load_side.friction.contact) : 0.0);
}

/// Torque that opposes the velocity, per velocity, N m s/rad: viscous damping of the axis, plus the effect of
/// the derivative gain in a PID law.
double opposing_damping(ControlPhase phase, const trial::TrialParameters& p) {
  const loop::ControllerParameters controller = loop::controller_in_phase(p.controller, phase);
  const bool by_derivative = controller.blocks.structure == loop::ControlStructure::pid;
  const double counts_per_sample = 1.0 / (controller.sample_rate * loop::fine_resolution(p.encoder));
  return damping_of(p) + (by_derivative ? controller.kd * counts_per_sample : 0.0);
}

double inertia_of(const trial::TrialParameters& p) {
  return p.plant.inertia + p.plant.load.inertia;
}

/// One gain of the feed-forward, with the function that computes from a trial's axis the value it should
/// have.
struct FeedforwardTerm {
  std::string_view key;
  std::string_view name;
  double loop::FeedforwardParameters::*gain;
  double (*needed)(ControlPhase, const trial::TrialParameters&);
};

constexpr std::array feedforward_terms{
    FeedforwardTerm{"feedforward.velocity", parameters::damping_feedforward,
                    &loop::FeedforwardParameters::velocity, opposing_damping},
    FeedforwardTerm{"feedforward.acceleration", parameters::inertia_feedforward,
                    &loop::FeedforwardParameters::acceleration,
                    [](ControlPhase, const trial::TrialParameters& p) { return inertia_of(p); }},
    FeedforwardTerm{"feedforward.friction", parameters::friction_feedforward,
                    &loop::FeedforwardParameters::friction,
                    [](ControlPhase, const trial::TrialParameters& p) { return friction_of(p); }},
};

void add_feedforward(const IdealisedPoint& point, std::vector<Effect>& all) {
  for (const ControlPhase phase : phases) {
    for (const FeedforwardTerm& term : feedforward_terms) {
      const std::string key = key_of(phase, term.key);
      const bool needless = term.key == "feedforward.friction" && !has_contact(point.at) &&
                            !can_differ_from(0.0, point.at.limits(key));
      if (needless || !acts(point, key)) continue;
      all.push_back({.name = name_in_phase(term.name, key),
                     .note = not_tuned_again,
                     .change = [phase, term](trial::TrialParameters& p) {
                       blocks_of(phase, p.controller).feedforward.*term.gain = term.needed(phase, p);
                     }});
    }
  }
}

// Profile. Its duration shrinks, its path stays. If the torque range already tames the step, the fastest
// profile need not be the best, so two are tried.

constexpr std::array<int, 2> faster_profiles{2, 8};

void with_faster_profile(PointEdit& at, double ratio) {
  at.scale(parameter::command::profile::velocity_limit, ratio);
  at.scale(parameter::command::profile::acceleration_limit, ratio * ratio);
  at.scale(parameter::command::profile::jerk_limit, ratio * ratio * ratio);
}

void add_faster_profiles(const IdealisedPoint& point, std::vector<Effect>& all) {
  if (!acts(point, parameter::command::profile::velocity_limit)) return;
  for (const int ratio : faster_profiles)
    all.push_back({.name = fmt::format("{} {} times faster", parameters::faster_profile, ratio),
                   .note = not_tuned_again,
                   .edit = [ratio](PointEdit& at) { with_faster_profile(at, ratio); }});
}

}  // namespace

void add_control_effects(const IdealisedPoint& point, std::vector<Effect>& all) {
  add_filters(point, all);
  add_no_integral(point, all);
  add_feedforward(point, all);
  add_faster_profiles(point, all);
}

}  // namespace zerocount::tuning
