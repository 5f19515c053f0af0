#include "analysis/statistics/clusters/clustered_quantile.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/clusters/tolerance.hpp"
#include "analysis/statistics/unknown.hpp"

namespace zerocount::statistics {
namespace {

/// The effective number of independent values at a quantile, rounded down.
std::int64_t whole_values(const ClusteredSample& sample, double sample_quantile, double tail) {
  const double at = std::isnan(sample_quantile) ? largest(sample.observed()) : sample_quantile;
  const double events = adjusted_events(sample.at_most(at), tail);
  // The factor absorbs rounding errors just below a whole number.
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(events * (1.0 + 1e-12)));
}

/// The observation at `rank` of `whole` independent values, scaled to the rank among all values. Rounded away
/// from the quantile.
double scaled_low(const ClusteredSample& sample, std::int64_t rank, std::int64_t whole) {
  const double scale = static_cast<double>(sample.size()) / static_cast<double>(whole);
  return order_statistic(sample.observed(),
                         static_cast<std::int64_t>(std::floor(static_cast<double>(rank) * scale)));
}
double scaled_high(const ClusteredSample& sample, std::int64_t rank, std::int64_t whole) {
  if (rank > whole) return unknown;
  const double scale = static_cast<double>(sample.size()) / static_cast<double>(whole);
  return order_statistic(sample.observed(),
                         static_cast<std::int64_t>(std::ceil(static_cast<double>(rank) * scale)));
}

}  // namespace

void ClusteredSample::begin_cluster(std::int64_t size) {
  totals_.add(0, size);
  if (size > 1) count_in_steps();
}

void ClusteredSample::count_in_steps() {
  if (!single_values_) return;
  single_values_ = false;
  for (const auto& [value, count] : observed_.counts) {
    const auto hits = static_cast<double>(count);
    steps_[value] = {hits, hits};
  }
}

void ClusteredSample::add_step(double value, std::int64_t before, std::int64_t count, std::int64_t size) {
  const auto from = static_cast<double>(before);
  const auto to = static_cast<double>(before + count);
  Step& step = steps_[value];
  step.hits_squared += to * to - from * from;
  step.hits_by_events += (to - from) * static_cast<double>(size);
}

void ClusteredSample::add_cluster(const Histogram<double>& observed, std::int64_t size) {
  begin_cluster(size);
  std::int64_t before = 0;
  for (const auto& [value, count] : observed.counts) {
    observed_.add(value, count);
    if (!single_values_) add_step(value, before, count, size);
    before += count;
  }
}

void ClusteredSample::add_cluster(std::span<double> observed, std::int64_t size) {
  begin_cluster(size);
  std::sort(observed.begin(), observed.end());
  for (std::size_t i = 0; i < observed.size(); ++i) {
    observed_.add(observed[i]);
    if (!single_values_) add_step(observed[i], static_cast<std::int64_t>(i), 1, size);
  }
}

ClusteredSample& ClusteredSample::operator+=(const ClusteredSample& other) {
  if (!other.single_values_) count_in_steps();
  observed_ += other.observed_;
  totals_ += other.totals_;
  if (single_values_) return *this;
  ClusteredSample added = other;
  added.count_in_steps();
  for (const auto& [value, step] : added.steps_) {
    steps_[value].hits_squared += step.hits_squared;
    steps_[value].hits_by_events += step.hits_by_events;
  }
  return *this;
}

ClusterSums ClusteredSample::at_most(double x) const {
  ClusterSums sums = totals_;
  for (const auto& [value, count] : observed_.counts) {
    if (value > x) break;
    sums.hits += count;
  }
  if (single_values_) {
    sums.hits_squared = sums.hits_by_events = static_cast<double>(sums.hits);
    return sums;
  }
  for (const auto& [value, step] : steps_) {
    if (value > x) break;
    sums.hits_squared += step.hits_squared;
    sums.hits_by_events += step.hits_by_events;
  }
  return sums;
}

Quantile clustered_quantile(const ClusteredSample& sample, double probability, double confidence) {
  const double value = order_statistic(sample.observed(), quantile_rank(sample.size(), probability));
  require_confidence(confidence);
  if (sample.observed().size == 0) return {unknown, unknown, unknown};
  const std::int64_t whole = whole_values(sample, value, 0.5 * (1.0 - confidence));
  const RankBounds ranks = quantile_rank_bounds(whole, probability, confidence);
  return {value, scaled_low(sample, ranks.low, whole), scaled_high(sample, ranks.high, whole)};
}

double clustered_upper_limit(const ClusteredSample& sample, double content, double confidence) {
  const std::int64_t rank = quantile_rank(sample.size(), content);
  require_confidence(confidence);
  if (sample.observed().size == 0) return unknown;
  const std::int64_t whole = whole_values(sample, order_statistic(sample.observed(), rank), 1.0 - confidence);
  return scaled_high(sample, tolerance_rank(whole, content, confidence), whole);
}

}  // namespace zerocount::statistics
