#pragma once

#include "core/batch/kernels/batch_state.hpp"

namespace zerocount::batch {

/// Function pointers to the inner loops (kernels) of the batch engine, compiled for one instruction set.
struct Kernels {
  using Move = void (*)(BatchState&, const LaneSet&, Forcing);
  using Rest = LaneSet (*)(BatchState&, const LaneSet&, Forcing);
  LaneSet (*lanes_at_stop)(const BatchState&);  ///< Returns the lanes that have reached a sampling instant,
                                                ///< and those without a trial.
  LaneSet (*fast_lanes)(const BatchState&);     ///< Returns the lanes whose rotor is faster than
                                                ///< ContactLanes::fast_velocity.
  LaneSet (*creep_ahead)(BatchState&, const LaneSet&);
  LaneSet (*noisy_rest)(BatchState&, const LaneSet&, const LaneSet& active, int max_samples);
  void (*sample)(BatchState&, const LaneSet&);         ///< Processes one sampling instant: controller with
                                                       ///< the PID law alone.
  void (*sample_blocks)(BatchState&, const LaneSet&);  ///< Processes one sampling instant: controller with
                                                       ///< blocks beyond the PID law.
  /// Processes one sampling instant: PID law alone, encoder with noise.
  void (*sample_noisy)(BatchState&, const LaneSet&);
  void (*sample_noisy_blocks)(BatchState&, const LaneSet&);
  void (*sample_given)(BatchState&, const LaneSet&);  ///< Processes one sampling instant with the torque that
                                                      ///< each lane's LaneLoop has decided.
  Move stick_start;
  Move stick_step;
  Move stick_event;  ///< Integration step of a sticking hook that locates the first event and ends there.
  Move slide_fast;
  Move slide_slow;
  Rest bristle_rest;
  Move bristle_fast;
  Move bristle_slow;
  Rest elements_rest;
  Move elements;
  void (*free)(BatchState&, const LaneSet&, bool varies);
  Move free_loaded;
  void (*stand)(BatchState&, const LaneSet&);
  Move stand_forced;
  LaneSet (*drive)(BatchState&, const LaneSet&);
  void (*course)(BatchState&, const LaneSet&);
};

enum class InstructionSet;

const Kernels& kernels_of(InstructionSet instructions);

extern const Kernels portable_kernels;
extern const Kernels avx2_kernels;
extern const Kernels avx512_kernels;

}  // namespace zerocount::batch
