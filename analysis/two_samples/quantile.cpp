#include "analysis/two_samples/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/statistics/quantile.hpp"
#include "core/numerics/bisection.hpp"

namespace zerocount::two_samples {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double bound_precision = 1e-3;  ///< of a bound, as a proportion of the largest value

/// Whether every cluster has a single value: its proportion is 0 or 1.
bool are_single(const ClusteredValues& values) {
  return values.clusters == 0 && values.values_of_trial == 1;
}

/// The largest of the values that are finite; 0 without any.
double max_finite(const ClusteredValues& values) {
  double largest = 0.0;
  for (const double value : values.values) {
    if (std::isfinite(value)) largest = std::max(largest, value);
  }
  return largest;
}

/// The proportion of the values of each cluster that are at or above x.
std::vector<double> proportions_from(const ClusteredValues& values, double x) {
  const auto width = static_cast<std::size_t>(values.values_of_trial);
  const std::size_t trials = values.values.size() / width;
  const std::size_t clusters = values.clusters > 0 ? static_cast<std::size_t>(values.clusters) : trials;
  std::vector<double> proportions(clusters, 0.0);
  for (std::size_t i = 0; i < values.values.size(); ++i)
    proportions[i / width % clusters] += values.values[i] >= x ? 1.0 : 0.0;
  for (std::size_t cluster = 0; cluster < clusters; ++cluster) {
    const std::size_t of_cluster = (trials - cluster + clusters - 1) / clusters;
    proportions[cluster] /= static_cast<double>(of_cluster * width);
  }
  return proportions;
}

/// The proportions of values at or above the quantile of both together.
Sample late_values(const QuantileSample& of) {
  std::vector<double> pooled(of.baseline.values.begin(), of.baseline.values.end());
  pooled.insert(pooled.end(), of.current.values.begin(), of.current.values.end());
  const double x = statistics::sample_quantile(std::move(pooled), of.probability);
  Sample sample{.failures = are_single(of.baseline) && are_single(of.current), .paired = of.paired};
  sample.baseline = proportions_from(of.baseline, x);
  sample.current = proportions_from(of.current, x);
  for (std::size_t i = 0; of.paired && i < sample.current.size(); ++i)
    sample.differences.push_back(sample.current[i] - sample.baseline[i]);
  return sample;
}

/// The smallest number from which on `holds`, between −range and range, rounded up to the precision; ±∞
/// where that is beyond.
template <class Predicate>
double first_from(double range, double precision, const Predicate& holds) {
  if (!holds(range)) return infinity;
  if (holds(-range)) return -infinity;
  return numerics::bisect({range, -range}, holds, numerics::within(precision)).holds;
}

}  // namespace

double quantile_of(const ClusteredValues& values, double probability) {
  return statistics::sample_quantile({values.values.begin(), values.values.end()}, probability);
}

Change change_of(const QuantileSample& sample, double confidence) {
  const ClusteredValues& baseline = sample.baseline;
  std::vector<double> shifted(baseline.values.size());
  const auto p_of_shift = [&](double shift) {
    for (std::size_t i = 0; i < shifted.size(); ++i) shifted[i] = baseline.values[i] + shift;
    QuantileSample of_shift = sample;
    of_shift.baseline.values = shifted;
    return p_of(late_values(of_shift));
  };
  const DirectionalP p = p_of_shift(0.0);
  const double effect =
      quantile_of(sample.current, sample.probability) - quantile_of(baseline, sample.probability);
  const double range = std::max(max_finite(baseline), max_finite(sample.current)) + 1e-9;
  const double alpha = 1.0 - confidence;
  const auto bound = [&](const auto& rejects) { return first_from(range, bound_precision * range, rejects); };
  const double low = -bound([&](double x) { return p_of_shift(-x).worse <= alpha; });
  const double high = bound([&](double x) { return p_of_shift(x).better <= alpha; });
  // The tests are about a shift of all values; quantiles of other shapes may differ by more or less than
  // that.
  return {effect, {std::min(low, effect), std::max(high, effect)}, p.worse, p.better};
}

Sample linearised(const QuantileSample& sample, const Change& change, double standard_error) {
  Sample means = late_values(sample);
  means.failures = false;
  const MeanDifference mean = mean_difference(means);
  const double scale = mean.standard_error > 0.0 ? standard_error / mean.standard_error : standard_error;
  const double rest = change.effect - scale * mean.value;
  for (double& value : means.baseline) value *= scale;
  for (double& value : means.current) value = scale * value + rest;
  for (std::size_t i = 0; i < means.differences.size(); ++i)
    means.differences[i] = means.current[i] - means.baseline[i];
  means.plausible = std::max(scale, 1e-9);
  return means;
}

}  // namespace zerocount::two_samples
