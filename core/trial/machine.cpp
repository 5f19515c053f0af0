#include "core/trial/machine.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/numerics/roots.hpp"
#include "core/trial/open_loop.hpp"

namespace zerocount::trial {
namespace {

/// Truncation error of the motion allowed per torque step, in fine counts. It is far below the required
/// accuracy, because a trial that breaks away in every cycle of its oscillation amplifies an error from cycle
/// to cycle.
constexpr double motion_tolerance_in_counts = 1e-11;

/// Amplitude of an oscillation below which the rotor counts as at rest, in fine counts: a hundredth of the
/// required accuracy.
constexpr double rest_in_counts = 1e-8;

/// State of a load at rest: the twist δ (rad) at which the coupling carries the torque on the load, and that
/// torque τL (N m).
struct HeldLoad {
  double twist;
  double torque;
};

HeldLoad held_load(const TrialParameters& p, std::span<const motion::Ripple> error) {
  const motion::LoadParameters& load = p.plant.load;
  const DisturbanceParameters& disturbance = p.load_side.disturbance;
  const std::vector<motion::Ripple> ripples = ripples_of(disturbance.ripple, p.initial.position);
  const auto torque_at = [&](double twist) {
    return disturbance.torque + motion::value(ripples, motion::value(error, 0.0) - twist);
  };
  // kL·h(δ) + τL, which has both signs between the ends of the search.
  const auto unbalance = [&](double twist) {
    const double stretch = std::max(std::abs(twist) - 0.5 * load.gap, 0.0);
    return load.stiffness * std::copysign(stretch, twist) + torque_at(twist);
  };
  if (unbalance(0.0) == 0.0) return {0.0, 0.0};
  double most = std::abs(disturbance.torque);
  for (const motion::Ripple& ripple : ripples) most += std::abs(ripple.amplitude);
  const double end = 0.5 * load.gap + 1.01 * most / load.stiffness;
  const auto [below, above] = numerics::bisect(
      {-end, end}, [&](double twist) { return unbalance(twist) < 0.0; }, numerics::within(0.0));
  const double twist = std::abs(unbalance(below)) < std::abs(unbalance(above)) ? below : above;
  return {twist, torque_at(twist)};
}

/// Largest torque that the friction contact of the trial holds at rest, N m.
double holding_limit(const TrialParameters& p) {
  const friction::FrictionParameters contact = friction::friction_at(p.friction, p.initial.position);
  return friction::holding_limit(p.friction.model, contact.breakaway, contact.coulomb_ratio);
}

}  // namespace

HeldStart held_start(const TrialParameters& p) {
  if (!p.initial.holding) return {0.0, p.initial.gap * p.plant.load.gap, 0.0};
  if (!motion::has_load(p.plant)) return {p.disturbance.torque, 0.0, 0.0};
  const std::vector<motion::Ripple> error = ripples_of(p.load_side.error, p.initial.position);
  const HeldLoad load = held_load(p, error);
  const double torque = p.disturbance.torque + (1.0 + motion::slope(error, 0.0)) * load.torque;
  if (std::abs(torque) < holding_limit(p)) return {torque, load.twist, 0.0};
  return {0.0, load.twist, -torque};
}

double initial_integral(const TrialParameters& p) {
  return p.initial.integral + held_start(p).integral;
}

double held_torque(const TrialParameters& p) {
  return p.command.torque.levels.empty() ? held_start(p).integral : 0.0;
}

loop::StartOfMotion start_of_motion(const TrialParameters& p) {
  loop::StartOfMotion start{p.initial.encoder_phase, p.initial.other_encoder_phase, 0.0, 0.0,
                            p.initial.velocity};
  if (!motion::has_load(p.plant)) return start;
  const bool at_load = p.plant.load.encoder == motion::EncoderPlace::load;
  const std::vector<motion::Ripple> error = ripples_of(p.load_side.error, p.initial.position);
  (at_load ? start.theta : start.other_theta) = motion::value(error, 0.0) - held_start(p).twist;
  return start;
}

motion::PlantStart plant_start(const TrialParameters& p) {
  return {p.initial.position,   p.initial.hardening,
          p.initial.preload,    draw_history(p.initial.history, p.randomness),
          p.initial.velocity,   p.initial.mode == InitialMode::slide,
          held_start(p).contact};
}

motion::LoadSide load_side(const TrialParameters& p) {
  const double position = p.initial.position;
  return {ripples_of(p.load_side.error, position),
          disturbance_of(p.load_side.disturbance, position, p.randomness, random_lines(p.disturbance)),
          held_start(p).twist};
}

motion::MotionTolerance motion_tolerance(double resolution) {
  return {motion_tolerance_in_counts * resolution, rest_in_counts * resolution};
}

}  // namespace zerocount::trial
