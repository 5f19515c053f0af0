#include "analysis/bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include <boost/math/distributions/normal.hpp>
#include <boost/random/binomial_distribution.hpp>

#include "core/failure.hpp"

namespace zerocount {
namespace {

/// Below so many draws per distinct value, drawing each is quicker than a binomial number per value.
constexpr std::int64_t draws_per_value = 16;

/// The random numbers of one resample, as Boost.Random takes them.
class ResampleBits {
 public:
  using result_type = std::uint64_t;
  ResampleBits(const RandomStream& stream, std::uint64_t resample) : stream_(stream), resample_(resample) {}
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() { return random_bits(stream_, resample_, draw_++); }

 private:
  const RandomStream& stream_;
  std::uint64_t resample_;
  std::uint32_t draw_{0};
};

std::int64_t size_of(const WeightedSample& sample) {
  return std::accumulate(sample.counts.begin(), sample.counts.end(), std::int64_t{0});
}

double weighted_mean(const std::vector<double>& values, const std::vector<std::int64_t>& counts,
                     std::int64_t n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += values[i] * static_cast<double>(counts[i]);
  return sum / static_cast<double>(n);
}

/// Draws the observations one by one.
class SingleDraws {
 public:
  explicit SingleDraws(const WeightedSample& sample) {
    for (std::size_t i = 0; i < sample.counts.size(); ++i)
      values_.insert(values_.end(), static_cast<std::size_t>(sample.counts[i]), i);
  }
  void operator()(ResampleBits bits, std::vector<std::int64_t>& counts) const {
    std::fill(counts.begin(), counts.end(), 0);
    const auto n = static_cast<double>(values_.size());
    for (std::size_t i = 0; i < values_.size(); ++i)
      ++counts[values_[static_cast<std::size_t>(open_uniform(bits()) * n)]];
  }

 private:
  std::vector<std::size_t> values_;  ///< [observation]: number of its value
};

/// Draws how often each value occurs: binomial, given how often those before it did.
class BinomialDraws {
 public:
  explicit BinomialDraws(const WeightedSample& sample) : sample_(sample), n_(size_of(sample)) {}
  void operator()(ResampleBits bits, std::vector<std::int64_t>& counts) const {
    std::int64_t left = n_;
    std::int64_t weight = n_;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const double share = static_cast<double>(sample_.counts[i]) / static_cast<double>(weight);
      const bool last = weight == sample_.counts[i];
      counts[i] = last ? left : boost::random::binomial_distribution<std::int64_t>(left, share)(bits);
      left -= counts[i];
      weight -= sample_.counts[i];
    }
  }

 private:
  const WeightedSample& sample_;
  std::int64_t n_;
};

template <typename Draws>
std::vector<double> resampled_means(const Draws& draws, const WeightedSample& sample,
                                    const RandomStream& stream, std::int64_t resamples) {
  const std::int64_t n = size_of(sample);
  std::vector<std::int64_t> counts(sample.values.size());
  std::vector<double> means(static_cast<std::size_t>(resamples));
  for (std::size_t r = 0; r < means.size(); ++r) {
    draws(ResampleBits(stream, r), counts);
    means[r] = weighted_mean(sample.values, counts, n);
  }
  return means;
}

/// Between the order statistics, linearly (definition 7 of Hyndman and Fan 1996).
double interpolated_quantile(const std::vector<double>& sorted, double probability) {
  const double place = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 >= sorted.size()) return sorted.back();
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[below + 1] - sorted[below]);
}

/// Share of `sorted` below `value`, those equal to it counted half.
double share_below(const std::vector<double>& sorted, double value) {
  const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
  const auto below = static_cast<double>(first - sorted.begin());
  const auto equal = static_cast<double>(last - first);
  return (below + 0.5 * equal) / static_cast<double>(sorted.size());
}

}  // namespace

std::vector<double> bootstrap_means(const WeightedSample& sample, const RandomStream& stream,
                                    std::int64_t resamples) {
  const std::int64_t n = size_of(sample);
  if (n == 0) return {};
  if (n <= draws_per_value * std::ssize(sample.values))
    return resampled_means(SingleDraws(sample), sample, stream, resamples);
  return resampled_means(BinomialDraws(sample), sample, stream, resamples);
}

double mean_acceleration(const WeightedSample& sample) {
  const double mean = weighted_mean(sample.values, sample.counts, size_of(sample));
  double squares = 0.0;
  double cubes = 0.0;
  for (std::size_t i = 0; i < sample.values.size(); ++i) {
    const double deviation = sample.values[i] - mean;
    const double square = deviation * deviation * static_cast<double>(sample.counts[i]);
    squares += square;
    cubes += square * deviation;
  }
  return squares > 0.0 ? cubes / (6.0 * squares * std::sqrt(squares)) : 0.0;
}

ConfidenceInterval bca_mean(const WeightedSample& sample, const RandomStream& stream, double confidence,
                            std::int64_t resamples) {
  require_confidence(confidence);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const std::int64_t n = size_of(sample);
  if (sample.values.size() < 2) return {unknown, unknown};
  const double mean = weighted_mean(sample.values, sample.counts, n);
  std::vector<double> means = bootstrap_means(sample, stream, resamples);
  std::sort(means.begin(), means.end());
  const double below = share_below(means, mean);
  if (!(below > 0.0 && below < 1.0)) return {unknown, unknown};
  const boost::math::normal_distribution<double> normal;
  const double bias = boost::math::quantile(normal, below);
  const double acceleration = mean_acceleration(sample);
  const auto bound = [&](double probability) {
    const double shifted = bias + boost::math::quantile(normal, probability);
    return interpolated_quantile(means,
                                 boost::math::cdf(normal, bias + shifted / (1.0 - acceleration * shifted)));
  };
  const double tail = 0.5 * (1.0 - confidence);
  return {bound(tail), bound(1.0 - tail)};
}

}  // namespace zerocount
