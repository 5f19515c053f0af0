#include "core/theory/move_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/loop/encoder.hpp"
#include "core/numerics/roots.hpp"
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

double shortest_move(const DrivenAxis& axis, double distance) {
  if (!(axis.driving > 0.0) || !(axis.braking > 0.0)) return std::numeric_limits<double>::infinity();
  if (!(distance > 0.0)) return 0.0;
  const double undamped =
      std::sqrt(2.0 * distance * axis.inertia * (1.0 / axis.driving + 1.0 / axis.braking));
  // The closed forms divide by c: less than this changes the time by less than 1e-5.
  const double c = std::max(axis.damping, 1e-5 * axis.inertia / undamped);
  const double tau = axis.inertia / c;
  const double terminal = axis.driving / c;
  struct Path {
    double time, travel;
  };
  const auto with_driving_time = [&](double driven) -> Path {
    const double velocity = -terminal * std::expm1(-driven / tau);
    const double braked = tau * std::log1p(velocity * c / axis.braking);
    const double driven_travel = terminal * (driven + tau * std::expm1(-driven / tau));
    const double braked_travel = axis.braking / c * (tau * std::expm1(braked / tau) - braked);
    return {driven + braked, driven_travel + braked_travel};
  };
  double enough = undamped;
  while (with_driving_time(enough).travel < distance) enough *= 2.0;
  const auto reaches = [&](double driven) { return with_driving_time(driven).travel >= distance; };
  return with_driving_time(numerics::bisect({enough, 0.0}, reaches, numerics::after_halvings(50)).holds).time;
}

}  // namespace zerocount::theory
