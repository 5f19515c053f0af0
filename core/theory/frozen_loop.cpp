#include "core/theory/frozen_loop.hpp"

#include "core/loop/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/linear_loop.hpp"

namespace zerocount::theory {

FrozenLoop frozen_loop(double stiffness, double damping, const motion::PlantParameters& plant,
                       const loop::EncoderParameters& encoder, const loop::ControllerParameters& controller,
                       const LinearDrive& drive) {
  const double T = sample_time(controller);
  const double resolution = loop::fine_resolution(encoder);
  return {hold_plant(stiffness, damping, plant, resolution, T, drive, controller.delay),
          loop::linear_chain(controller, resolution), T};
}

std::complex<double> open_loop(const FrozenLoop& loop, double angle) {
  return open_loop(std::polar(1.0, angle), loop.plant, loop.controller);
}

LoopStability stability_of(const FrozenLoop& loop) {
  const double radius = spectral_radius(loop.plant, loop.controller);
  if (radius < 1.0 - edge_of_stability) return LoopStability::stable;
  return radius <= 1.0 + edge_of_stability ? LoopStability::marginal : LoopStability::unstable;
}

}  // namespace zerocount::theory
