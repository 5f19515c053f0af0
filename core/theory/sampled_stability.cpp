#include "core/theory/sampled_stability.hpp"

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/theory/gains.hpp"

namespace zerocount {
namespace {

/// The rotor over one sample, x = (count, change of count per sample at the current velocity): x ← A·x + b·u.
struct HeldPlant {
  Eigen::Matrix2d A;  ///< dimensionless
  Eigen::Vector2d b;  ///< counts/(N m)
};

/// Exact discretisation: exp([F g; 0 0]) holds A in its upper left block and b above its last entry, with
/// time in samples.
HeldPlant discretise(double stiffness, const PlantParameters& plant, double dx, double T) {
  Eigen::Matrix3d generator = Eigen::Matrix3d::Zero();
  generator(0, 1) = 1.0;
  generator(1, 0) = -stiffness * T * T / plant.inertia;
  generator(1, 1) = -plant.presliding_damping * T / plant.inertia;
  generator(1, 2) = T * T / plant.inertia / dx;
  const Eigen::Matrix3d flow = generator.exp();
  return {flow.topLeftCorner<2, 2>(), flow.topRightCorner<2, 1>()};
}

/// The one-sample map of (count, change per sample, last count, integral, pending torques newest first),
/// target 0.
Eigen::MatrixXd closed_loop(const HeldPlant& plant, const ControllerParameters& controller) {
  constexpr Eigen::Index count = 0, last_count = 2, integral = 3, pending = 4;
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
  map.topLeftCorner<2, 2>() = plant.A;
  map.topRows<2>() += plant.b * applied;
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
                               const EncoderParameters& encoder, const ControllerParameters& controller) {
  return spectral_radius(discretise(stiffness, plant, count_angle(encoder), sample_time(controller)),
                         controller);
}

double sampled_critical_integral_gain(double stiffness, const PlantParameters& plant,
                                      const EncoderParameters& encoder, ControllerParameters controller) {
  const double dx = count_angle(encoder);
  const HeldPlant held = discretise(stiffness, plant, dx, sample_time(controller));
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
