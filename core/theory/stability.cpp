#include "core/theory/stability.hpp"

#include <cmath>
#include <numbers>

#include "core/friction/profile_range.hpp"
#include "core/theory/gains.hpp"

namespace zerocount {

double critical_integral_gain(double stiffness, const PlantParameters& plant,
                              const EncoderParameters& encoder, const ControllerParameters& controller) {
  const AnalogueGains gains = analogue_gains(controller, encoder);
  const double analogue = (plant.presliding_damping + gains.kd) * (stiffness + gains.kp) / plant.inertia;
  return analogue * fine_resolution(encoder) * sample_time(controller) / 2.0;
}

IntegralGainBounds integral_gain_bounds(const PlantParameters& plant, const FrictionParameters& contact,
                                        const EncoderParameters& encoder,
                                        const ControllerParameters& controller) {
  return {critical_integral_gain(contact.k1, plant, encoder, controller),
          critical_integral_gain(contact.k1 + contact.k2, plant, encoder, controller)};
}

double lowest_k1(const FrictionAlongRotor& friction) {
  double lowest = friction.uniform.k1;
  for (const ProfiledParameter& entry : friction.profiled) {
    if (entry.parameter == &FrictionParameters::k1) lowest = range_over_revolution(*entry.profile).low;
  }
  return lowest;
}

double dac_resolution_bound(double k1, const EncoderParameters& encoder, EncoderChoice feedback) {
  return k1 * (feedback == EncoderChoice::fine ? fine_resolution(encoder) : coarse_resolution(encoder));
}

double natural_frequency(double stiffness, const PlantParameters& plant) {
  return std::sqrt(stiffness / plant.inertia) / (2.0 * std::numbers::pi);
}

double advised_sample_rate(const PlantParameters& plant, const FrictionParameters& contact) {
  return 10.0 * natural_frequency(contact.k1 + contact.k2, plant);
}

}  // namespace zerocount
