#pragma once

#include "core/batch/kernels/batch_state.hpp"
#include "core/batch/kernels/lane_group.hpp"

namespace zerocount::batch {

/// The set of lanes for which `mask_of` is true.
/// @param mask_of gives the mask of the consecutive lanes of one vector.
template <class P, class MaskOf>
ZEROCOUNT_ALWAYS_INLINE LaneSet lanes_where(MaskOf mask_of) {
  static_assert(max_lanes % P::lanes == 0);
  LaneSet set;
  constexpr unsigned all = (1U << P::lanes) - 1U;
  for (int base = 0; base < max_lanes; base += P::lanes)
    set.insert_stretch(base, mask_of(LaneStretch<P>(base, all)).bits());
  return set;
}

/// The lanes that are at a sampling instant, and those without a trial.
template <class P>
LaneSet lanes_at_stop_kernel(const BatchState& batch) {
  return lanes_where<P>([&](const auto& at) __attribute__((always_inline)) {
    return at.load(batch.time.time_to_stop) == P(0.0);
  });
}

/// The lanes whose rotor moves faster than ContactLanes::fast_velocity, so that its friction is Coulomb
/// friction.
template <class P>
LaneSet fast_lanes_kernel(const BatchState& batch) {
  return lanes_where<P>([&](const auto& at) __attribute__((always_inline)) {
    return abs(at.load(batch.motion.omega)) > at.load(batch.contact.fast_velocity);
  });
}

}  // namespace zerocount::batch
