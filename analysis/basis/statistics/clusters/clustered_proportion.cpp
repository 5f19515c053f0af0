#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "analysis/basis/statistics/distributions.hpp"

namespace zerocount::statistics {
namespace {

/// Whether the variance of the proportion between clusters can be estimated: there are several clusters, and
/// hits as well as misses.
bool variance_is_known(const ClusterSums& sums) {
  return sums.clusters > 1 && sums.hits > 0 && sums.hits < sums.events;
}

bool are_single_events(const ClusterSums& sums) {
  return sums.clusters == sums.events;
}

/// Effective number of events if all events of a cluster are taken as one: n²/Σnᵢ², which is the number of
/// clusters if they are of one size.
double events_of_whole_clusters(const ClusterSums& sums) {
  const auto n = static_cast<double>(sums.events);
  return n * n / sums.events_squared;
}

/// Largest lower bound of the proportion that so few clusters can show (most_shown_by_clusters()); for
/// clusters of one event 1, because Clopper–Pearson does not exceed it.
double most_shown(const ClusterSums& sums, double proportion, double tail) {
  if (are_single_events(sums)) return 1.0;
  return most_shown_by_clusters(events_of_whole_clusters(sums), proportion, 1.0 - tail);
}

/// Lower Clopper–Pearson bound for any number of effective events, not only whole ones, limited to what the
/// number of clusters can show.
/// @param tail probability beyond the bound
double lower_bound(const ClusterSums& sums, double events, double tail) {
  const double proportion = rate(sums.hits, sums.events);
  if (!(proportion > 0.0)) return 0.0;
  return std::min(lower_bound_on_p(proportion * events, events, tail), most_shown(sums, proportion, tail));
}
double upper_bound(const ClusterSums& sums, double events, double tail) {
  const double proportion = rate(sums.hits, sums.events);
  if (!(proportion < 1.0)) return 1.0;
  return std::max(upper_bound_on_p(proportion * events, events, tail),
                  1.0 - most_shown(sums, 1.0 - proportion, tail));
}

}  // namespace

void ClusterSums::add(std::int64_t cluster_hits, std::int64_t cluster_events) {
  if (cluster_events == 0) return;
  const auto k = static_cast<double>(cluster_hits);
  const auto n = static_cast<double>(cluster_events);
  ++clusters;
  hits += cluster_hits;
  events += cluster_events;
  hits_squared += k * k;
  hits_by_events += k * n;
  events_squared += n * n;
}

ClusterSums& ClusterSums::operator+=(const ClusterSums& other) {
  clusters += other.clusters;
  hits += other.hits;
  events += other.events;
  hits_squared += other.hits_squared;
  hits_by_events += other.hits_by_events;
  events_squared += other.events_squared;
  return *this;
}

ClusterSums sums_by_machine(std::span<const double> hits, std::int64_t machines) {
  ClusterSums sums;
  for (std::int64_t machine = 0; machine < machines; ++machine) {
    std::int64_t of_machine = 0, trials = 0;
    for (std::int64_t i = machine; i < std::ssize(hits); i += machines) {
      of_machine += hits[static_cast<std::size_t>(i)] > 0.0;
      ++trials;
    }
    sums.add(of_machine, trials);
  }
  return sums;
}

double effective_events(const ClusterSums& sums) {
  if (sums.events == 0) return 0.0;
  const auto n = static_cast<double>(sums.events);
  const auto m = static_cast<double>(sums.clusters);
  if (are_single_events(sums)) return n;
  if (!variance_is_known(sums)) return events_of_whole_clusters(sums);
  const double p = rate(sums.hits, sums.events);
  const double squares = sums.hits_squared - 2.0 * p * sums.hits_by_events + p * p * sums.events_squared;
  const double variance = m / (m - 1.0) * std::max(0.0, squares) / (n * n);
  const double of_independent = p * (1.0 - p) / n;
  return variance > of_independent ? std::max(1.0, n * of_independent / variance) : n;
}

double most_shown_by_clusters(double clusters, double proportion, double confidence) {
  return std::pow(1.0 - confidence, 1.0 / clusters) * proportion;
}

double adjusted_events(const ClusterSums& sums, double tail) {
  const double events = effective_events(sums);
  if (!variance_is_known(sums) || are_single_events(sums) || tail == 0.5) return events;
  // The quantiles of 1 − tail have the same ratio.
  const double of_events = student_t_quantile(static_cast<double>(sums.events - 1), tail);
  const double of_clusters = student_t_quantile(static_cast<double>(sums.clusters - 1), tail);
  return events * (of_events / of_clusters) * (of_events / of_clusters);
}

ClusteredProportion clustered_proportion(const ClusterSums& sums, double confidence) {
  require_confidence(confidence);
  ClusteredProportion result{.hits = sums.hits, .events = sums.events};
  if (sums.events == 0) return result;
  const double tail = 0.5 * (1.0 - confidence);
  const double events = adjusted_events(sums, tail);
  result.value = rate(sums.hits, sums.events);
  result.effective_events = effective_events(sums);
  result.korn_graubard = {lower_bound(sums, events, tail), upper_bound(sums, events, tail)};
  const ConfidenceInterval wilson = wilson_interval(result.value, events, -normal_quantile(tail));
  result.wilson = {std::min(wilson.low, most_shown(sums, result.value, tail)),
                   std::max(wilson.high, 1.0 - most_shown(sums, 1.0 - result.value, tail))};
  return result;
}

double clustered_at_least(const ClusterSums& sums, double confidence) {
  require_confidence(confidence);
  if (sums.events == 0) return 0.0;
  return lower_bound(sums, adjusted_events(sums, 1.0 - confidence), 1.0 - confidence);
}

double clustered_at_most(const ClusterSums& sums, double confidence) {
  require_confidence(confidence);
  if (sums.events == 0) return 1.0;
  return upper_bound(sums, adjusted_events(sums, 1.0 - confidence), 1.0 - confidence);
}

}  // namespace zerocount::statistics
