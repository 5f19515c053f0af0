#pragma once

#include <random>
#include <vector>

#include "analysis/records/raw_series.hpp"

namespace zerocount::testing {

/// A rotary joint under gravity, its drive and its encoder.
struct Joint {
  double inertia{0.0};            ///< kg m²
  double damping{0.0};            ///< N m s/rad
  double coulomb{0.0};            ///< N m
  double excess{0.0};             ///< of the breakaway torque over it, N m
  double stribeck_velocity{0.0};  ///< rad/s
  double offset{0.0};             ///< against the drive, N m
  double gravity{0.0};            ///< amplitude of a torque that acts once in a revolution, N m
  double gravity_phase{0.0};      ///< rad
  double ripple{0.0};             ///< amplitude of one that acts `periods` times
  double periods{1.0};
  double ripple_phase{0.0};
  double stiffness{0.0};         ///< of the coupling to a second mass, N m/rad; 0: none
  double load{0.0};              ///< inertia of the second mass, kg m²; gravity acts on it
  double coupling_damping{0.0};  ///< N m s/rad
  double directional{0.0};       ///< how much larger the Coulomb level is forward than backward, N m
  double quadratic{0.0};         ///< Drag per square of the speed, N m s²/rad².
  double damping_asymmetry{
      0.0};                   ///< Excess of the damping forward over the mean of both directions, relative.
  double load_friction{0.0};  ///< Friction per torque that the transmission carries, dimensionless.
  double coulomb_drift{0.0};  ///< Relative fall of the Coulomb level per second.
  int torque_delay{0};        ///< Samples by which the torque acts after it is recorded.
  double sample_time{1e-3};   ///< s
  double resolution{0.0};     ///< rad
  double noise{0.0};          ///< of the readings, standard deviation, rad
};

/// A joint of random size with an encoder of random fineness; without gravity, ripple and second mass.
Joint random_joint(std::mt19937_64& random);

/// A joint and the angles between which it moves.
struct JointMotion {
  Joint joint;
  std::vector<double> targets;
  double speed{0.0};
};

/// 2 to 14 moves of a random joint within 0.3 to 8 rad.
JointMotion random_joint_motion(std::mt19937_64& random, bool with_gravity, bool with_ripple);

/// The record of a joint that goes to these angles (rad) one after the other in a loop of P position and P
/// velocity control, with trapezoids of the velocity (rad/s) and dwells of 0.1 s.
///
/// The motion is integrated by Boost.odeint's Dormand–Prince 5 in eighths of a sample, with stops located in
/// time: written from the equations alone, to judge what is fitted to it.
records::RawSeries joint_record(const Joint& joint, const std::vector<double>& targets, double speed,
                                std::mt19937_64& random);

}  // namespace zerocount::testing
