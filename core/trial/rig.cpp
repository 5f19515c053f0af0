#include "core/trial/rig.hpp"

#include "core/trial/random_history.hpp"

namespace zerocount::trial {
namespace {

/// Truncation error of the motion per torque step, in fine counts. Far below the required accuracy, because a
/// trial that breaks away in every cycle of its oscillation amplifies an error from cycle to cycle.
constexpr double motion_tolerance_in_counts = 1e-11;

/// Amplitude of an oscillation that counts as rest, in fine counts: a hundredth of the required accuracy.
constexpr double rest_in_counts = 1e-8;

}  // namespace

motion::PlantStart plant_start(const TrialParameters& p) {
  return {p.initial.position,
          p.initial.hardening,
          p.initial.preload,
          draw_history(p.initial.history, p.randomness),
          p.initial.velocity,
          p.initial.mode == InitialMode::slide,
          p.initial.holding ? p.disturbance.torque : 0.0};
}

motion::LoadSide load_side(const TrialParameters& p) {
  const double position = p.initial.position;
  return {ripples_of(p.load_side.error, position),
          disturbance_of(p.load_side.disturbance, position, p.randomness, random_lines(p.disturbance)),
          p.initial.gap * p.plant.load.gap};
}

motion::MotionTolerance motion_tolerance(double resolution) {
  return {motion_tolerance_in_counts * resolution, rest_in_counts * resolution};
}

}  // namespace zerocount::trial
