#pragma once

#include <cstdint>
#include <span>
#include <type_traits>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/unknown.hpp"

namespace zerocount::statistics {

/// A proportion with bounds: k hits among n events that form clusters, such as the trials of one machine, or
/// the moves or jerks of one trial. Clusters are independent; events of one cluster are correlated.
struct ClusteredProportion {
  std::int64_t hits{0};          ///< Number k of hits.
  std::int64_t events{0};        ///< Number n of events.
  double value{unknown};         ///< Observed proportion k/n of hits; NaN without events.
  double effective_events{0.0};  ///< Equivalent number of independent events, see effective_events().
  /// Clopper–Pearson interval with the effective number of events.
  ConfidenceInterval korn_graubard{0.0, 1.0};
  ConfidenceInterval wilson{0.0, 1.0};  ///< Wilson interval with the effective number of events.
};

/// Sums over clusters. Cluster i has kᵢ hits in nᵢ events.
struct ClusterSums {
  std::int64_t clusters{0};    ///< Number m of clusters with at least one event.
  std::int64_t hits{0};        ///< Total number of hits, Σ kᵢ.
  std::int64_t events{0};      ///< Total number of events, n = Σ nᵢ.
  double hits_squared{0.0};    ///< Sum of the squared hits, Σ kᵢ².
  double hits_by_events{0.0};  ///< Sum of hits times events, Σ kᵢ·nᵢ.
  double events_squared{0.0};  ///< Sum of the squared numbers of events, Σ nᵢ².

  /// Adds a cluster. A cluster without events is ignored.
  void add(std::int64_t cluster_hits, std::int64_t cluster_events);
  /// Adds the sums of other clusters.
  ClusterSums& operator+=(const ClusterSums& other);
  bool operator==(const ClusterSums&) const = default;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.clusters, self.hits, self.events, self.hits_squared, self.hits_by_events,
            self.events_squared);
    if constexpr (!std::is_const_v<Self>) {
      archive.require(self.clusters >= 0 && self.clusters <= self.events && self.hits >= 0 &&
                      self.hits <= self.events && self.hits_squared >= 0.0 && self.hits_by_events >= 0.0 &&
                      self.events_squared >= 0.0);
    }
  }
};

/// Sums over machines as clusters, from the trials of all machines; trial i runs on machine i mod machines.
/// @param hits [trial] 1 for a hit, otherwise 0
ClusterSums sums_by_machine(std::span<const double> hits, std::int64_t machines);

/// The equivalent number of independent events (effective sample size),
///
///   n* = n/deff,   deff = v/(p(1 − p)/n),   v = m/(m − 1)·Σ(kᵢ − p·nᵢ)²/n²,   p = k/n,
///
/// limited to 1 … n. If p is 0 or 1, or if there is only one cluster, v cannot be estimated, and the events
/// of a cluster are taken as all equal: n* = n²/Σnᵢ². If every cluster has one event, n* = n. 0 without
/// events. Sources: Korn and Graubard, Survey Methodology 24 (1998) 193; Kish, Survey Sampling (1965),
/// section 11.7.
double effective_events(const ClusterSums& sums);

/// Effective number of events for bounds: n*·(t(n − 1)/t(m − 1))², with t(f) the quantile of 1 − tail of
/// Student's distribution with f degrees of freedom: the effective number of events, reduced because v is an
/// estimate from m clusters. Without the factor if v cannot be estimated, and for a tail of ½, whose
/// quantiles are 0.
/// @param tail probability beyond each bound, in (0, 1)
double adjusted_events(const ClusterSums& sums, double tail);

/// Largest lower bound of a proportion that m clusters can show, if the proportion p̂ of their events hits:
/// α^(1/m)·p̂ with α = 1 − confidence. A population in which the proportion q of clusters consists of misses
/// shows none of them among m with the probability (1 − q)^m, however many events each cluster has; of the
/// other clusters no more than p̂ is known. An upper bound is at least 1 − α^(1/m)·(1 − p̂).
double most_shown_by_clusters(double clusters, double proportion, double confidence);

/// The proportion with its bounds after Korn and Graubard: Clopper–Pearson for adjusted_events (as the method
/// "beta" of svyciprop in the R package survey). Where clusters have several events, no bound is better than
/// most_shown_by_clusters(n²/Σnᵢ², …) allows. [0, 1] without an event.
/// @throws Failure (bad_input) for a confidence outside (0, 1).
ClusteredProportion clustered_proportion(const ClusterSums& sums, double confidence = summary_confidence);

/// The one-sided lower bound of the proportion of hits in clusters and, in the next function, the upper one,
/// each with the stated confidence.
double clustered_at_least(const ClusterSums& sums, double confidence);
double clustered_at_most(const ClusterSums& sums, double confidence);

}  // namespace zerocount::statistics
