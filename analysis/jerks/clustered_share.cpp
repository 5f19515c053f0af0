#include "analysis/jerks/clustered_share.hpp"

#include <algorithm>

#include <boost/math/special_functions/beta.hpp>

namespace zerocount {
namespace {

/// Clopper–Pearson for any number of events, not only whole ones.
ConfidenceInterval share_bounds(double share, double events, double confidence) {
  const double tail = 0.5 * (1.0 - confidence);
  const double hits = share * events;
  const double misses = events - hits;
  return {share <= 0.0 ? 0.0 : boost::math::ibeta_inv(hits, misses + 1.0, tail),
          share >= 1.0 ? 1.0 : boost::math::ibetac_inv(hits + 1.0, misses, tail)};
}

}  // namespace

void ClusterSums::add(std::int64_t hits, std::int64_t events) {
  if (events == 0) return;
  const auto k = static_cast<double>(hits);
  const auto n = static_cast<double>(events);
  ++clusters_;
  hits_ += hits;
  events_ += events;
  hits_squared_ += k * k;
  hits_by_events_ += k * n;
  events_squared_ += n * n;
}

double ClusterSums::independent_events() const {
  if (events_ == 0) return 0.0;
  const auto n = static_cast<double>(events_);
  const auto m = static_cast<double>(clusters_);
  if (hits_ == 0 || hits_ == events_ || clusters_ == 1) return n * n / events_squared_;
  const double p = static_cast<double>(hits_) / n;
  const double squares = hits_squared_ - 2.0 * p * hits_by_events_ + p * p * events_squared_;
  const double variance = m / (m - 1.0) * std::max(0.0, squares) / (n * n);
  const double of_independent = p * (1.0 - p) / n;
  return variance > of_independent ? std::max(1.0, n * of_independent / variance) : n;
}

ClusteredShare ClusterSums::share(double confidence) const {
  require_confidence(confidence);
  ClusteredShare result{.hits = hits_, .events = events_};
  if (events_ == 0) return result;
  result.share = rate(hits_, events_);
  result.independent = independent_events();
  result.bounds = share_bounds(result.share, result.independent, confidence);
  return result;
}

}  // namespace zerocount
