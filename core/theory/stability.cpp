#include "core/theory/stability.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <boost/math/tools/minima.hpp>

#include "core/theory/gains.hpp"

namespace zerocount {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;

double lowest_value(const Profile& profile) {
  const std::size_t harmonics = std::max(profile.cosine.size(), profile.sine.size());
  const std::size_t points = 16 * std::max<std::size_t>(harmonics, 4);
  const double spacing = turn / static_cast<double>(points);
  double lowest_angle = 0.0;
  double lowest = value_at(profile, lowest_angle);
  for (std::size_t i = 1; i < points; ++i) {
    const double angle = static_cast<double>(i) * spacing;
    if (const double value = value_at(profile, angle); value < lowest) {
      lowest = value;
      lowest_angle = angle;
    }
  }
  constexpr int bits = 26;  // of the angle; the value is flat there, so this is far more than it needs
  const auto refined =
      boost::math::tools::brent_find_minima([&profile](double angle) { return value_at(profile, angle); },
                                            lowest_angle - spacing, lowest_angle + spacing, bits);
  return std::min(lowest, refined.second);
}

}  // namespace

double critical_integral_gain(double stiffness, const PlantParameters& plant,
                              const EncoderParameters& encoder, const ControllerParameters& controller) {
  const AnalogueGains gains = analogue_gains(controller, encoder);
  const double analogue = (plant.presliding_damping + gains.kd) * (stiffness + gains.kp) / plant.inertia;
  return analogue * count_angle(encoder) * sample_time(controller) / 2.0;
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
    if (entry.parameter == &FrictionParameters::k1) lowest = lowest_value(*entry.profile);
  }
  return lowest;
}

double dac_resolution_bound(double k1, const EncoderParameters& encoder) {
  return k1 * count_angle(encoder);
}

double natural_frequency(double stiffness, const PlantParameters& plant) {
  return std::sqrt(stiffness / plant.inertia) / turn;
}

double advised_sample_rate(const PlantParameters& plant, const FrictionParameters& contact) {
  return 10.0 * natural_frequency(contact.k1 + contact.k2, plant);
}

}  // namespace zerocount
