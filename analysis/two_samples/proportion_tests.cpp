#include "analysis/two_samples/proportion_tests.hpp"

#include <cmath>
#include <cstdint>

#include "analysis/statistics/distributions.hpp"
#include "core/numerics/bisection.hpp"

namespace zerocount::two_samples {
namespace {

/// Tango's statistic Z(λ).
double score(const PairedFailures& failures, double difference) {
  const double n = static_cast<double>(failures.pairs);
  const double b = static_cast<double>(failures.only_current);
  const double c = static_cast<double>(failures.only_baseline);
  const double linear = -b - c + (2.0 * n - b + c) * difference;
  const double constant = -c * difference * (1.0 - difference);
  const double root = std::sqrt(std::max(0.0, linear * linear - 8.0 * n * constant));
  // This form of the positive root has no cancellation.
  const double proportion = linear > 0.0 ? -2.0 * constant / (root + linear) : (root - linear) / (4.0 * n);
  const double variance = n * (2.0 * proportion + difference * (1.0 - difference));
  const double distance = b - c - n * difference;
  if (variance > 0.0) return distance / std::sqrt(variance);
  return distance == 0.0 ? 0.0 : std::copysign(1e300, distance);
}

/// The λ at which Z, which falls with λ, crosses `level`.
double crossing(const PairedFailures& failures, double level, double low, double high) {
  const auto is_above = [&](double difference) { return score(failures, difference) > level; };
  if (!is_above(low)) return low;
  if (score(failures, high) >= level) return high;
  const auto [above, below] = numerics::bisect({low, high}, is_above, numerics::within(1e-14));
  return 0.5 * (above + below);
}

}  // namespace

double mcnemar(const PairedFailures& failures) {
  if (failures.only_current == 0) return 1.0;
  const std::int64_t differing = failures.only_current + failures.only_baseline;
  return statistics::binomial_upper_tail(differing, 0.5, failures.only_current - 1);
}

statistics::ConfidenceInterval tango(const PairedFailures& failures, double confidence) {
  if (failures.pairs == 0) return {-1.0, 1.0};
  const double z = statistics::normal_quantile(confidence);
  const double difference = static_cast<double>(failures.only_current - failures.only_baseline) /
                            static_cast<double>(failures.pairs);
  return {crossing(failures, z, -1.0, difference), crossing(failures, -z, difference, 1.0)};
}

double fisher(const FailureCounts& failures) {
  if (failures.current_failures == 0) return 1.0;
  return statistics::hypergeometric_at_least(
      failures.baseline_failures + failures.current_failures, failures.current_trials,
      failures.baseline_trials + failures.current_trials, failures.current_failures);
}

statistics::ConfidenceInterval newcombe(const FailureCounts& failures, double confidence) {
  if (failures.baseline_trials == 0 || failures.current_trials == 0) return {-1.0, 1.0};
  const double two_sided = 2.0 * confidence - 1.0;
  const statistics::ConfidenceInterval one =
      statistics::wilson(failures.baseline_failures, failures.baseline_trials, two_sided);
  const statistics::ConfidenceInterval two =
      statistics::wilson(failures.current_failures, failures.current_trials, two_sided);
  const double p1 = statistics::rate(failures.baseline_failures, failures.baseline_trials);
  const double p2 = statistics::rate(failures.current_failures, failures.current_trials);
  return {p2 - p1 - std::hypot(p2 - two.low, one.high - p1),
          p2 - p1 + std::hypot(two.high - p2, p1 - one.low)};
}

}  // namespace zerocount::two_samples
