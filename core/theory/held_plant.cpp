#include "core/theory/held_plant.hpp"

#include <numbers>

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

namespace zerocount::theory {

/// exp([F g; 0 0]) holds A in its upper left block and b above its last entry, with time in samples.
HeldPlant hold_plant(double stiffness, double damping, double inertia, double count_angle, double sample_time,
                     const LinearDrive& drive) {
  const bool lags = drive.bandwidth > 0.0;
  const double T = sample_time;
  const Eigen::Index states = lags ? 3 : 2;
  constexpr Eigen::Index torque = 2;  // the amplifier's, or its input where it does not lag
  Eigen::MatrixXd generator = Eigen::MatrixXd::Zero(states + 1, states + 1);
  generator(0, 1) = 1.0;
  generator(1, 0) = -stiffness * T * T / inertia;
  generator(1, 1) = -damping * T / inertia;
  generator(1, torque) = T * T / inertia / count_angle;
  if (lags) {
    const double rate = 2.0 * std::numbers::pi * drive.bandwidth * T;
    generator(torque, torque) = -rate;
    generator(torque, states) = rate;
  }
  const Eigen::MatrixXd flow = generator.exp();
  return {flow.topLeftCorner(states, states), drive.gain * flow.topRightCorner(states, 1)};
}

}  // namespace zerocount::theory
