#pragma once

#include <cstdint>

#include "core/numerics/number.hpp"

namespace zerocount::batch {

inline constexpr int max_lanes = 128;

/// A set of lanes (slots of the batch engine that run one trial each), one bit per lane. Included by the
/// kernels: see simd.hpp for what must not be in here.
struct LaneSet {
  static_assert(max_lanes == 128);
  std::uint64_t words[max_lanes / 64]{};

  ZEROCOUNT_ALWAYS_INLINE bool contains(int lane) const {
    return (words[lane / 64] >> (lane % 64) & 1U) != 0;
  }
  ZEROCOUNT_ALWAYS_INLINE void insert(int lane) { words[lane / 64] |= std::uint64_t{1} << (lane % 64); }
  ZEROCOUNT_ALWAYS_INLINE void erase(int lane) { words[lane / 64] &= ~(std::uint64_t{1} << (lane % 64)); }
  ZEROCOUNT_ALWAYS_INLINE bool empty() const { return (words[0] | words[1]) == 0; }
  ZEROCOUNT_ALWAYS_INLINE int count() const {
    return __builtin_popcountll(words[0]) + __builtin_popcountll(words[1]);
  }
  /// Index of the lowest lane in the set. The set must not be empty.
  ZEROCOUNT_ALWAYS_INLINE int first() const {
    return words[0] != 0 ? __builtin_ctzll(words[0]) : 64 + __builtin_ctzll(words[1]);
  }
  /// Membership of the lanes base to base + width − 1 in the set, one bit each.
  /// @param base a multiple of `width`.
  ZEROCOUNT_ALWAYS_INLINE unsigned stretch(int base, int width) const {
    return static_cast<unsigned>(words[base / 64] >> (base % 64)) & ((1U << width) - 1U);
  }
  ZEROCOUNT_ALWAYS_INLINE void insert_stretch(int base, unsigned lanes) {
    words[base / 64] |= std::uint64_t{lanes} << (base % 64);
  }
  ZEROCOUNT_ALWAYS_INLINE void erase_stretch(int base, unsigned lanes) {
    words[base / 64] &= ~(std::uint64_t{lanes} << (base % 64));
  }
  /// The lanes of this set that are not in `other`.
  ZEROCOUNT_ALWAYS_INLINE LaneSet without(const LaneSet& other) const {
    LaneSet rest = *this;
    for (int i = 0; i < max_lanes / 64; ++i) rest.words[i] &= ~other.words[i];
    return rest;
  }
  ZEROCOUNT_ALWAYS_INLINE LaneSet in_both(const LaneSet& other) const { return without(without(other)); }
};

/// Calls `work` with the index of each lane of the set, in ascending order.
template <class Work>
ZEROCOUNT_ALWAYS_INLINE void for_each_lane(LaneSet set, Work work) {
  for (std::uint64_t i = 0; i < max_lanes / 64; ++i) {
    for (std::uint64_t word = set.words[i]; word != 0; word &= word - 1) {
      work(static_cast<int>(64 * i) + __builtin_ctzll(word));
    }
  }
}

}  // namespace zerocount::batch
