#include "core/theory/frozen_loop.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
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

/// Growth per sample, ln max|z|, of the motion that grows fastest or dies out last, from the poles z of the
/// loop.
double growth_of(const Eigen::VectorXcd& poles) {
  return std::log(poles.cwiseAbs().maxCoeff());
}

/// The linear description of a controller with these input signals held constant, so that the paths from them
/// are removed.
loop::LinearChain without(loop::LinearChain chain, std::initializer_list<loop::LoopSignal> constant) {
  for (loop::LinearBlock& block : chain) {
    std::erase_if(block, [&](const loop::SignalPath& path) {
      return std::ranges::find(constant, path.from) != constant.end();
    });
  }
  return chain;
}

}  // namespace

FrozenLoop frozen_loop(const FrozenFriction& friction, const motion::PlantParameters& plant,
                       const loop::EncoderParameters& encoder, const loop::ControllerParameters& controller,
                       const LinearDrive& drive) {
  const double T = sample_time(controller);
  const double resolution = loop::fine_resolution(encoder);
  HeldPlant held = hold_plant(friction, plant, resolution, T, drive, controller.delay);
  if (controller.velocity_by_other) held.other_per_count = resolution / loop::other_resolution(encoder);
  return {held, loop::linear_chain(controller, encoder), T};
}

std::optional<FrozenLoop> loop_of_motor_alone(const FrozenFriction& friction,
                                              const motion::PlantParameters& plant,
                                              const loop::EncoderParameters& encoder,
                                              const loop::ControllerParameters& controller,
                                              const LinearDrive& drive) {
  using loop::LoopSignal;
  const double T = sample_time(controller);
  const loop::LinearChain chain = loop::linear_chain(controller, encoder);
  motion::PlantParameters motor = plant;
  motor.load.inertia = 0.0;
  const auto held = [&](double resolution) {
    return hold_plant(friction, motor, resolution, T, drive, controller.delay);
  };
  const bool reads_load = motion::has_load(plant) && plant.load.encoder == motion::EncoderPlace::load;
  if (!reads_load) {
    return FrozenLoop{held(loop::fine_resolution(encoder)),
                      controller.velocity_by_other ? without(chain, {LoopSignal::velocity_count}) : chain, T};
  }
  if (!controller.velocity_by_other) return std::nullopt;
  return FrozenLoop{held(loop::other_resolution(encoder)),
                    without(chain, {LoopSignal::error, LoopSignal::count}), T, false};
}

OpenLoop open_loop(const FrozenLoop& loop) {
  return {loop.plant, loop.controller};
}

Eigen::VectorXcd poles_of(const FrozenLoop& loop) {
  Eigen::VectorXcd poles = numerics::eigenvalues(loop_map(loop.plant, loop.controller));
  if (loop.closes_position) return poles;
  Eigen::Index free = 0;
  const double distance = (poles.array() - 1.0).abs().minCoeff(&free);
  if (!(distance < rounding_of_double_pole)) return poles;
  poles[free] = 0.0;
  return poles;
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
  constexpr double gone_at_once = 1e-6;    // |z| of eigenvalues that are 0 up to rounding
  constexpr double rounding_of_1 = 1e-13;  // of the logarithm of an eigenvalue of exactly 1
  const double growth = growth_of(poles);
  if (growth > -rounding_of_1) return std::numeric_limits<double>::infinity();
  return growth > std::log(gone_at_once) ? -sample_time / growth : 0.0;
}

}  // namespace zerocount::theory
