#include "analysis/two_samples/quick_tests.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/distributions.hpp"

namespace zerocount::two_samples {
namespace {

/// P(count ≥ seen) of a count with this mean and variance, by the normal distribution.
double upper_tail_of_count(double seen, double mean, double variance) {
  if (variance <= 0.0) return 1.0;
  return statistics::normal_upper_tail((seen - mean - 0.5) / std::sqrt(variance));
}

double quick_t_quantile(double confidence, double degrees_of_freedom) {
  const double z = statistics::normal_quantile(confidence);
  const double v = degrees_of_freedom;
  return z + (z * z * z + z) / (4.0 * v) +
         (5.0 * std::pow(z, 5) + 16.0 * z * z * z + 3.0 * z) / (96.0 * v * v);
}

/// A mean or a difference of means, the square of its standard error, and its degrees of freedom.
struct QuickMean {
  double value{0.0};
  double variance{0.0};
  double degrees_of_freedom{1.0};
};

double upper_tail(const QuickMean& mean) {
  if (mean.variance <= 0.0) return mean.value > 0.0 ? 0.0 : mean.value < 0.0 ? 1.0 : 0.5;
  const double t = mean.value / std::sqrt(mean.variance);
  const double v = mean.degrees_of_freedom;
  const double size = (8.0 * v + 1.0) / (8.0 * v + 3.0) * std::sqrt(v * std::log1p(t * t / v));
  return statistics::normal_upper_tail(std::copysign(size, t));
}

double reach(const QuickMean& mean, double confidence) {
  if (mean.variance <= 0.0) return 0.0;
  return quick_t_quantile(confidence, mean.degrees_of_freedom) * std::sqrt(mean.variance);
}

QuickMean mean_of(const ValueSums& values) {
  const double squares = std::max(0.0, values.squares - values.sum * values.sum / values.n);
  return {values.mean(), squares / (values.n - 1.0) / values.n, values.n - 1.0};
}

QuickMean difference_of(const QuickMean& baseline, const QuickMean& current) {
  const double variance = baseline.variance + current.variance;
  const double spread = baseline.variance * baseline.variance / baseline.degrees_of_freedom +
                        current.variance * current.variance / current.degrees_of_freedom;
  return {current.value - baseline.value, variance, spread > 0.0 ? variance * variance / spread : 1.0};
}

/// With one value more, `distance` beyond the mean.
ValueSums with_one_more_value(const ValueSums& values, double distance) {
  const double value = values.mean() + distance;
  return {values.n + 1.0, values.sum + value, values.squares + value * value};
}

}  // namespace

QuickResult quick_paired_proportion(const PairedFailures& failures, double confidence) {
  const auto worse = static_cast<double>(failures.only_current);
  const auto better = static_cast<double>(failures.only_baseline);
  const double differing = worse + better;
  return {(worse - better) / static_cast<double>(failures.pairs), tango(failures, confidence),
          upper_tail_of_count(worse, 0.5 * differing, 0.25 * differing),
          upper_tail_of_count(better, 0.5 * differing, 0.25 * differing)};
}

QuickResult quick_proportion(const FailureCounts& failures, double confidence) {
  const auto n1 = static_cast<double>(failures.baseline_trials);
  const auto n2 = static_cast<double>(failures.current_trials);
  const auto f1 = static_cast<double>(failures.baseline_failures);
  const auto f2 = static_cast<double>(failures.current_failures);
  const double rate = (f1 + f2) / (n1 + n2);
  const double variance = rate * (1.0 - rate) * n1 * n2 / (n1 + n2 - 1.0);
  return {f2 / n2 - f1 / n1, newcombe(failures, confidence), upper_tail_of_count(f2, rate * n2, variance),
          upper_tail_of_count(f1, rate * n1, variance)};
}

QuickResult quick_paired_mean(const ValueSums& differences, double plausible, double confidence) {
  const QuickMean mean = mean_of(differences);
  const double tail = upper_tail(mean);
  return {mean.value, quick_mean_bounds(differences, plausible, confidence, confidence), tail, 1.0 - tail};
}

QuickResult quick_mean(const ValueSums& baseline, const ValueSums& current, double plausible,
                       double confidence) {
  const QuickMean before = mean_of(baseline);
  const QuickMean difference = difference_of(before, mean_of(current));
  const QuickMean low = difference_of(before, mean_of(with_one_more_value(current, -plausible)));
  const QuickMean high = difference_of(before, mean_of(with_one_more_value(current, plausible)));
  const double tail = upper_tail(difference);
  return {difference.value,
          {low.value - reach(low, confidence), high.value + reach(high, confidence)},
          tail,
          1.0 - tail};
}

statistics::ConfidenceInterval quick_mean_bounds(const ValueSums& values, double plausible,
                                                 double low_confidence, double high_confidence) {
  const QuickMean low = mean_of(with_one_more_value(values, -plausible));
  const QuickMean high = mean_of(with_one_more_value(values, plausible));
  return {low.value - reach(low, low_confidence), high.value + reach(high, high_confidence)};
}

}  // namespace zerocount::two_samples
