#include "core/theory/sliding_loop.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include <Eigen/Dense>

#include "core/loop/controller.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/held_plant.hpp"

namespace zerocount {
namespace {

using Complex = std::complex<double>;

/// L at z = exp(i·angle).
Complex open_loop(double angle, const HeldPlant& plant, const ControllerParameters& controller) {
  const Complex z = std::polar(1.0, angle);
  const Eigen::Index states = plant.A.rows();
  const Eigen::MatrixXcd resolvent = z * Eigen::MatrixXcd::Identity(states, states) - plant.A;
  const Eigen::VectorXcd response = resolvent.fullPivLu().solve(plant.b.cast<Complex>());
  const Complex control =
      controller.kp + controller.ki * (z + 1.0) / (z - 1.0) + controller.kd * (z - 1.0) / z;
  return control * std::pow(z, -controller.delay) * response(0);
}

}  // namespace

ControllerParameters controller_in_phase(ControllerParameters controller, ControlPhase phase) {
  if (!has_coarse_phase(controller)) return controller;
  switch (phase) {
    case ControlPhase::fine:
      controller.kd = 0.0;
      break;
    case ControlPhase::coarse:
      controller.kp = controller.coarse.kp;
      controller.ki = controller.coarse.ki;
      controller.kd = controller.coarse.kd;
      break;
  }
  return controller;
}

GainCrossover sliding_crossover(const PlantParameters& plant, const EncoderParameters& encoder,
                                const ControllerParameters& controller, const LinearDrive& drive) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const double T = sample_time(controller);
  const HeldPlant held =
      hold_plant(0.0, plant.sliding_damping, plant.inertia, fine_resolution(encoder), T, drive);
  const auto passes = [&](double angle) { return std::abs(open_loop(angle, held, controller)) >= 1.0; };
  // Downwards from half the sample rate, to a millionth of it.
  constexpr double step = 0.99;
  constexpr double lowest = 1e-6 * std::numbers::pi;
  double high = std::numbers::pi;
  if (passes(high)) return {none, none};
  double low = high * step;
  for (; !passes(low); low *= step) {
    if (low < lowest) return {none, none};
    high = low;
  }
  while (high - low > 1e-12 * high) {
    const double middle = 0.5 * (low + high);
    (passes(middle) ? low : high) = middle;
  }
  const Complex at = open_loop(low, held, controller);
  return {low / (2.0 * std::numbers::pi * T), std::arg(-at) * 180.0 / std::numbers::pi};
}

bool stable_while_sliding(const PlantParameters& plant, const EncoderParameters& encoder,
                          const ControllerParameters& controller, const LinearDrive& drive) {
  PlantParameters sliding = plant;
  sliding.presliding_damping = plant.sliding_damping;
  return slowest_time_constant(0.0, sliding, encoder, controller, drive) <
         std::numeric_limits<double>::infinity();
}

}  // namespace zerocount
