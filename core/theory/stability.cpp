#include "core/theory/stability.hpp"

#include <cmath>
#include <numbers>

#include "core/friction/profile.hpp"
#include "core/theory/gains.hpp"

namespace zerocount::theory {

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
