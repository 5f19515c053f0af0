#pragma once

#include "core/motion/torque_course.hpp"

namespace zerocount::friction {

/// A rotor that Coulomb's friction holds.
struct StandingContact {
  double breakaway;  ///< Fs, N m
  double inertia;    ///< of the rotor, J, kg m²
  bool spent;        ///< a slide that led nowhere (leads_nowhere) has just ended
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
