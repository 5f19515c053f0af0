#pragma once

#include "core/batch/lanes.hpp"
#include "core/batch/tile.hpp"

namespace zerocount::batch {

/// The lanes of one pack: loads and stores whichever they are, faster where they are neighbours.
template <class P>
class LaneGroup {
 public:
  /// The lanes from number `first` of the list on, filled up with the spare lane.
  ZEROCOUNT_ALWAYS_INLINE LaneGroup(const LaneList& list, int first) {
    const int rest = list.count - first;
    used_ = rest < P::lanes ? rest : P::lanes;
    for (int i = 0; i < P::lanes; ++i) lane_[i] = i < used_ ? list.lanes[first + i] : spare_lane;
    neighbours_ = used_ == P::lanes && lane_[P::lanes - 1] - lane_[0] == P::lanes - 1;
  }

  ZEROCOUNT_ALWAYS_INLINE P load(const double* of) const {
    P r;
    constexpr int width = sizeof(r.part[0]) / sizeof(double);
    if (neighbours_) {
      __builtin_memcpy(&r, of + lane_[0], sizeof r);
    } else {
      for (int i = 0; i < P::lanes; ++i) r.part[i / width][i % width] = of[lane_[i]];
    }
    return r;
  }

  ZEROCOUNT_ALWAYS_INLINE void store(double* to, const P& value) const {
    constexpr int width = sizeof(value.part[0]) / sizeof(double);
    if (neighbours_) {
      __builtin_memcpy(to + lane_[0], &value, sizeof value);
    } else {
      for (int i = 0; i < P::lanes; ++i) to[lane_[i]] = value.part[i / width][i % width];
    }
  }

  /// Adds the lanes whose `notes` are not 0 to the tile's.
  ZEROCOUNT_ALWAYS_INLINE void note(Tile& tile, const P& notes) const {
    if (!(notes != P(0.0)).any()) return;
    constexpr int width = sizeof(notes.part[0]) / sizeof(double);
    for (int i = 0; i < used_; ++i) {
      const double value = notes.part[i / width][i % width];
      if (value == 0.0) continue;
      tile.note[lane_[i]] = static_cast<int>(value);
      tile.noted[tile.noted_count++] = lane_[i];
    }
  }

  ZEROCOUNT_ALWAYS_INLINE int lane(int i) const { return lane_[i]; }
  ZEROCOUNT_ALWAYS_INLINE int used() const { return used_; }

 private:
  int lane_[P::lanes];
  int used_;
  bool neighbours_;
};

/// Truth as 0 or 1, and back.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P number(const typename P::Truth& truth) {
  return select(truth, P(1.0), P(0.0));
}
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Truth truth(const P& number) {
  return number != P(0.0);
}
/// `note` where true.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P noted(const typename P::Truth& truth, LaneNote note) {
  return select(truth, P(static_cast<double>(note)), P(0.0));
}

}  // namespace zerocount::batch
