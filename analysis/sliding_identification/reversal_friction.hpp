#pragma once

#include <optional>
#include <vector>

namespace zerocount::sliding_identification {

struct SlidingFit;

/// A reversal without a standstill: how the friction turns over, from one direction's level to the other's.
struct Reversal {
  double time{0.0};        ///< s
  double swing{0.0};       ///< sum of both levels near the reversal, N m or N
  double travel{0.0};      ///< from the reversal on, in which nine tenths of the swing are done, rad or m
  std::size_t samples{0};  ///< in that travel
};

/// The friction before sliding, by the reversals of all records.
struct ReversalFriction {
  std::vector<Reversal> reversals{};
  double swing{0.0};  ///< medians
  double travel{0.0};
  double stiffness{0.0};  ///< of the secant, 0.9·swing/travel, N m/rad or N/m
  std::size_t samples{0};
  double min_travel{0.0};
  double max_travel{0.0};
};

/// Fewer samples than this within the travel only show that it is shorter.
inline constexpr std::size_t min_reversal_samples = 6;

/// The friction about each reversal is u − u0 − J·a − cs·v, with velocity and acceleration by a parabola
/// through three readings to both sides, which smooths what changes within so many samples: travels are told
/// from min_reversal_samples on. The levels are medians over the samples from 20 to 40 before and after.
/// Nothing without a reversal.
std::optional<ReversalFriction> reversal_friction(const SlidingFit& fit);

}  // namespace zerocount::sliding_identification
