#pragma once

#include "core/motion/taylor_step.hpp"
#include "core/motion/torque_course.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::friction {

/// Contact of a rotor that Coulomb friction holds still.
struct StandingContact {
  double breakaway;  ///< Breakaway torque Fs, N m
  double inertia;    ///< Inertia J of the rotor, kg m²
  bool spent;        ///< Whether a slide that led no further than the tolerance (leads_nowhere()) has just
                     /// < ended here
};

struct StandingSeries {
  numerics::Series position{};  ///< Travel of the rotor: 0, because it stands
  numerics::Series omega{};     ///< Velocity of the rotor: 0, because it stands
  numerics::Series exponent{};  ///< Exponent of the motion's exponential: 0, because there is none
  numerics::Series torque{};    ///< Torque on the rotor, N m
};

/// A rotor at rest while the torque on it, u − Ts (motor torque minus coupling torque), is within the
/// breakaway torque.
struct StandingRotor {
  using Expansion = StandingSeries;
  enum class Event { none, at_level, beyond };

  StandingContact contact;
  const motion::Disturbance* disturbance;  ///< Varying disturbance torque on the rotor; null without one
  double direction{0};  ///< Direction of the torque on the rotor at the end of the step: −1, 1

  static StandingSeries start() { return {}; }
  static double expand(StandingSeries& s, std::size_t k, double torque) {
    s.torque[k] = torque;
    return 0.0;
  }
  /// Longest step (s) in which the Taylor series of the torque on a standing rotor is accurate. While the
  /// rotor stands the torque moves nothing, so no error of the position limits the step. The series of the
  /// torque ends before series_order. For a motor and a load, the last two terms times t must stay below the
  /// tolerance times t. For a vibration that test is not enough, because the last terms of one line vanish at
  /// its extremes and the terms of several lines cancel. The truncation error of a vibration is therefore
  /// bounded line by line.
  double step_of_state(const StandingSeries& s, double tolerance, double duration) const;
  motion::NextEvent<Event> first_event(const StandingSeries& s, double step) const;
  void go_to(const StandingSeries& s, const motion::NextEvent<Event>& next) {
    direction = numerics::sign_of(numerics::value_at(s.torque, next.time));
  }
};

/// Result of one integration step of a rotor at rest.
struct StandStep {
  double time;  ///< Time that the step took, s
  /// Direction in which the torque releases the rotor at the end of the step: −1, 1; 0: it still stands
  double direction;
  bool at_level;  ///< Whether the torque equals the breakaway torque at the end of the step
                  /// < (Slide::at_level); otherwise it exceeds it
};

/// Advances a standing rotor under a torque with a load or a varying disturbance. The step ends at the end of
/// the Taylor step, or when the torque on the rotor, u − Ts, exceeds the breakaway torque. The load moves.
///
/// Each step goes forward in time or releases the rotor, and a torque at the level releases it once at an
/// instant. When the torque reaches the breakaway level, its rounded value may lie on either side. It counts
/// as equal to the level, so that the slide begins with the rate of the torque. A slide that nevertheless
/// leads nowhere leaves a `spent` contact, which a torque within rounding of the level does not release at
/// this instant.
/// @param tolerance tolerance of the load's twist, rad.
/// @param duration longest step, s.
StandStep stand_step(const StandingContact& contact, const motion::TorqueCourse& torque, double tolerance,
                     double duration);

/// Whether a slide from angle `from` to angle `to` (rad) led no further than the tolerance of the rotor's
/// position (rad).
inline bool leads_nowhere(double from, double to, double tolerance) {
  return from - to <= tolerance && to - from <= tolerance;
}

}  // namespace zerocount::friction
