#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/core/trial/literal_trial.hpp"

namespace zerocount::testing {
namespace {

using Real = long double;

constexpr Real revolution = 2 * std::numbers::pi_v<Real>;

Real level_before(const trial::TrialParameters& p, std::size_t move) {
  return move == 0 ? 0.0 : p.command.torque.levels[move - 1];
}

/// Integral of a unit step at t = 0 up to the time t: twice, or three times if `thrice` is set.
Real integrated_step(Real t, bool thrice) {
  if (t <= 0) return 0;
  return thrice ? t * t * t / 6 : t * t / 2;
}

/// The motion over the travel (rad) whose velocity pulse has the given velocity (rad/s), with the shortest
/// ramp and blend that the limits allow.
LiteralMotion motion_at(Real velocity, Real travel, const loop::ReferenceProfile& limits) {
  Real acceleration = limits.acceleration_limit;
  LiteralMotion motion;
  if (limits.shape == loop::ReferenceShape::s_curve) {
    acceleration = std::min(acceleration, std::sqrt(velocity * limits.jerk_limit));
    motion.blend = acceleration / limits.jerk_limit;
  }
  motion.ramp = velocity / acceleration;
  motion.pulse = travel / velocity;
  return motion;
}

/// Whether the motion reaches the velocity of its pulse despite the averaging over ramp and blend.
bool keeps_its_velocity(const LiteralMotion& motion) {
  return motion.pulse >= motion.ramp + motion.blend;
}

}  // namespace

std::int64_t literal_samples_on_the_way(const trial::TrialParameters& p, std::size_t move) {
  const Real way = std::abs(p.command.torque.levels[move] - level_before(p, move));
  const Real samples = way / p.command.torque.rate * p.controller.sample_rate;
  return std::llround(std::ceil(samples - 1e-6L));  // a whole number of samples is not one more
}

std::vector<MoveSpan> literal_spans(const trial::TrialParameters& p) {
  const auto held = static_cast<std::size_t>(std::llround(p.command.hold * p.controller.sample_rate));
  std::vector<MoveSpan> spans;
  std::size_t first = 0;
  const bool open = !p.command.torque.levels.empty();
  const std::size_t moves = open ? p.command.torque.levels.size() : p.command.targets.size();
  for (std::size_t move = 0; move < moves; ++move) {
    const auto on_the_way = open ? static_cast<std::size_t>(literal_samples_on_the_way(p, move)) : 0;
    spans.push_back({first, on_the_way + held});
    first += on_the_way + held;
  }
  return spans;
}

std::vector<Real> literal_torques(const trial::TrialParameters& p) {
  const std::vector<MoveSpan> spans = literal_spans(p);
  std::vector<Real> torques;
  for (std::size_t move = 0; move < spans.size(); ++move) {
    const Real from = level_before(p, move);
    const Real to = p.command.torque.levels[move];
    for (std::size_t i = 0; i < spans[move].size; ++i) {
      const Real changed = static_cast<Real>(i) * p.command.torque.rate / p.controller.sample_rate;
      torques.push_back(from < to ? std::min(to, from + changed) : std::max(to, from - changed));
    }
  }
  return torques;
}

LiteralMotion literal_motion(const trial::TrialParameters& p, std::size_t move) {
  const Real from = move == 0 ? 0 : static_cast<Real>(p.command.targets[move - 1]);
  const Real travel = static_cast<Real>(p.command.targets[move]) - from;
  LiteralMotion motion;
  if (p.command.profile.shape != loop::ReferenceShape::step && travel != 0) {
    const Real radians = std::abs(travel) * revolution / p.encoder.fine;
    Real low = 0;
    Real high = p.command.profile.velocity_limit;
    if (!keeps_its_velocity(motion_at(high, radians, p.command.profile))) {
      for (int halving = 0; halving < 200; ++halving) {
        const Real middle = (low + high) / 2;
        (keeps_its_velocity(motion_at(middle, radians, p.command.profile)) ? low : high) = middle;
      }
    }
    motion = motion_at(high, radians, p.command.profile);
  }
  motion.travel = travel;
  return motion;
}

// The velocity is a step up at 0 and one down at `pulse`. An average over a time is the integral less the
// same integral delayed by that time, divided by it; so the travel is a sum of integrated steps.
Real literal_travel(const LiteralMotion& motion, Real t) {
  if (motion.pulse == 0 || t >= motion.duration()) return motion.travel;
  const bool blended = motion.blend > 0;
  Real sum = 0;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      for (int l = 0; l < (blended ? 2 : 1); ++l) {
        const Real since = t - static_cast<Real>(i) * motion.pulse - static_cast<Real>(j) * motion.ramp -
                           static_cast<Real>(l) * motion.blend;
        sum += ((i + j + l) % 2 == 0 ? 1 : -1) * integrated_step(since, blended);
      }
    }
  }
  return motion.travel * sum / (motion.pulse * motion.ramp * (blended ? motion.blend : 1));
}

}  // namespace zerocount::testing
