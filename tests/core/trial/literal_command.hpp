#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/trial/trial.hpp"

/// The command at each sample of a trial, computed independently from core/README.md.
namespace zerocount::testing {

/// Where the samples of a move are in those of its trial.
struct MoveSpan {
  std::size_t first{0};
  std::size_t size{0};
};

/// The moves of the trial, by the stated numbers of samples.
std::vector<MoveSpan> literal_spans(const trial::TrialParameters& p);

/// The number of samples on the way from one torque level to the next, n = ⌈|b − a|/(rate·T)⌉; `move` has b.
std::int64_t literal_samples_on_the_way(const trial::TrialParameters& p, std::size_t move);

/// The commanded torque (N m) of each sample, open loop.
std::vector<long double> literal_torques(const trial::TrialParameters& p);

/// The fastest motion from rest to rest within the limits of a profile: a velocity that is constant for the
/// time `pulse`, averaged over the time `ramp`, which limits the acceleration, and over the time `blend`,
/// which limits the jerk. All s; 0 of those that the profile does without.
struct LiteralMotion {
  long double travel{0};  ///< with its sign, counts
  long double pulse{0};
  long double ramp{0};
  long double blend{0};
  long double duration() const { return pulse + ramp + blend; }
};

/// The motion of the reference in a move, closed loop.
LiteralMotion literal_motion(const trial::TrialParameters& p, std::size_t move);

/// How far (counts, not rounded) the motion is after the time t (s).
long double literal_travel(const LiteralMotion& motion, long double t);

}  // namespace zerocount::testing
