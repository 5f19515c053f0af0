#include "core/theory/sampled_stability.hpp"

#include <numbers>

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/theory/gains.hpp"

namespace zerocount {
namespace {

/// The driven rotor over one sample, x ← A·x + b·v with x = (count, change of count per sample at the current
/// velocity, and where the amplifier lags, its torque).
struct HeldPlant {
  Eigen::MatrixXd A;  ///< of counts and N m
  Eigen::VectorXd b;  ///< counts/(N m); 1 for the torque
};

/// Exact discretisation: exp([F g; 0 0]) holds A in its upper left block and b above its last entry, with
/// time in samples.
HeldPlant discretise(double stiffness, const PlantParameters& plant, double dx, double T,
                     const LinearDrive& drive) {
  const bool lags = drive.bandwidth > 0.0;
  const Eigen::Index states = lags ? 3 : 2;
  constexpr Eigen::Index torque = 2;  // the amplifier's, or its input where it does not lag
  Eigen::MatrixXd generator = Eigen::MatrixXd::Zero(states + 1, states + 1);
  generator(0, 1) = 1.0;
  generator(1, 0) = -stiffness * T * T / plant.inertia;
  generator(1, 1) = -plant.presliding_damping * T / plant.inertia;
  generator(1, torque) = T * T / plant.inertia / dx;
  if (lags) {
    const double rate = 2.0 * std::numbers::pi * drive.bandwidth * T;
    generator(torque, torque) = -rate;
    generator(torque, states) = rate;
  }
  const Eigen::MatrixXd flow = generator.exp();
  return {flow.topLeftCorner(states, states), drive.gain * flow.topRightCorner(states, 1)};
}

/// The one-sample map of (the driven rotor, last count, integral, pending torques newest first), target 0.
Eigen::MatrixXd closed_loop(const HeldPlant& plant, const ControllerParameters& controller) {
  const Eigen::Index driven = plant.A.rows();
  constexpr Eigen::Index count = 0;
  const Eigen::Index last_count = driven, integral = driven + 1, pending = driven + 2;
  const Eigen::Index states = pending + controller.delay;

  Eigen::RowVectorXd next_integral = Eigen::RowVectorXd::Zero(states);  // I + ki·(e_k + e_{k−1}), e = −count
  next_integral(integral) = 1.0;
  next_integral(count) = -controller.ki;
  next_integral(last_count) = -controller.ki;

  Eigen::RowVectorXd decided = next_integral;  // I + kp·e − kd·(count_k − count_{k−1})
  decided(count) -= controller.kp + controller.kd;
  decided(last_count) += controller.kd;

  const Eigen::RowVectorXd applied =
      controller.delay == 0 ? decided : Eigen::RowVectorXd::Unit(states, states - 1);

  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(states, states);
  map.topLeftCorner(driven, driven) = plant.A;
  map.topRows(driven) += plant.b * applied;
  map(last_count, count) = 1.0;
  map.row(integral) = next_integral;
  if (controller.delay > 0) map.row(pending) = decided;
  for (Eigen::Index i = pending + 1; i < states; ++i) map(i, i - 1) = 1.0;
  return map;
}

double spectral_radius(const HeldPlant& plant, const ControllerParameters& controller) {
  return closed_loop(plant, controller).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

double sampled_spectral_radius(double stiffness, const PlantParameters& plant,
                               const EncoderParameters& encoder, const ControllerParameters& controller,
                               const LinearDrive& drive) {
  const double T = sample_time(controller);
  return spectral_radius(discretise(stiffness, plant, fine_resolution(encoder), T, drive), controller);
}

double sampled_critical_integral_gain(double stiffness, const PlantParameters& plant,
                                      const EncoderParameters& encoder, ControllerParameters controller,
                                      const LinearDrive& drive) {
  const double dx = fine_resolution(encoder);
  const HeldPlant held = discretise(stiffness, plant, dx, sample_time(controller), drive);
  const auto stable = [&](double ki) {
    controller.ki = ki;
    return spectral_radius(held, controller) < 1.0;
  };
  double low = 1e-6 * (stiffness * dx + controller.kp);  // N m/count
  if (!stable(low)) return 0.0;
  constexpr double step = 1.02;
  double high = low * step;
  for (; stable(high); high *= step) low = high;
  constexpr double tolerance = 1e-9;
  while (high - low > tolerance * high) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace zerocount
