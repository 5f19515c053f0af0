#pragma once

#include "core/batch/batch_state.hpp"
#include "core/batch/lanes.hpp"

namespace zerocount::batch {

/// The lanes of one pack. Where enough of a list's next lanes lie side by side the pack is that stretch of
/// the batch state, with some of its lanes not taking part; otherwise they are collected from wherever they
/// are.
template <class P>
class LaneGroup {
 public:
  /// The lanes from number `first` of the list on, as many as go into one pack.
  ZEROCOUNT_ALWAYS_INLINE LaneGroup(const LaneList& list, int first,
                                    int least_side_by_side = P::lanes / 2 > 1 ? P::lanes / 2 : 1) {
    base_ = list.lanes[first] / P::lanes * P::lanes;
    used_ = 0;
    unsigned side_by_side = 0;
    while (first + used_ < list.count && list.lanes[first + used_] < base_ + P::lanes) {
      side_by_side |= 1U << (list.lanes[first + used_] - base_);
      ++used_;
    }
    stretch_ = used_ >= least_side_by_side;
    if (stretch_) {
      taking_part_ = side_by_side;
      for (int i = 0; i < P::lanes; ++i) lane_[i] = base_ + i;
    } else {
      const int rest = list.count - first;
      used_ = rest < P::lanes ? rest : P::lanes;
      taking_part_ = (1U << used_) - 1U;
      for (int i = 0; i < P::lanes; ++i) lane_[i] = i < used_ ? list.lanes[first + i] : spare_lane;
    }
  }

  /// Number of lanes of the list in this group.
  ZEROCOUNT_ALWAYS_INLINE int used() const { return used_; }

  ZEROCOUNT_ALWAYS_INLINE typename P::Mask taking_part() const { return P::Mask::of_bits(taking_part_); }

  ZEROCOUNT_ALWAYS_INLINE P load(const double* of) const {
    P r;
    if (stretch_) {
      __builtin_memcpy(&r, of + base_, sizeof r);
    } else {
      gather(of, r);
    }
    return r;
  }

  ZEROCOUNT_ALWAYS_INLINE void store(double* to, const P& value) const {
    if (stretch_) {
      value.store(to + base_, taking_part());
    } else {
      scatter(to, value);
    }
  }

  /// Adds the lanes whose `events` are not 0 to the batch state.
  ZEROCOUNT_ALWAYS_INLINE void add_events_to(BatchState& batch, const P& events) const {
    const typename P::Mask noted = (events != P(0.0)) & taking_part();
    if (noted.any()) append_events(batch, events, noted.bits());
  }

  ZEROCOUNT_ALWAYS_INLINE int lane(int i) const { return lane_[i]; }

 private:
  // Not inlined: the code of dozens of them would push the kernel out of the instruction cache.
  __attribute__((noinline)) void gather(const double* of, P& to) const {
    constexpr int width = sizeof(to.part[0]) / sizeof(double);
    for (int p = 0; p < P::lanes / width; ++p) to.part[p] = collect<width>(of, lane_ + p * width);
  }
  /// Not by way of memory: a vector read where single numbers have just been written waits for them.
  template <int Width>
  static ZEROCOUNT_ALWAYS_INLINE auto collect(const double* of, const int* lane) {
    using Real = typename VectorOf<Width>::Real;
    if constexpr (Width == 8) {
      return Real{of[lane[0]], of[lane[1]], of[lane[2]], of[lane[3]],
                  of[lane[4]], of[lane[5]], of[lane[6]], of[lane[7]]};
    } else if constexpr (Width == 4) {
      return Real{of[lane[0]], of[lane[1]], of[lane[2]], of[lane[3]]};
    } else {
      static_assert(Width == 2);
      return Real{of[lane[0]], of[lane[1]]};
    }
  }
  __attribute__((noinline)) void scatter(double* to, const P& from) const {
    double value[P::lanes];
    __builtin_memcpy(value, &from, sizeof value);
    for (int i = 0; i < P::lanes; ++i) to[lane_[i]] = value[i];
  }

  __attribute__((noinline)) void append_events(BatchState& batch, const P& events, unsigned noted) const {
    double value[P::lanes];
    __builtin_memcpy(value, &events, sizeof value);
    for (; noted != 0; noted &= noted - 1) {
      const int i = __builtin_ctz(noted);
      batch.events[lane_[i]] = static_cast<int>(value[i]);
      batch.event_lanes[batch.event_count++] = lane_[i];
    }
  }

  int base_;
  int used_;
  bool stretch_;
  unsigned taking_part_;  ///< one bit a lane of the pack
  int lane_[P::lanes];
};

/// For for_each_measure: between lanes and packs.
template <class P>
struct LoadEach {
  const LaneGroup<P>& at;
  ZEROCOUNT_ALWAYS_INLINE void operator()(P& to, const double* from) const { to = at.load(from); }
};
template <class P>
struct StoreEach {
  const LaneGroup<P>& at;
  ZEROCOUNT_ALWAYS_INLINE void operator()(double* to, const P& from) const { at.store(to, from); }
};

/// A mask as 0 or 1, and back.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P to_number(const typename P::Mask& mask) {
  return select(mask, P(1.0), P(0.0));
}
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask to_mask(const P& number) {
  return number != P(0.0);
}
/// `note` where true.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P events_where(const typename P::Mask& mask, LaneEvent note) {
  return select(mask, P(static_cast<double>(note)), P(0.0));
}

}  // namespace zerocount::batch
