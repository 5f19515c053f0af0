#include "core/theory/stability.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/friction/profile.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/theory/frozen_loop.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/margins.hpp"

namespace zerocount::theory {

namespace {

/// Reference to the integral gain of the control law, that of the PID law or of the cascade. Controller is
/// ControllerParameters, const or not.
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

}  // namespace

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

double integral_gain(const loop::ControllerParameters& controller) {
  return integral_gain_in(controller);
}

double sampled_critical_integral_gain(
    const std::function<FrozenLoop(const loop::ControllerParameters&)>& loop_with,
    loop::ControllerParameters controller, double scale) {
  double& ki = integral_gain_in(controller);
  const auto with_gain = [&](double gain) {
    ki = gain;
    return loop_with(controller);
  };
  const double lowest = 1e-6 * scale;
  // Without stiffness and kp no integral gain is stable; the eigenvalue 1 of the free rotor may round
  // below 1.
  if (lowest == 0.0 || poles_of(with_gain(lowest)).cwiseAbs().maxCoeff() >= 1.0) return 0.0;
  const FrozenLoop with = with_gain(scale);
  const FrozenLoop without = with_gain(0.0);
  const OpenLoop open_with = open_loop(with);
  const OpenLoop open_without = open_loop(without);
  const auto gain_on_circle = [&](double angle) {
    const std::complex<double> rest = open_without.at_angle(angle);
    return -scale * (1.0 + rest) / (open_with.at_angle(angle) - rest);
  };
  std::vector<double> angles = search_angles(with);
  add_angles_around(poles_of(without), angles);
  double bound = std::numeric_limits<double>::infinity();
  const auto add = [&](double angle) {
    const double gain = gain_on_circle(angle).real();
    if (gain > lowest) bound = std::min(bound, gain);
  };
  for (const double angle : phase_crossovers(sampled(gain_on_circle, angles))) add(angle);
  add(std::numbers::pi);
  return bound;
}

std::string_view left_out_of_criteria(const motion::PlantParameters& plant,
                                      const loop::ControllerParameters& controller) {
  if (motion::has_load(plant)) return "the second mass";
  const loop::ControlBlocks& blocks = controller.blocks;
  switch (blocks.structure) {
    case loop::ControlStructure::cascade:
      return "the cascade";
    case loop::ControlStructure::pid:
      break;
  }
  if (std::isfinite(blocks.integrator_leak)) return "the integrator leak";
  if (!blocks.filters.empty()) return "the filters";
  if (blocks.observer.bandwidth > 0.0) return "the disturbance observer";
  if (controller.kd != 0.0 && std::isfinite(blocks.derivative_cutoff)) return "the derivative filter";
  return {};
}

double critical_integral_gain(double stiffness, const motion::PlantParameters& plant,
                              const loop::EncoderParameters& encoder,
                              const loop::ControllerParameters& controller) {
  const AnalogueGains gains = analogue_gains(controller, encoder);
  const double analogue = (plant.presliding_damping + gains.kd) * (stiffness + gains.kp) / plant.inertia;
  return analogue * loop::fine_resolution(encoder) * sample_time(controller) / 2.0;
}

IntegralGainBounds integral_gain_bounds(const motion::PlantParameters& plant,
                                        const friction::FrictionParameters& contact,
                                        const loop::EncoderParameters& encoder,
                                        const loop::ControllerParameters& controller) {
  return {critical_integral_gain(contact.k1, plant, encoder, controller),
          critical_integral_gain(contact.k1 + contact.k2, plant, encoder, controller)};
}

double lowest_k1(const friction::FrictionAlongRotor& friction) {
  double lowest = friction.uniform.k1;
  for (const friction::ProfiledParameter& entry : friction.profiled) {
    if (entry.parameter == &friction::FrictionParameters::k1)
      lowest = friction::lowest_over_revolution(*entry.profile);
  }
  return lowest;
}

double dac_resolution_bound(double k1, const loop::EncoderParameters& encoder, loop::EncoderChoice feedback) {
  return k1 * (feedback == loop::EncoderChoice::fine ? loop::fine_resolution(encoder)
                                                     : loop::coarse_resolution(encoder));
}

double natural_frequency(double stiffness, const motion::PlantParameters& plant) {
  return std::sqrt(stiffness / plant.inertia) / (2.0 * std::numbers::pi);
}

double advised_sample_rate(const motion::PlantParameters& plant,
                           const friction::FrictionParameters& contact) {
  return 10.0 * natural_frequency(contact.k1 + contact.k2, plant);
}

}  // namespace zerocount::theory
