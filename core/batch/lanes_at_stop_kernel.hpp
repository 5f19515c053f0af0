#pragma once

#include "core/batch/batch_state.hpp"
#include "core/batch/lanes.hpp"

namespace zerocount::batch {

/// The lanes that are at a sampling instant, and those without a trial.
template <class P>
LaneSet lanes_at_stop_kernel(const BatchState& batch) {
  static_assert(max_lanes % P::lanes == 0);
  const P zero(0.0);
  LaneSet set;
  for (int base = 0; base < max_lanes; base += P::lanes) {
    P time;
    __builtin_memcpy(&time, batch.time.time_to_stop + base, sizeof time);
    set.insert_stretch(base, (time == zero).bits());
  }
  return set;
}

}  // namespace zerocount::batch
