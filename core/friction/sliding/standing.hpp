#pragma once

#include "core/motion/taylor_step.hpp"
#include "core/motion/torque_course.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::friction {

/// A rotor that Coulomb's friction holds.
struct StandingContact {
  double breakaway;  ///< Fs, N m
  double inertia;    ///< of the rotor, J, kg m²
  bool spent;        ///< a slide that led nowhere (leads_nowhere) has just ended
};

struct StandingSeries {
  numerics::Series position{};  ///< 0
  numerics::Series omega{};     ///< 0
  numerics::Series exponent{};  ///< 0
  numerics::Series torque{};    ///< on the rotor, N m
};

/// A rotor at rest while the torque on it, u − Ts, is within the breakaway torque.
struct StandingRotor {
  using Expansion = StandingSeries;
  enum class Event { none, at_level, beyond };

  StandingContact contact;
  const motion::Disturbance* disturbance;  ///< may be null
  double direction{0};                     ///< of the torque on it at the end of the step: −1, 1

  static StandingSeries start() { return {}; }
  static double expand(StandingSeries& s, std::size_t k, double torque) {
    s.torque[k] = torque;
    return 0.0;
  }
  /// The torque moves nothing while the rotor stands, so that no error of the position limits the step. Its
  /// series ends before series_order. Of a motor and a load the last two terms, times t, stay below the
  /// tolerance times t. Those of a line of a vibration may vanish, one at each extreme, and those of several
  /// lines cancel: what they leave out is bounded line by line.
  double step_of_state(const StandingSeries& s, double tolerance, double duration) const;
  motion::NextEvent<Event> first_event(const StandingSeries& s, double step) const;
  void go_to(const StandingSeries& s, const motion::NextEvent<Event>& next) {
    direction = numerics::sign_of(numerics::value_at(s.torque, next.time));
  }
};

/// A step of a rotor at rest.
struct StandStep {
  double time;       ///< that it took, s
  double direction;  ///< in which the torque releases the rotor at its end: −1, 1; 0: it still stands
  bool at_level;     ///< the torque is that of breakaway there (Slide::at_level); otherwise it is beyond
};

/// Lets a rotor stand under a torque with a load or a varying disturbance, as far as a Taylor step goes, or
/// until the torque on it, u − Ts, exceeds the breakaway torque. Moves the load.
///
/// Each step goes forward in time or releases the rotor, and a torque at the level releases it once at an
/// instant. Where the torque reaches the level of breakaway, its rounded value lies on either side. It counts
/// as that level, so that the slide begins with the rate of the torque. A slide that nevertheless leads
/// nowhere leaves a contact that is `spent`: a torque within rounding of the level does not release it at
/// this instant.
/// @param tolerance of the load's twist, rad. @param duration longest step, s.
StandStep stand_step(const StandingContact& contact, const motion::TorqueCourse& torque, double tolerance,
                     double duration);

/// Whether a slide that has ended led no further than the tolerance of the rotor's position, rad.
inline bool leads_nowhere(double from, double to, double tolerance) {
  return from - to <= tolerance && to - from <= tolerance;
}

}  // namespace zerocount::friction
