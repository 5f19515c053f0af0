#include "core/theory/sampled_stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "core/theory/gains.hpp"
#include "core/theory/held_plant.hpp"

namespace zerocount {
namespace {

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

HeldPlant presliding_plant(double stiffness, const PlantParameters& plant, const EncoderParameters& encoder,
                           const ControllerParameters& controller, const LinearDrive& drive) {
  return hold_plant(stiffness, plant.presliding_damping, plant.inertia, fine_resolution(encoder),
                    sample_time(controller), drive);
}

double spectral_radius(const HeldPlant& plant, const ControllerParameters& controller) {
  return closed_loop(plant, controller).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

double sampled_spectral_radius(double stiffness, const PlantParameters& plant,
                               const EncoderParameters& encoder, const ControllerParameters& controller,
                               const LinearDrive& drive) {
  return spectral_radius(presliding_plant(stiffness, plant, encoder, controller, drive), controller);
}

double slowest_time_constant(double stiffness, const PlantParameters& plant, const EncoderParameters& encoder,
                             const ControllerParameters& controller, const LinearDrive& drive) {
  const HeldPlant held = presliding_plant(stiffness, plant, encoder, controller, drive);
  Eigen::MatrixXd map = closed_loop(held, controller);
  const Eigen::Index integral = held.A.rows() + 1;
  if (controller.ki == 0.0) map(integral, integral) = 0.0;
  const Eigen::VectorXcd eigenvalues = map.eigenvalues();
  if (!(eigenvalues.cwiseAbs().maxCoeff() < 1.0)) return std::numeric_limits<double>::infinity();
  double slowest = 0.0;
  for (const auto& z : eigenvalues) {
    if (z.imag() == 0.0) slowest = std::max(slowest, z.real());
  }
  constexpr double gone_at_once = 1e-6;  // eigenvalues that are 0, but for rounding
  return slowest > gone_at_once ? -sample_time(controller) / std::log(slowest) : 0.0;
}

double sampled_critical_integral_gain(double stiffness, const PlantParameters& plant,
                                      const EncoderParameters& encoder, ControllerParameters controller,
                                      const LinearDrive& drive) {
  const HeldPlant held = presliding_plant(stiffness, plant, encoder, controller, drive);
  const auto stable = [&](double ki) {
    controller.ki = ki;
    return spectral_radius(held, controller) < 1.0;
  };
  double low = 1e-6 * (stiffness * fine_resolution(encoder) + controller.kp);  // N m/count
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
