#include "analysis/jerks/jerk_rates.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/mean_bounds.hpp"

namespace zerocount::jerks {
namespace {

constexpr double per_decade = 5.0;

double range_begin(std::int64_t j) {
  return std::pow(10.0, static_cast<double>(j) / per_decade);
}

/// The first sample in range j.
std::int64_t first_sample(std::int64_t j, double sample_time) {
  constexpr double rounding = 1e-12;
  return static_cast<std::int64_t>(std::ceil(range_begin(j) / sample_time * (1.0 - rounding)));
}

}  // namespace

std::int64_t JerkRates::range_of(std::int64_t sample, double sample_time) {
  if (sample_time != sample_time_) {
    sample_time_ = sample_time;
    first_range_ = static_cast<std::int64_t>(std::floor(per_decade * std::log10(sample_time)));
    while (1 < first_sample(first_range_, sample_time)) --first_range_;
    while (1 >= first_sample(first_range_ + 1, sample_time)) ++first_range_;
    ends_.clear();
  }
  while (ends_.empty() || sample >= ends_.back())
    ends_.push_back(first_sample(first_range_ + std::ssize(ends_) + 1, sample_time));
  return first_range_ + (std::ranges::upper_bound(ends_, sample) - ends_.begin());
}

void JerkRates::Range::close_clusters() {
  for (const auto& [number, cluster] : open) {
    clusters += cluster.exposure > 0.0;
    jerks_squared += cluster.jerks * cluster.jerks;
    jerks_by_exposure += cluster.jerks * cluster.exposure;
    exposure_squared += cluster.exposure * cluster.exposure;
  }
  open.clear();
}

JerkRates::Range& JerkRates::range_at(std::int64_t j, const ObservedMove& move) {
  Range& range = ranges_[j];
  if (!clusters_return_ && !range.open.contains(move.cluster)) range.close_clusters();
  range.moves += range.move != moves_;
  range.move = moves_;
  return range;
}

void JerkRates::add_exposure(const ObservedMove& move, std::int64_t first, std::int64_t end) {
  if (first >= end) return;
  range_of(end - 1, move.sample_time);  // so that ends_ has all ranges
  for (std::int64_t j = range_of(first, move.sample_time); first < end; ++j) {
    const std::int64_t next = std::min(end, ends_[static_cast<std::size_t>(j - first_range_)]);
    const double exposure = static_cast<double>(next - first) * move.sample_time;
    Range& range = range_at(j, move);
    range.exposure += exposure;
    range.open[move.cluster].exposure += exposure;
    first = next;
  }
}

void JerkRates::add(const ObservedMove& move) {
  ++moves_;
  earliest_ = std::min(earliest_, static_cast<double>(move.dwell) * move.sample_time);
  latest_ = std::max(latest_, static_cast<double>(move.end) * move.sample_time);
  for_each_run_at_risk(move, [&](std::int64_t first, std::int64_t end) { add_exposure(move, first, end); });
  for (const SampledJerk& jerk : move.jerks) {
    Range& range = range_at(range_of(jerk.onset, move.sample_time), move);
    ++range.jerks;
    range.open[move.cluster].jerks += 1.0;
  }
}

std::vector<JerkRate> JerkRates::rates(double confidence) const {
  statistics::require_confidence(confidence);
  std::vector<JerkRate> rates;
  for (const auto& [j, counted] : ranges_) {
    Range range = counted;
    range.close_clusters();
    const auto jerks = static_cast<double>(range.jerks);
    const auto clusters = static_cast<double>(range.clusters);
    JerkRate rate{.from = std::max(range_begin(j), earliest_), .to = std::min(range_begin(j + 1), latest_)};
    rate.moves = range.moves;
    rate.exposure = range.exposure;
    rate.jerks = range.jerks;
    rate.rate = jerks / range.exposure;
    if (range.jerks > 0 && range.clusters > 1) {
      const double squares = range.jerks_squared - 2.0 * rate.rate * range.jerks_by_exposure +
                             rate.rate * rate.rate * range.exposure_squared;
      rate.dispersion = clusters / (clusters - 1.0) * std::max(0.0, squares) / jerks;
    }
    const auto scaled_bounds = [&](double divisor) {
      const statistics::ConfidenceInterval mean = statistics::poisson_bounds(jerks / divisor, confidence);
      const double exposure = range.exposure / divisor;
      return statistics::ConfidenceInterval{mean.low / exposure, mean.high / exposure};
    };
    rate.poisson = scaled_bounds(1.0);
    rate.bounds = scaled_bounds(std::max(1.0, rate.dispersion));
    rates.push_back(rate);
  }
  return rates;
}

}  // namespace zerocount::jerks
