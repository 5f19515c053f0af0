#include "analysis/basis/statistics/clusters/clustered_mean.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/basis/statistics/mean_bounds.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/basis/statistics/unknown.hpp"

namespace zerocount::statistics {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// [cluster] Sum and number of the values of each cluster as doubles; clusters that nothing was added to are
/// left out.
struct Clusters {
  std::vector<double> sums;
  std::vector<double> numbers;

  explicit Clusters(const ClusterTotals& totals) {
    for (std::int64_t cluster = 0; cluster < totals.added.end(); ++cluster) {
      if (totals.added[cluster] == 0) continue;
      sums.push_back(totals.sums[cluster].value());
      numbers.push_back(static_cast<double>(totals.numbers[cluster]));
    }
  }
};

/// A mean with its standard error.
struct Estimate {
  double mean{unknown};
  double error{0.0};
};

/// Mean of a resample of the clusters, with its standard error by linearisation.
/// @param drawn [cluster] number of times that the resample contains the cluster
/// @param clusters number m of clusters
Estimate estimate_of(const Clusters& totals, const std::vector<std::int32_t>& drawn, double clusters) {
  double sum = 0.0, number = 0.0, sum_sum = 0.0, sum_number = 0.0, number_number = 0.0;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const auto times = static_cast<double>(drawn[i]);
    const double s = totals.sums[i];
    const double n = totals.numbers[i];
    sum += times * s;
    number += times * n;
    sum_sum += times * s * s;
    sum_number += times * s * n;
    number_number += times * n * n;
  }
  if (!(number > 0.0)) return {};
  const double mean = sum / number;
  const double squares = sum_sum - 2.0 * mean * sum_number + mean * mean * number_number;
  // A smaller remainder of the cancelling squares is rounding error.
  if (!(squares > 1e-13 * sum_sum)) return {mean, 0.0};
  return {mean, std::sqrt(clusters / (clusters - 1.0) * squares) / number};
}

/// Studentised deviation (θ* − θ)/e* of a resample: its mean minus the sample's mean, over its standard
/// error. Infinite for a resample without spread, NaN for one without values.
/// @param mean the sample's mean θ
/// @param drawn [cluster] number of times in the resample
double studentised(const Clusters& totals, double mean, const std::vector<std::int32_t>& drawn) {
  const Estimate estimate = estimate_of(totals, drawn, static_cast<double>(drawn.size()));
  const double difference = estimate.mean - mean;
  if (std::isnan(difference) || estimate.error > 0.0) return difference / estimate.error;
  return difference > 0.0 ? infinite : -infinite;
}

/// Lower and upper quantile of the studentised deviation (θ* − θ)/e* of resamples, see studentised().
struct Tails {
  double low{unknown};
  double high{unknown};
};

/// The exact distribution of the studentised deviation (θ* − θ)/e* over all samples of m clusters drawn with
/// replacement. A sample has the probability m!/(Π kᵢ!·mᵐ), where kᵢ is the number of times that cluster i is
/// drawn.
class EverySample {
 public:
  EverySample(const Clusters& totals, double mean)
      : totals_(totals), mean_(mean), drawn_(totals.sums.size(), 0) {
    draw(0, static_cast<std::int32_t>(drawn_.size()), 1.0);
    std::sort(values_.begin(), values_.end());
  }

  /// The quantiles of the deviation: the smallest values at or below which the probability is at least
  /// `tail`, and at least 1 − `tail`.
  Tails tails(double tail) const {
    constexpr double rounding = 1e-12;
    double all = 0.0;
    for (const auto& [value, weight] : values_) all += weight;
    Tails found;
    double below = 0.0;
    for (const auto& [value, weight] : values_) {
      below += weight / all;
      if (std::isnan(found.low) && below >= tail - rounding) found.low = value;
      if (std::isnan(found.high) && below >= 1.0 - tail - rounding) found.high = value;
    }
    return found;
  }

 private:
  /// Enumerates the ways to draw the remaining clusters.
  /// @param cluster first cluster that may still be drawn
  /// @param left number of draws left
  /// @param weight 1/Π kᵢ! of the clusters before
  void draw(std::size_t cluster, std::int32_t left, double weight) {
    const bool is_last = cluster + 1 == drawn_.size();
    for (std::int32_t times = is_last ? left : 0; times <= left; ++times) {
      drawn_[cluster] = times;
      const double with = weight / std::tgamma(times + 1.0);
      if (!is_last) {
        draw(cluster + 1, left - times, with);
      } else if (const double value = studentised(totals_, mean_, drawn_); !std::isnan(value)) {
        values_.emplace_back(value, with);
      }
    }
  }

  const Clusters& totals_;
  double mean_;
  std::vector<std::int32_t> drawn_;
  /// Values of (θ* − θ)/e* of all samples with their probabilities (not normalised).
  std::vector<std::pair<double, double>> values_;
};

/// Studentised deviations (θ* − θ)/e* of random resamples of the clusters, sorted.
/// @param mean the sample's mean θ
/// @param resamples their number
std::vector<double> studentised_means(const Clusters& totals, double mean, const random::RandomStream& stream,
                                      std::int64_t resamples) {
  const std::size_t clusters = totals.sums.size();
  std::vector<double> result;
  std::vector<std::int32_t> drawn(clusters);
  for (std::int64_t r = 0; r < resamples; ++r) {
    std::fill(drawn.begin(), drawn.end(), 0);
    for (std::size_t i = 0; i < clusters; ++i) {
      const double place = random::open_uniform(random::random_bits(stream, static_cast<std::uint64_t>(r),
                                                                    static_cast<std::uint32_t>(i))) *
                           static_cast<double>(clusters);
      ++drawn[static_cast<std::size_t>(place)];
    }
    const double value = studentised(totals, mean, drawn);
    if (!std::isnan(value)) result.push_back(value);
  }
  std::sort(result.begin(), result.end());
  return result;
}

Tails tails_of(const Clusters& totals, double mean, const random::RandomStream& stream,
               std::int64_t resamples, double tail) {
  if (std::ssize(totals.sums) <= max_enumerated_clusters) return EverySample(totals, mean).tails(tail);
  const std::vector<double> drawn = studentised_means(totals, mean, stream, resamples);
  if (drawn.empty()) return {};
  return {interpolated_quantile(drawn, tail), interpolated_quantile(drawn, 1.0 - tail)};
}

std::int64_t number_of_positive(const std::vector<double>& values) {
  return std::count_if(values.begin(), values.end(), [](double value) { return value > 0.0; });
}

double student_limit(double degrees_of_freedom, double confidence) {
  return student_t_quantile(degrees_of_freedom, 0.5 * (1.0 + confidence));
}

double finite_or_unknown(double bound) {
  return std::isfinite(bound) ? bound : unknown;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Variance of the mean of a count, divided by the variance that it would have as a Poisson number; at least
/// 1.
double overdispersion(const Clusters& totals, const Estimate& estimate) {
  const double number = sum_of(totals.numbers);
  const double of_poisson = estimate.mean / number;
  return of_poisson > 0.0 ? std::max(1.0, estimate.error * estimate.error / of_poisson) : 1.0;
}

/// clustered_mean_bounds() for sums that were converted from ClusterTotals.
ConfidenceInterval mean_bounds(const Clusters& totals, const random::RandomStream& stream, double confidence,
                               std::int64_t resamples) {
  constexpr ConfidenceInterval none{unknown, unknown};
  if (number_of_positive(totals.numbers) < 2) return none;
  const auto clusters = static_cast<double>(totals.sums.size());
  const Estimate estimate = estimate_of(totals, std::vector<std::int32_t>(totals.sums.size(), 1), clusters);
  if (!(estimate.error > 0.0)) return none;
  const Tails tails = tails_of(totals, estimate.mean, stream, resamples, 0.5 * (1.0 - confidence));
  if (std::isnan(tails.low)) return none;
  const double t = student_limit(clusters - 1.0, confidence);
  const double above = std::max(t, tails.high);
  const double below = std::min(-t, tails.low);
  return {finite_or_unknown(estimate.mean - above * estimate.error),
          finite_or_unknown(estimate.mean - below * estimate.error)};
}

}  // namespace

void ClusterTotals::add(std::int64_t cluster, std::span<const double> values) {
  const std::int64_t place = cluster % max_clusters;
  ExactSum& sum = sums.sum_of(place);
  for (const double value : values) sum.add(value);
  numbers.add(place, std::ssize(values));
  added.add(place, 1);
  highest = std::max(highest, cluster);
}

ClusterTotals& ClusterTotals::operator+=(const ClusterTotals& other) {
  sums += other.sums;
  numbers += other.numbers;
  added += other.added;
  highest = std::max(highest, other.highest);
  return *this;
}

std::int64_t ClusterTotals::clusters() const {
  return std::min(highest + 1, std::accumulate(added.sums().begin(), added.sums().end(), std::int64_t{0}));
}

ConfidenceInterval clustered_mean_bounds(const ClusterTotals& totals, const random::RandomStream& stream,
                                         double confidence, std::int64_t resamples) {
  require_confidence(confidence);
  return mean_bounds(Clusters(totals), stream, confidence, resamples);
}

ConfidenceInterval clustered_count_bounds(const ClusterTotals& sample, const random::RandomStream& stream,
                                          double confidence, std::int64_t resamples) {
  require_confidence(confidence);
  const Clusters totals(sample);
  const auto clusters = static_cast<double>(totals.sums.size());
  const double number = sum_of(totals.numbers);
  if (!(number > 0.0)) return {unknown, unknown};
  const double count = sum_of(totals.sums);
  if (count == 0.0) {
    return {0.0, poisson_bounds(0.0, confidence).high / static_cast<double>(sample.clusters())};
  }
  if (number_of_positive(totals.sums) >= min_counting_clusters) {
    return mean_bounds(totals, stream, confidence, resamples);
  }
  if (clusters < 2.0) return {unknown, unknown};
  const Estimate estimate = estimate_of(totals, std::vector<std::int32_t>(totals.sums.size(), 1), clusters);
  const double shorter = two_sided_normal_quantile(confidence) / student_limit(clusters - 1.0, confidence);
  const double events = count / overdispersion(totals, estimate) * shorter * shorter;
  const ConfidenceInterval bounds = poisson_bounds(events, confidence);
  const double scale = estimate.mean / events;
  return {bounds.low * scale, bounds.high * scale};
}

}  // namespace zerocount::statistics
