#pragma once

#include "core/batch/tile.hpp"

namespace zerocount::batch {

/// The kernels, compiled for one instruction set.
struct Kernels {
  void (*sample)(Tile&, LaneList);
  void (*stick_start)(Tile&, LaneList);
  void (*stick_step)(Tile&, LaneList);
  void (*stick_event)(Tile&, LaneList);  ///< a step that may have events
  void (*slide_fast)(Tile&, LaneList);
  void (*slide_slow)(Tile&, LaneList);
};

extern const Kernels portable_kernels;
#ifdef ZEROCOUNT_X86_KERNELS
extern const Kernels avx2_kernels;
extern const Kernels avx512_kernels;
#endif

}  // namespace zerocount::batch
