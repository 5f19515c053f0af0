#include "core/trial/rig.hpp"

#include "core/trial/random_history.hpp"

namespace zerocount::trial {
namespace {

/// Fraction of a fine count that the motion may leave out per torque step. Far below the accuracy asked for,
/// because a trial that breaks away in every cycle of its ringing multiplies an error from cycle to cycle.
constexpr double motion_tolerance_in_counts = 1e-11;

/// Amplitude of an oscillation that counts as rest, in fine counts: a hundredth of the accuracy asked for.
constexpr double rest_in_counts = 1e-8;

}  // namespace

motion::PlantStart plant_start(const TrialParameters& p) {
  return {p.initial.position, p.initial.hardening,
          p.initial.preload,  draw_history(p.initial.history, p.randomness),
          p.initial.velocity, p.initial.mode == InitialMode::slide};
}

motion::MotionTolerance motion_tolerance(double resolution) {
  return {motion_tolerance_in_counts * resolution, rest_in_counts * resolution};
}

}  // namespace zerocount::trial
