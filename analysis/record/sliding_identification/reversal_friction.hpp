#pragma once

#include <optional>
#include <vector>

namespace zerocount::sliding_identification {

struct SlidingFit;

/// A reversal without a standstill: how the friction turns over, from one direction's level to the other's.
struct Reversal {
  double time{0.0};  ///< Time of the reversal in the record, s.
  /// Change of the friction torque by the reversal: sum of its magnitudes before and after, N m or N.
  double swing{0.0};
  /// Travel after the reversal in which the friction completes nine tenths of the swing, rad or m.
  double travel{0.0};
  std::size_t samples{0};  ///< Number of samples within `travel` after the reversal.
};

/// Friction before sliding (presliding), estimated from the reversals of all records.
struct ReversalFriction {
  std::vector<Reversal> reversals{};
  double swing{0.0};  ///< Median of Reversal::swing over all reversals, N m or N.
  double travel{0.0};
  double stiffness{0.0};  ///< Secant stiffness of the presliding friction, 0.9·swing/travel, N m/rad or N/m.
  std::size_t samples{0};
  double min_travel{0.0};
  double max_travel{0.0};
};

/// Smallest number of samples within the travel from which the travel can be measured. With fewer samples
/// only an upper bound is known.
inline constexpr std::size_t min_reversal_samples = 6;

/// Estimates the friction before sliding from the reversals. The friction about each reversal is u − u0 − J·a
/// − cs·v. Velocity and acceleration come from a parabola through three readings to both sides, which smooths
/// changes within so many samples, so travels can be measured from min_reversal_samples on. The levels are
/// medians over the samples from 20 to 40 before and after the reversal. Nothing without a reversal.
std::optional<ReversalFriction> reversal_friction(const SlidingFit& fit);

}  // namespace zerocount::sliding_identification
