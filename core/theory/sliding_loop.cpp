#include "core/theory/sliding_loop.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "core/loop/controller.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/linear_loop.hpp"

namespace zerocount::theory {
GainCrossover sliding_crossover(const motion::PlantParameters& plant, const loop::EncoderParameters& encoder,
                                const loop::ControllerParameters& controller, const LinearDrive& drive) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const double T = sample_time(controller);
  const HeldPlant held =
      hold_plant(0.0, plant.sliding_damping, plant, loop::fine_resolution(encoder), T, drive);
  const loop::LinearChain chain = loop::linear_chain(controller, loop::fine_resolution(encoder));
  const auto open_loop_at = [&](double angle) {
    return open_loop(std::polar(1.0, angle), held, chain, controller.delay);
  };
  const auto passes = [&](double angle) { return std::abs(open_loop_at(angle)) >= 1.0; };
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
  const std::complex<double> at = open_loop_at(low);
  return {low / (2.0 * std::numbers::pi * T), std::arg(-at) * 180.0 / std::numbers::pi};
}

bool stable_while_sliding(const motion::PlantParameters& plant, const loop::EncoderParameters& encoder,
                          const loop::ControllerParameters& controller, const LinearDrive& drive) {
  motion::PlantParameters sliding = plant;
  sliding.presliding_damping = plant.sliding_damping;
  return slowest_time_constant(0.0, sliding, encoder, controller, drive) <
         std::numeric_limits<double>::infinity();
}

}  // namespace zerocount::theory
