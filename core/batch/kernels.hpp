#pragma once

#include "core/batch/batch_state.hpp"

namespace zerocount::batch {

/// The kernels, compiled for one instruction set.
struct Kernels {
  int (*list)(const BatchState&, double state, bool due, int* list);
  void (*sample)(BatchState&, LaneList);
  void (*stick_start)(BatchState&, LaneList);
  void (*stick_step)(BatchState&, LaneList);
  void (*stick_event)(BatchState&, LaneList);  ///< a step that may have events
  void (*slide_fast)(BatchState&, LaneList);
  void (*slide_slow)(BatchState&, LaneList);
};

extern const Kernels portable_kernels;
#ifdef ZEROCOUNT_X86_KERNELS
extern const Kernels avx2_kernels;
extern const Kernels avx512_kernels;
#endif

}  // namespace zerocount::batch
