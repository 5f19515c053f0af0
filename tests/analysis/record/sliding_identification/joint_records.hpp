#pragma once

#include <random>
#include <vector>

#include "analysis/record/records/raw_series.hpp"

namespace zerocount::testing {

/// A rotary joint under gravity, its drive and its encoder.
struct Joint {
  double inertia{0.0};            ///< moment of inertia, kg m²
  double damping{0.0};            ///< viscous damping, N m s/rad
  double coulomb{0.0};            ///< Coulomb level, N m
  double excess{0.0};             ///< excess of the breakaway torque over the Coulomb level, N m
  double stribeck_velocity{0.0};  ///< Stribeck velocity, rad/s
  double offset{0.0};             ///< constant torque against the drive, N m
  double gravity{0.0};        ///< amplitude of the gravity torque, which has one period per revolution, N m
  double gravity_phase{0.0};  ///< phase of the gravity torque, rad
  double ripple{0.0};         ///< amplitude of a ripple torque with `periods` periods per revolution, N m
  double periods{1.0};
  double ripple_phase{0.0};
  double stiffness{0.0};         ///< stiffness of the coupling to a second mass, N m/rad; 0: none
  double load{0.0};              ///< moment of inertia of the second mass, kg m²; gravity acts on it
  double coupling_damping{0.0};  ///< damping of the coupling, N m s/rad
  double directional{0.0};       ///< Coulomb level forward minus Coulomb level backward, N m
  double quadratic{0.0};  ///< coefficient of a drag proportional to the square of the speed, N m s²/rad²
  /// Difference of the viscous damping forward from the mean of both directions, relative to that mean.
  double damping_asymmetry{0.0};
  double load_friction{0.0};  ///< Friction torque per torque that the transmission carries, dimensionless.
  double coulomb_drift{0.0};  ///< Relative fall of the Coulomb level per second.
  int torque_delay{0};        ///< Samples by which the torque acts after it is recorded.
  double sample_time{1e-3};   ///< sample time, s
  double resolution{0.0};     ///< encoder resolution, rad
  double noise{0.0};          ///< standard deviation of the readings, rad
};

/// A joint of random size with an encoder of random fineness; without gravity, ripple and second mass.
Joint random_joint(std::mt19937_64& random);

/// A joint and the angles between which it moves.
struct JointMotion {
  Joint joint;
  std::vector<double> targets;
  double speed{0.0};
};

/// A random joint that makes 2 to 14 moves between angles within 0.3 to 8 rad.
JointMotion random_joint_motion(std::mt19937_64& random, bool with_gravity, bool with_ripple);

/// The record of a joint that goes to these angles (rad) one after the other in a loop of P position and P
/// velocity control, with trapezoids of the velocity (rad/s) and dwells of 0.1 s.
///
/// The motion is integrated by Boost.odeint's Dormand–Prince 5 in eighths of a sample, with stops located in
/// time. It is written from the equations alone, so that it can judge the identification.
records::RawSeries joint_record(const Joint& joint, const std::vector<double>& targets, double speed,
                                std::mt19937_64& random);

}  // namespace zerocount::testing
