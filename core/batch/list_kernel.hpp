#pragma once

#include "core/batch/batch_state.hpp"
#include "core/batch/lanes.hpp"

namespace zerocount::batch {

/// Lists the lanes in `state`, or in any state but idle where `state` is any_state, that are at a sampling
/// instant (`due`), or that are not. @param list [max_lanes]. @returns the number of lanes.
template <class P>
int list_kernel(const BatchState& batch, double state, bool due, int* list) {
  static_assert(max_lanes % P::lanes == 0);
  const P wanted(state);
  const P zero(0.0);
  int count = 0;
  for (int base = 0; base < max_lanes; base += P::lanes) {
    P time;
    P present;
    __builtin_memcpy(&time, batch.time.time_to_stop + base, sizeof time);
    __builtin_memcpy(&present, batch.state + base, sizeof present);
    const typename P::Mask at_stop = time == zero;
    const typename P::Mask in_state = state == any_state ? present != P(idle) : present == wanted;
    for (unsigned lanes = (in_state & (due ? at_stop : ~at_stop)).bits(); lanes != 0; lanes &= lanes - 1) {
      list[count++] = base + __builtin_ctz(lanes);
    }
  }
  return count;
}

}  // namespace zerocount::batch
