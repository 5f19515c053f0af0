#pragma once

#include "core/batch/kernels/batch_state.hpp"
#include "core/batch/kernels/simd.hpp"

namespace zerocount::batch {

/// Consecutive lanes of the batch state that fill one vector. A mask says which of them take part in an
/// operation.
template <class P>
class LaneStretch {
 public:
  using Vector = P;
  LaneStretch(int base, unsigned taking_part) : base_(base), taking_part_(taking_part) {}

  ZEROCOUNT_ALWAYS_INLINE typename P::Mask taking_part() const { return P::Mask::of_bits(taking_part_); }
  ZEROCOUNT_ALWAYS_INLINE int lane(int i) const { return base_ + i; }
  ZEROCOUNT_ALWAYS_INLINE P load(const double* of) const {
    P r;
    __builtin_memcpy(&r, of + base_, sizeof r);
    return r;
  }
  ZEROCOUNT_ALWAYS_INLINE void store(double* to, const P& value) const {
    value.store(to + base_, taking_part());
  }

 private:
  int base_;
  unsigned taking_part_;  ///< Lanes that take part: one bit for each lane of the vector
};

/// Lanes from arbitrary positions of the batch state, gathered into one vector. Missing lanes are filled up
/// with the spare lane. The constructor removes the gathered lanes from the set.
template <class P>
class LaneCollection {
 public:
  using Vector = P;
  explicit LaneCollection(LaneSet& lanes) : taking_part_(0) {
    for (int i = 0; i < P::lanes; ++i) {
      lane_[i] = spare_lane;
      if (lanes.empty()) continue;
      lane_[i] = lanes.first();
      lanes.erase(lane_[i]);
      taking_part_ |= 1U << i;
    }
  }

  ZEROCOUNT_ALWAYS_INLINE typename P::Mask taking_part() const { return P::Mask::of_bits(taking_part_); }
  ZEROCOUNT_ALWAYS_INLINE int lane(int i) const { return lane_[i]; }
  ZEROCOUNT_ALWAYS_INLINE P load(const double* of) const {
    P r;
    gather(of, r);
    return r;
  }
  ZEROCOUNT_ALWAYS_INLINE void store(double* to, const P& value) const { scatter(to, value); }

 private:
  // Not inlined: dozens of copies would push the kernel out of the instruction cache.
  __attribute__((noinline)) void gather(const double* of, P& to) const {
    constexpr int width = sizeof(to.part[0]) / sizeof(double);
    for (int p = 0; p < P::lanes / width; ++p) to.part[p] = collect<width>(of, lane_ + p * width);
  }
  /// Gathers the values of several lanes into a vector register. A detour through memory would be slower,
  /// because a vector load waits for the scalar stores before it.
  /// @param of one value per lane.
  /// @param lane indices of the lanes.
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

  unsigned taking_part_;  ///< Lanes that take part: one bit for each lane of the vector
  int lane_[P::lanes];
};

/// Either consecutive lanes (LaneStretch) or gathered ones (LaneCollection), as one type. One compiled kernel
/// serves both, which halves the compile time but costs a branch at each access.
template <class P>
class LaneGroup : public LaneStretch<P> {
 public:
  explicit LaneGroup(const LaneStretch<P>& stretch) : LaneStretch<P>(stretch) {}
  explicit LaneGroup(const LaneCollection<P>& collection)
      : LaneStretch<P>(0, collection.taking_part().bits()), collection_(&collection) {}

  ZEROCOUNT_ALWAYS_INLINE int lane(int i) const {
    return collection_ == nullptr ? LaneStretch<P>::lane(i) : collection_->lane(i);
  }
  ZEROCOUNT_ALWAYS_INLINE P load(const double* of) const {
    return collection_ == nullptr ? LaneStretch<P>::load(of) : collection_->load(of);
  }
  ZEROCOUNT_ALWAYS_INLINE void store(double* to, const P& value) const {
    collection_ == nullptr ? LaneStretch<P>::store(to, value) : collection_->store(to, value);
  }

 private:
  const LaneCollection<P>* collection_ = nullptr;  ///< The gathered lanes; null: the lanes are consecutive
};

/// Vector types of a kernel. Wide consists of `Chains` vectors that are processed side by side, for many
/// lanes; Narrow is one vector, for few.
template <int Width, int Chains>
struct Vectors {
  using Wide = Simd<Width, Chains>;
  using Narrow = Simd<Width, 1>;
};

/// Calls `work` for the lanes of the set in groups of consecutive lanes (LaneStretch). A group whose lanes
/// all lie in one half is passed as a narrower vector.
template <class V, class Work>
ZEROCOUNT_ALWAYS_INLINE void for_each_stretch(const LaneSet& lanes, Work work) {
  using Wide = typename V::Wide;
  using Narrow = typename V::Narrow;
  static_assert(Wide::lanes == 2 * Narrow::lanes);
  for (int base = 0; base < max_lanes; base += Wide::lanes) {
    const unsigned lower = lanes.stretch(base, Narrow::lanes);
    const unsigned upper = lanes.stretch(base + Narrow::lanes, Narrow::lanes);
    if (lower != 0 && upper != 0) {
      work(LaneStretch<Wide>(base, lower | upper << Narrow::lanes));
    } else if (lower != 0) {
      work(LaneStretch<Narrow>(base, lower));
    } else if (upper != 0) {
      work(LaneStretch<Narrow>(base + Narrow::lanes, upper));
    }
  }
}

/// Calls `work` for all lanes of the set in vectors. Consecutive lanes are passed as LaneStretch if at least
/// half of them are in the set. The other lanes are gathered and passed as LaneCollection, the last few of
/// them as narrow vectors.
template <class V, class Work>
ZEROCOUNT_ALWAYS_INLINE void for_each_vector(LaneSet lanes, Work work) {
  using Wide = typename V::Wide;
  using Narrow = typename V::Narrow;
  const auto dense = [&]<class P>(int base) {
    const unsigned here = lanes.stretch(base, P::lanes);
    const bool enough = 2 * __builtin_popcount(here) >= P::lanes;
    if (enough) {
      work(LaneStretch<P>(base, here));
      lanes.erase_stretch(base, here);
    }
  };
  for (int base = 0; base < max_lanes; base += Wide::lanes) dense.template operator()<Wide>(base);
  while (lanes.count() > Narrow::lanes) work(LaneCollection<Wide>(lanes));
  if (lanes.empty()) return;
  dense.template operator()<Narrow>(lanes.first() / Narrow::lanes * Narrow::lanes);
  if (!lanes.empty()) work(LaneCollection<Narrow>(lanes));
}

/// Calls `work` for all lanes of the set as LaneGroup. Consecutive lanes are passed as they are if at least
/// half of them are in the set; the other lanes are gathered.
template <class P, class Work>
ZEROCOUNT_ALWAYS_INLINE void for_each_group(LaneSet lanes, Work work) {
  int base = 0;
  while (!lanes.empty()) {
    unsigned here = 0;
    while (base < max_lanes && 2 * __builtin_popcount(here = lanes.stretch(base, P::lanes)) < P::lanes)
      base += P::lanes;
    if (base < max_lanes) {
      lanes.erase_stretch(base, here);
      work(LaneGroup<P>(LaneStretch<P>(base, here)));
    } else {
      work(LaneGroup<P>(LaneCollection<P>(lanes)));
    }
  }
}

/// Calls `work` with vectors of lanes and the type of their forcing. Without a forcing, the vectors are made
/// as by for_each_vector(lanes, work), and the forcing is Unforced. Otherwise the lanes are passed as
/// LaneGroup.
template <class V, class Work>
ZEROCOUNT_ALWAYS_INLINE void for_each_vector(const LaneSet& lanes, Forcing forcing, Work work) {
  if (forcing.any()) {
    for_each_group<typename V::Wide>(lanes, [&](const auto& at) { work(at, forcing); });
  } else {
    for_each_vector<V>(lanes, [&](const auto& at) { work(at, Unforced{}); });
  }
}

template <class P, class At>
__attribute__((noinline)) void append_events(BatchState& batch, const At& at, const P& events,
                                             unsigned noted) {
  double value[P::lanes];
  __builtin_memcpy(value, &events, sizeof value);
  for (; noted != 0; noted &= noted - 1) {
    const int i = __builtin_ctz(noted);
    const int lane = at.lane(i);
    batch.events[lane] = static_cast<int>(value[i]);
    batch.event_lanes[batch.event_count++] = lane;
  }
}

/// Records the lanes whose `events` are not 0, and their events, in the batch state.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void add_events(BatchState& batch, const At& at, const P& events) {
  const typename P::Mask noted = (events != P(0.0)) & at.taking_part();
  if (noted.any()) append_events(batch, at, events, noted.bits());
}

/// Loads all members of a struct, such as loop::IntegralConstants, from arrays with one number per lane into
/// vectors.
template <template <class> class Struct, class At>
ZEROCOUNT_ALWAYS_INLINE Struct<typename At::Vector> load_struct(const At& at, const Struct<Lanes>& lanes) {
  using P = typename At::Vector;
  constexpr int quantities = sizeof(Struct<Lanes>) / sizeof(Lanes);
  static_assert(sizeof(Struct<P>) == quantities * sizeof(P));
  P value[quantities];
  for (int i = 0; i < quantities; ++i) value[i] = at.load(reinterpret_cast<const Lanes*>(&lanes)[i]);
  Struct<P> loaded;
  __builtin_memcpy(&loaded, value, sizeof loaded);
  return loaded;
}

/// Visitor for for_each_measure(): loads each measure from the lanes of the batch state into a vector.
template <class At>
struct LoadEach {
  const At& at;
  template <class P>
  ZEROCOUNT_ALWAYS_INLINE void operator()(P& to, const double* from) const {
    to = at.load(from);
  }
};
template <class At>
struct StoreEach {
  const At& at;
  template <class P>
  ZEROCOUNT_ALWAYS_INLINE void operator()(double* to, const P& from) const {
    at.store(to, from);
  }
};

/// Converts a mask to numbers: 1 in the lanes where it is set, otherwise 0. to_mask() is the inverse.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P to_number(const typename P::Mask& mask) {
  return select(mask, P(1.0), P(0.0));
}
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask to_mask(const P& number) {
  return number != P(0.0);
}
/// The event `event` in the lanes where the mask is set, no_event in the others.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P events_where(const typename P::Mask& mask, LaneEvent event) {
  return select(mask, P(static_cast<double>(event)), P(0.0));
}

/// Adds `passed` samples with zero error and unchanged torque to the measures of the move.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void measure_passed(BatchState& batch, const At& at, const P& passed) {
  MeasureLanes& q = batch.measures;
  trial::ArrivalMeasures<P> arrival;
  trial::for_each_of_arrival(LoadEach<At>{at}, arrival, q);
  trial::measure_zeros(arrival, at.load(q.limits.dwell), passed);
  trial::for_each_of_arrival(StoreEach<At>{at}, q, arrival);
}

// Step control of all motions.

/// The length h of the next step, or half of the time to the next stop if a step of h would leave only a
/// short remainder.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P without_short_remainder(const P& h, const P& time_to_stop) {
  return select((h < time_to_stop) & (time_to_stop < P(1.4) * h), time_to_stop * P(0.5), h);
}

/// The step (s) to try after a step h (s) that was too long. If it was `inexact`, h is scaled by `factor`,
/// which the truncation error suggests. If it was too long for another reason, h is halved.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P shorter_step(const P& h, const typename P::Mask& inexact, const P& factor) {
  return select(inexact, h * min(max(factor, P(0.05)), P(0.8)), h * P(0.5));
}

}  // namespace zerocount::batch
