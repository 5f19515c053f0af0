#include "analysis/basis/statistics/clusters/clustered_quantile.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "analysis/basis/statistics/clusters/tolerance.hpp"
#include "analysis/basis/statistics/unknown.hpp"

namespace zerocount::statistics {
namespace {

/// Adds values to a histogram, quickly if many are equal: values seen recently are counted before they are
/// looked up in the map.
void add_repeated(Histogram<double>& histogram, std::span<const double> values) {
  struct Seen {
    double value{0.0};
    std::int64_t times{0};
  };
  constexpr int places_log2 = 8;
  std::array<Seen, std::size_t{1} << places_log2> all_seen{};
  for (const double value : values) {
    constexpr std::uint64_t golden_ratio = 0x9e3779b97f4a7c15;
    Seen& seen = all_seen[std::bit_cast<std::uint64_t>(value) * golden_ratio >> (64 - places_log2)];
    if (seen.value != value && seen.times > 0) {
      histogram.add(seen.value, seen.times);
      seen.times = 0;
    }
    seen.value = value;
    ++seen.times;
  }
  for (const Seen& seen : all_seen)
    if (seen.times > 0) histogram.add(seen.value, seen.times);
}

/// The effective number of independent values for bounds of a quantile, rounded down, at least 1.
/// @param sample_quantile observed quantile; NaN: among the censored values
/// @param tail probability beyond each bound
std::int64_t whole_values(const ClusteredSample& sample, double sample_quantile, double tail) {
  const double at = std::isnan(sample_quantile) ? largest(sample.observed()) : sample_quantile;
  const double events = adjusted_events(sample.at_most(at), tail);
  // The factor absorbs rounding errors just below a whole number.
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(events * (1.0 + 1e-12)));
}

/// The lower bound of a quantile: the observation whose rank among all values corresponds to `rank` among
/// `whole` independent values. The rank is rounded down, away from the quantile.
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

void ClusteredSample::add_single_values(std::span<const double> observed, std::int64_t censored) {
  const std::int64_t clusters = std::ssize(observed) + censored;
  totals_ += {.clusters = clusters, .events = clusters, .events_squared = static_cast<double>(clusters)};
  constexpr std::size_t few = 64;
  if (single_values_ && observed.size() >= few) return add_repeated(observed_, observed);
  for (const double value : observed) {
    observed_.add(value);
    if (!single_values_) add_step(value, 0, 1, 1);
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
