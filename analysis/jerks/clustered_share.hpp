#pragma once

#include <cstdint>
#include <limits>

#include "analysis/proportion.hpp"

namespace zerocount {

/// k of n events, where the events come in clusters: the jerks of one trial have much in common.
struct ClusteredShare {
  std::int64_t hits{0};                                    ///< k
  std::int64_t events{0};                                  ///< n
  double share{std::numeric_limits<double>::quiet_NaN()};  ///< k/n
  double independent{0.0};                                 ///< number of independent events they are worth
  ConfidenceInterval bounds{0.0, 1.0};                     ///< of the share
};

/// Sums over clusters, of which each has `hits` of `events`.
class ClusterSums {
 public:
  void add(std::int64_t hits, std::int64_t events);
  /// Clopper–Pearson bounds for the number of independent events
  ///
  ///   n* = n/deff,   deff = v/(p(1 − p)/n),   v = m/(m − 1)·Σ(kᵢ − p·nᵢ)²/n²   over the m clusters,
  ///
  /// kept between 1 and n. Where p is 0 or 1, or there is one cluster, v says nothing, and the events of a
  /// cluster count as if they were all alike: n* = n²/Σnᵢ². Bounds [0, 1] without an event. Sources: Korn and
  /// Graubard, Survey Methodology 24 (1998) 193; Kish, Survey Sampling (1965), section 11.7.
  ClusteredShare share(double confidence = summary_confidence) const;
  /// n*; 0 without an event.
  double independent_events() const;

 private:
  std::int64_t clusters_{0};
  std::int64_t hits_{0};
  std::int64_t events_{0};
  double hits_squared_{0.0};    ///< Σ kᵢ²
  double hits_by_events_{0.0};  ///< Σ kᵢnᵢ
  double events_squared_{0.0};  ///< Σ nᵢ²
};

}  // namespace zerocount
