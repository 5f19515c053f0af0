#pragma once

#include "core/theory/frozen_loop.hpp"
#include "core/theory/margins.hpp"

/// Frozen (linearised) loops from parameters, for the tests.
namespace zerocount::theory {

/// The margins of the loop about a spring of `stiffness` (N m/rad) with this damping (N m s/rad).
inline StabilityMargins margins_about(double stiffness, double damping, const motion::PlantParameters& plant,
                                      const loop::EncoderParameters& encoder,
                                      const loop::ControllerParameters& controller,
                                      const LinearDrive& drive = {}) {
  return stability_margins(frozen_loop(stiffness, damping, plant, encoder, controller, drive));
}

/// The loop while the rotor slides under its sliding damping.
inline FrozenLoop sliding_loop(const motion::PlantParameters& plant, const loop::EncoderParameters& encoder,
                               const loop::ControllerParameters& controller, const LinearDrive& drive = {}) {
  return frozen_loop(0.0, plant.sliding_damping, plant, encoder, controller, drive);
}

inline GainCrossover sliding_crossover(const motion::PlantParameters& plant,
                                       const loop::EncoderParameters& encoder,
                                       const loop::ControllerParameters& controller,
                                       const LinearDrive& drive = {}) {
  return gain_crossover(sliding_loop(plant, encoder, controller, drive));
}

inline bool stable_while_sliding(const motion::PlantParameters& plant, const loop::EncoderParameters& encoder,
                                 const loop::ControllerParameters& controller,
                                 const LinearDrive& drive = {}) {
  return stability_of(sliding_loop(plant, encoder, controller, drive), 1.0) == LoopStability::stable;
}

}  // namespace zerocount::theory
