#include "core/theory/sampled_stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/loop/controller.hpp"
#include "core/numerics/dense.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/linear_loop.hpp"

namespace zerocount::theory {
namespace {

HeldPlant presliding_plant(double stiffness, const motion::PlantParameters& plant,
                           const loop::EncoderParameters& encoder,
                           const loop::ControllerParameters& controller, const LinearDrive& drive) {
  return hold_plant(stiffness, plant.presliding_damping, plant, loop::fine_resolution(encoder),
                    sample_time(controller), drive, controller.delay);
}

/// Controller is ControllerParameters, const or not.
template <class Controller>
auto& integral_gain_in(Controller& controller) {
  switch (controller.blocks.structure) {
    case loop::ControlStructure::cascade:
      return controller.blocks.cascade.ki;
    case loop::ControlStructure::pid:
      break;
  }
  return controller.ki;
}

/// Stiffness of spring and control law without integral, in the unit of integral_gain: N m/count or N m/rad.
double static_stiffness(double stiffness, const loop::EncoderParameters& encoder,
                        const loop::ControllerParameters& controller) {
  switch (controller.blocks.structure) {
    case loop::ControlStructure::cascade:
      return stiffness + controller.blocks.cascade.kp * controller.blocks.cascade.kv;
    case loop::ControlStructure::pid:
      break;
  }
  return stiffness * loop::fine_resolution(encoder) + controller.kp;
}

}  // namespace

double sampled_spectral_radius(double stiffness, const motion::PlantParameters& plant,
                               const loop::EncoderParameters& encoder,
                               const loop::ControllerParameters& controller, const LinearDrive& drive) {
  return spectral_radius(presliding_plant(stiffness, plant, encoder, controller, drive),
                         loop::linear_chain(controller, loop::fine_resolution(encoder)));
}

double slowest_time_constant(double stiffness, const motion::PlantParameters& plant,
                             const loop::EncoderParameters& encoder,
                             const loop::ControllerParameters& controller, const LinearDrive& drive) {
  const HeldPlant held = presliding_plant(stiffness, plant, encoder, controller, drive);
  const Eigen::VectorXcd eigenvalues =
      numerics::eigenvalues(loop_map(held, loop::linear_chain(controller, loop::fine_resolution(encoder))));
  if (!(eigenvalues.cwiseAbs().maxCoeff() < 1.0 - edge_of_stability))
    return std::numeric_limits<double>::infinity();
  double slowest = 0.0;
  for (const auto& z : eigenvalues) {
    if (z.imag() == 0.0) slowest = std::max(slowest, z.real());
  }
  constexpr double gone_at_once = 1e-6;  // eigenvalues that are 0 up to rounding
  return slowest > gone_at_once ? -sample_time(controller) / std::log(slowest) : 0.0;
}

double integral_gain(const loop::ControllerParameters& controller) {
  return integral_gain_in(controller);
}

double sampled_critical_integral_gain(double stiffness, const motion::PlantParameters& plant,
                                      const loop::EncoderParameters& encoder,
                                      loop::ControllerParameters controller, const LinearDrive& drive) {
  const HeldPlant held = presliding_plant(stiffness, plant, encoder, controller, drive);
  double& ki = integral_gain_in(controller);
  const auto stable = [&](double gain) {
    ki = gain;
    return spectral_radius(held, loop::linear_chain(controller, loop::fine_resolution(encoder))) < 1.0;
  };
  const double lowest = 1e-6 * static_stiffness(stiffness, encoder, controller);
  // Without stiffness and kp no integral gain is stable; the eigenvalue 1 of the free rotor may round
  // below 1.
  if (lowest == 0.0 || !stable(lowest)) return 0.0;
  constexpr double step = 1.02;
  double low = lowest;
  double high = low * step;
  for (; stable(high); high *= step) {
    if (high > 1e15 * lowest) return std::numeric_limits<double>::infinity();
    low = high;
  }
  constexpr double tolerance = 1e-9;
  while (high - low > tolerance * high) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace zerocount::theory
