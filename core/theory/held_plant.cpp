#include <cmath>
#include <numbers>

#include "core/numerics/dense.hpp"
#include "core/theory/linear_loop.hpp"

namespace zerocount::theory {

namespace {

/// System matrix F of the driven plant in continuous time: d(x, v)/dt = F·(x, v), with x = (measured angle,
/// its rate, …), v the drive's input, and time in s.
Eigen::MatrixXd generator_of(const FrozenFriction& friction, double inertia,
                             const motion::LoadParameters& load, const LinearDrive& drive) {
  const auto [stiffness, damping, load_stiffness, load_damping] = friction;
  const bool loaded = load.inertia > 0.0;
  const bool lags = drive.bandwidth > 0.0;
  const Eigen::Index torque = loaded ? 4 : 2;  // of the motor, or its input where it does not lag
  const Eigen::Index input = torque + (lags ? 1 : 0);
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(input + 1, input + 1);
  F(0, 1) = 1.0;
  if (loaded) {
    // The angle of the other mass minus the measured one, and its rate.
    const bool at_load = load.encoder == motion::EncoderPlace::load;
    const Eigen::Index motor = at_load ? 3 : 1;
    const double measured_inertia = at_load ? load.inertia : inertia;
    const double other_inertia = at_load ? inertia : load.inertia;
    F(2, 3) = 1.0;
    F(2, 1) = -1.0;
    F(1, 2) = load.stiffness / measured_inertia;
    F(1, 3) = load.damping / measured_inertia;
    F(1, 1) = -F(1, 3);
    F(3, 2) = -load.stiffness / other_inertia;
    F(3, 3) = -load.damping / other_inertia;
    F(3, 1) = -F(3, 3);
    const Eigen::Index mass = at_load ? 1 : 3;
    F(mass, mass) -= (load.damping_to_ground + load_damping) / load.inertia;
    F(mass, 0) -= load_stiffness / load.inertia;
    if (!at_load) F(mass, 2) -= load_stiffness / load.inertia;
    F(motor, 0) -= stiffness / inertia;
    if (at_load) F(motor, 2) -= stiffness / inertia;
    F(motor, motor) -= damping / inertia;
    F(motor, torque) = 1.0 / inertia;
  } else {
    F(1, 0) = -stiffness / inertia;
    F(1, 1) = -damping / inertia;
    F(1, torque) = 1.0 / inertia;
  }
  if (lags) {
    const double rate = 2.0 * std::numbers::pi * drive.bandwidth;
    F(torque, torque) = -rate;
    F(torque, input) = rate;
  }
  return F;
}

}  // namespace

/// Discretises the plant exactly: exp(F·t), with F the system matrix in continuous time, holds the free
/// motion over t in its upper left block and the driven one above its last entry, in counts and samples. The
/// input changes after the delay's fraction of a sample.
HeldPlant hold_plant(const FrozenFriction& friction, const motion::PlantParameters& plant, double count_angle,
                     double sample_time, const LinearDrive& drive, double delay) {
  const double T = sample_time;
  Eigen::MatrixXd generator = generator_of(friction, plant.inertia, plant.load, drive);
  // From rad and rad/s to counts and counts a sample.
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(generator.rows());
  for (Eigen::Index i = 0; i < (motion::has_load(plant) ? 4 : 2); ++i)
    unit[i] = (i % 2 == 0 ? 1.0 : T) / count_angle;
  generator = T * (unit.asDiagonal() * generator * unit.cwiseInverse().asDiagonal());
  const Eigen::Index states = generator.rows() - 1;
  const double fraction = delay - std::floor(delay);
  const Eigen::MatrixXd after = numerics::matrix_exponential((1.0 - fraction) * generator);
  const auto driven = [&](const Eigen::MatrixXd& flow) -> Eigen::VectorXd {
    return drive.gain * flow.topRightCorner(states, 1);
  };
  HeldPlant held{after.topLeftCorner(states, states), driven(after), Eigen::VectorXd::Zero(states),
                 static_cast<int>(std::floor(delay))};
  if (fraction > 0.0) {
    const Eigen::MatrixXd before = numerics::matrix_exponential(fraction * generator);
    held.b_before = held.A * driven(before);
    held.A *= before.topLeftCorner(states, states);
  }
  return held;
}

}  // namespace zerocount::theory
