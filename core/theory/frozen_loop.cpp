#include "core/theory/frozen_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/loop/controller/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/numerics/dense.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/linear_loop.hpp"

namespace zerocount::theory {
namespace {

constexpr double noticeable_change = 1e-3;        // of a motion within the hold
constexpr double rounding_of_double_pole = 2e-8;  // of a double eigenvalue of exactly 1

/// Growth per sample of the motion that grows fastest or dies out last: ln max|z|.
double growth_of(const Eigen::VectorXcd& poles) {
  return std::log(poles.cwiseAbs().maxCoeff());
}

}  // namespace

FrozenLoop frozen_loop(double stiffness, double damping, const motion::PlantParameters& plant,
                       const loop::EncoderParameters& encoder, const loop::ControllerParameters& controller,
                       const LinearDrive& drive) {
  const double T = sample_time(controller);
  const double resolution = loop::fine_resolution(encoder);
  HeldPlant held = hold_plant(stiffness, damping, plant, resolution, T, drive, controller.delay);
  if (controller.velocity_by_other) held.other_per_count = resolution / loop::other_resolution(encoder);
  return {held, loop::linear_chain(controller, encoder), T};
}

OpenLoop open_loop(const FrozenLoop& loop) {
  return {loop.plant, loop.controller};
}

Eigen::VectorXcd poles_of(const FrozenLoop& loop) {
  return numerics::eigenvalues(loop_map(loop.plant, loop.controller));
}

LoopStability stability_of(const Eigen::VectorXcd& poles, double sample_time, double hold) {
  const double growth = growth_of(poles);
  const double samples = hold / sample_time;
  if (growth * samples < -noticeable_change) return LoopStability::stable;
  const bool grows = growth > rounding_of_double_pole && growth * samples > noticeable_change;
  return grows ? LoopStability::unstable : LoopStability::marginal;
}

LoopStability stability_of(const FrozenLoop& loop, double hold) {
  return stability_of(poles_of(loop), loop.sample_time, hold);
}

double log_growth(const FrozenLoop& loop, double hold) {
  return growth_of(poles_of(loop)) * hold / loop.sample_time;
}

double slowest_time_constant(const Eigen::VectorXcd& poles, double sample_time) {
  constexpr double gone_at_once = 1e-6;  // eigenvalues that are 0 up to rounding
  double slowest = 0.0;
  for (const auto& z : poles) {
    if (z.imag() == 0.0) slowest = std::max(slowest, z.real());
  }
  if (growth_of(poles) > rounding_of_double_pole || slowest >= 1.0)
    return std::numeric_limits<double>::infinity();
  return slowest > gone_at_once ? -sample_time / std::log(slowest) : 0.0;
}

}  // namespace zerocount::theory
