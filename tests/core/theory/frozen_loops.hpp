#pragma once

#include <utility>

#include "core/loop/controller/controller.hpp"
#include "core/numerics/dense.hpp"
#include "core/theory/frozen_loop.hpp"
#include "core/theory/margins.hpp"
#include "core/theory/stability.hpp"

/// Frozen (linearised) loops from parameters, for the tests.
namespace zerocount::theory {

/// The loop with one spring and one damper between rotor and frame.
/// @param stiffness, damping N m/rad and N m s/rad.
inline FrozenLoop frozen_loop(double stiffness, double damping, const motion::PlantParameters& plant,
                              const loop::EncoderParameters& encoder,
                              const loop::ControllerParameters& controller, const LinearDrive& drive = {}) {
  return frozen_loop(FrozenFriction{stiffness, damping}, plant, encoder, controller, drive);
}

/// The linearised loop while the contact sticks, on a spring of `stiffness` (N m/rad) with the pre-sliding
/// damping.
inline FrozenLoop presliding_loop(double stiffness, const motion::PlantParameters& plant,
                                  const loop::EncoderParameters& encoder,
                                  const loop::ControllerParameters& controller, const LinearDrive& drive) {
  return frozen_loop(stiffness, plant.presliding_damping, plant, encoder, controller, drive);
}

/// Time constant of the motion about a spring of `stiffness` (N m/rad) that dies out last, s. A slow integral
/// control has τ ≈ T·(k·Δx + kp)/(2·ki).
inline double slowest_time_constant(double stiffness, const motion::PlantParameters& plant,
                                    const loop::EncoderParameters& encoder,
                                    const loop::ControllerParameters& controller,
                                    const LinearDrive& drive = {}) {
  const FrozenLoop loop = presliding_loop(stiffness, plant, encoder, controller, drive);
  return slowest_time_constant(poles_of(loop), loop.sample_time);
}

/// Integral gain below which the loop about a spring of `stiffness` (N m/rad) is stable.
inline double sampled_critical_integral_gain(double stiffness, const motion::PlantParameters& plant,
                                             const loop::EncoderParameters& encoder,
                                             loop::ControllerParameters controller,
                                             const LinearDrive& drive = {}) {
  FrozenLoop loop = presliding_loop(stiffness, plant, encoder, controller, drive);
  const auto loop_with = [&](const loop::ControllerParameters& other) {
    loop.controller = loop::linear_chain(other, encoder);
    return loop;
  };
  const double scale = static_stiffness(stiffness, encoder, controller);
  return sampled_critical_integral_gain(loop_with, std::move(controller), scale);
}

/// The largest magnitude of the eigenvalues of the loop's map from sample to sample; the loop is stable if it
/// is below 1.
inline double spectral_radius(const HeldPlant& plant, const loop::LinearChain& controller) {
  return numerics::eigenvalues(loop_map(plant, controller)).cwiseAbs().maxCoeff();
}

/// Spectral radius of the linearised loop on a spring of `stiffness` (N m/rad), with the pre-sliding damping;
/// the loop is stable if it is below 1.
inline double sampled_spectral_radius(double stiffness, const motion::PlantParameters& plant,
                                      const loop::EncoderParameters& encoder,
                                      const loop::ControllerParameters& controller,
                                      const LinearDrive& drive = {}) {
  const FrozenLoop loop = presliding_loop(stiffness, plant, encoder, controller, drive);
  return spectral_radius(loop.plant, loop.controller);
}

/// The stability margins of the linearised loop on a spring of `stiffness` (N m/rad) with this damping (N m
/// s/rad).
inline StabilityMargins margins_about(double stiffness, double damping, const motion::PlantParameters& plant,
                                      const loop::EncoderParameters& encoder,
                                      const loop::ControllerParameters& controller,
                                      const LinearDrive& drive = {}) {
  return stability_margins(frozen_loop(stiffness, damping, plant, encoder, controller, drive));
}

/// The linearised loop while the rotor slides, with the sliding damping.
inline FrozenLoop sliding_loop(const motion::PlantParameters& plant, const loop::EncoderParameters& encoder,
                               const loop::ControllerParameters& controller, const LinearDrive& drive = {}) {
  return frozen_loop(0.0, plant.sliding_damping, plant, encoder, controller, drive);
}

inline GainCrossover sliding_crossover(const motion::PlantParameters& plant,
                                       const loop::EncoderParameters& encoder,
                                       const loop::ControllerParameters& controller,
                                       const LinearDrive& drive = {}) {
  return stability_margins(sliding_loop(plant, encoder, controller, drive)).crossover;
}

inline bool stable_while_sliding(const motion::PlantParameters& plant, const loop::EncoderParameters& encoder,
                                 const loop::ControllerParameters& controller,
                                 const LinearDrive& drive = {}) {
  return stability_of(sliding_loop(plant, encoder, controller, drive), 1.0) == LoopStability::stable;
}

}  // namespace zerocount::theory
