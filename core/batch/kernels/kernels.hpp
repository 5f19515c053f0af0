#pragma once

#include "core/batch/kernels/batch_state.hpp"

namespace zerocount::batch {

/// The kernels that move the lanes.
struct MotionKernels {
  void (*stick_start)(BatchState&, const LaneSet&);          ///< null where all torques vary
  void (*stick_start_varying)(BatchState&, const LaneSet&);  ///< null where none varies
  void (*stick_step)(BatchState&, const LaneSet&);
  void (*stick_event)(BatchState&, const LaneSet&);  ///< a step that locates its events
  void (*slide_fast)(BatchState&, const LaneSet&);
  void (*slide_slow)(BatchState&, const LaneSet&);
  LaneSet (*bristle_rest)(BatchState&, const LaneSet&);  ///< null where all torques vary
  void (*bristle_fast)(BatchState&, const LaneSet&);
  void (*bristle_slow)(BatchState&, const LaneSet&);
  LaneSet (*elements_rest)(BatchState&, const LaneSet&);  ///< null where all torques vary
  void (*elements)(BatchState&, const LaneSet&);
  void (*free)(BatchState&, const LaneSet&);
  void (*stand)(BatchState&, const LaneSet&);
};

/// The kernels, compiled for one instruction set.
struct Kernels {
  LaneSet (*lanes_at_stop)(const BatchState&);  ///< and those without a trial
  LaneSet (*fast_lanes)(const BatchState&);     ///< faster than ContactLanes::fast_velocity
  LaneSet (*creep_ahead)(BatchState&, const LaneSet&);
  LaneSet (*noisy_rest)(BatchState&, const LaneSet&, const LaneSet& active, int max_samples);
  void (*sample)(BatchState&, const LaneSet&);         ///< with the PID law alone
  void (*sample_blocks)(BatchState&, const LaneSet&);  ///< with the blocks of the controller
  void (*sample_noisy)(BatchState&, const LaneSet&);   ///< the same with a noisy encoder
  void (*sample_noisy_blocks)(BatchState&, const LaneSet&);
  void (*sample_given)(BatchState&, const LaneSet&);  ///< what LaneLoop has decided
  MotionKernels constant;                             ///< of lanes whose torque stays
  MotionKernels varying;                              ///< of lanes whose torque varies
  MotionKernels loaded;                               ///< of those with a second mass: whose torque stays
  MotionKernels loaded_driven;                        ///< and whose torque may vary
  LaneSet (*drive)(BatchState&, const LaneSet&);
  void (*course)(BatchState&, const LaneSet&);
};

enum class InstructionSet;

const Kernels& kernels_of(InstructionSet instructions);

extern const Kernels portable_kernels;
extern const Kernels avx2_kernels;
extern const Kernels avx512_kernels;

}  // namespace zerocount::batch
