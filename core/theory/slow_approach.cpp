#include "core/theory/slow_approach.hpp"

#include <algorithm>
#include <cmath>

#include "core/loop/encoder.hpp"
#include "core/theory/stability.hpp"

namespace zerocount::theory {

double slow_time_constant(double stiffness, const loop::EncoderParameters& encoder,
                          const loop::ControllerParameters& controller) {
  return (stiffness * loop::fine_resolution(encoder) + controller.kp) /
         (2.0 * controller.ki * controller.sample_rate);
}

double slow_arrival_time(std::int64_t step, const friction::FrictionParameters& contact,
                         const loop::EncoderParameters& encoder,
                         const loop::ControllerParameters& controller) {
  // The midpoint rule in ln e.
  constexpr int parts = 64;
  const auto counts = static_cast<double>(step);
  const double width = std::log(2.0 * counts) / parts;
  double time = 0.0;
  for (int i = 0; i < parts; ++i) {
    const double error = 0.5 * std::exp((i + 0.5) * width);
    const double travel = loop::fine_resolution(encoder) * (counts - error);
    const double stiffness = contact.k1 + contact.k2 * std::exp(-contact.beta * std::max(0.0, travel));
    time += width * slow_time_constant(stiffness, encoder, controller);
  }
  return time;
}

double chatter_time(const motion::PlantParameters& plant, const friction::FrictionParameters& contact,
                    const loop::ControllerParameters& controller, double dwell) {
  const double frequency = natural_frequency(contact.k1 + contact.k2, plant);
  const double decays = std::max(0.0, std::log(frequency * dwell));
  return controller.kp / (2.0 * controller.ki * controller.sample_rate) * decays;
}

}  // namespace zerocount::theory
