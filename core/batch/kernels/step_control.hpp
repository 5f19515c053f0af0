#pragma once

#include "core/batch/kernels/simd.hpp"

/// Step control of all motions.
namespace zerocount::batch {

/// The step h, or half of the time to the stop where h would leave only a little of it.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P without_short_remainder(const P& h, const P& time_to_stop) {
  return select((h < time_to_stop) & (time_to_stop < P(1.4) * h), time_to_stop * P(0.5), h);
}

/// The step after one of h (s) that was too long: by `factor`, which its truncation error suggests, or half
/// of h where it was too long for another reason than being `inexact`.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P shorter_step(const P& h, const typename P::Mask& inexact, const P& factor) {
  return select(inexact, h * min(max(factor, P(0.05)), P(0.8)), h * P(0.5));
}

}  // namespace zerocount::batch
