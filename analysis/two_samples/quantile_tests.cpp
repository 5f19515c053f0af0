#include "analysis/two_samples/quantile_tests.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/statistics/quantile.hpp"
#include "analysis/two_samples/mean_tests.hpp"
#include "analysis/two_samples/proportion_tests.hpp"
#include "analysis/two_samples/rank_tests.hpp"
#include "core/numerics/bisection.hpp"

namespace zerocount::two_samples {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double bound_precision = 1e-3;  ///< of a bound, as a proportion of the largest value

std::vector<double> negated_differences(std::span<const double> values) {
  std::vector<double> negated(values.begin(), values.end());
  for (double& value : negated) value = -value;
  return negated;
}

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

/// The p-values of no difference but `shift` between two files.
class ShiftTest {
 public:
  ShiftTest(const ClusteredValues& baseline, const ClusteredValues& current, bool paired, double probability)
      : baseline_(baseline),
        current_(current),
        paired_(paired),
        probability_(probability),
        shifted_(baseline.values.begin(), baseline.values.end()) {}

  DirectionalP operator()(double shift) {
    for (std::size_t i = 0; i < shifted_.size(); ++i) shifted_[i] = baseline_.values[i] + shift;
    const ClusteredValues before{shifted_, baseline_.values_of_trial, baseline_.clusters};
    const double x = pooled_quantile(before, current_, probability_);
    const std::vector<double> late = proportions_from(before, x);
    const std::vector<double> later = proportions_from(current_, x);
    if (are_single(before) && are_single(current_)) return p_of_failures(late, later, paired_);
    if (!paired_) return p_of_means(late, later);
    std::vector<double> differences(late.size());
    for (std::size_t i = 0; i < late.size(); ++i) differences[i] = later[i] - late[i];
    return p_of_differences(differences);
  }

 private:
  ClusteredValues baseline_;
  ClusteredValues current_;
  bool paired_;
  double probability_;
  std::vector<double> shifted_;
};

/// The smallest number from which on `holds`, between −range and range, rounded up to the precision; ±∞
/// where that is beyond.
template <class Predicate>
double first_from(double range, double precision, const Predicate& holds) {
  if (!holds(range)) return infinity;
  if (holds(-range)) return -infinity;
  return numerics::bisect({range, -range}, holds, numerics::within(precision)).holds;
}

}  // namespace

DirectionalP p_of_failures(std::span<const double> baseline, std::span<const double> current, bool paired) {
  if (!paired) {
    const auto failed = [](std::span<const double> all) { return std::count(all.begin(), all.end(), 1.0); };
    const FailureCounts counts{failed(baseline), std::ssize(baseline), failed(current), std::ssize(current)};
    return {fisher(counts), fisher({counts.baseline_trials - counts.baseline_failures, counts.baseline_trials,
                                    counts.current_trials - counts.current_failures, counts.current_trials})};
  }
  PairedFailures failures{std::ssize(baseline), 0, 0};
  for (std::size_t i = 0; i < baseline.size(); ++i) {
    failures.only_current += baseline[i] < current[i];
    failures.only_baseline += baseline[i] > current[i];
  }
  return {mcnemar(failures), mcnemar({failures.pairs, failures.only_baseline, failures.only_current})};
}

DirectionalP p_of_differences(std::span<const double> differences) {
  const double t = p_of(mean_difference(differences));
  return {std::max(signed_rank(differences), t),
          std::max(signed_rank(negated_differences(differences)), 1.0 - t)};
}

DirectionalP p_of_means(std::span<const double> baseline, std::span<const double> current) {
  const double t = p_of(mean_difference(baseline, current));
  return {std::max(smirnov(baseline, current), t), std::max(smirnov(current, baseline), 1.0 - t)};
}

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

double pooled_quantile(const ClusteredValues& baseline, const ClusteredValues& current, double probability) {
  std::vector<double> pooled(baseline.values.begin(), baseline.values.end());
  pooled.insert(pooled.end(), current.values.begin(), current.values.end());
  return statistics::sample_quantile(std::move(pooled), probability);
}

QuantileDifference quantile_difference(const ClusteredValues& baseline, const ClusteredValues& current,
                                       bool paired, double probability, double confidence) {
  QuantileDifference result;
  result.baseline =
      statistics::sample_quantile({baseline.values.begin(), baseline.values.end()}, probability);
  result.current = statistics::sample_quantile({current.values.begin(), current.values.end()}, probability);
  result.effect = result.current - result.baseline;
  ShiftTest test(baseline, current, paired, probability);
  result.p = test(0.0);
  const double range = std::max(max_finite(baseline), max_finite(current)) + 1e-9;
  const double alpha = 1.0 - confidence;
  result.bounds = {
      -first_from(range, bound_precision * range, [&](double x) { return test(-x).worse <= alpha; }),
      first_from(range, bound_precision * range, [&](double x) { return test(x).better <= alpha; })};
  // The tests are about a shift of all values; quantiles of other shapes may differ by more or less than
  // that.
  result.bounds.low = std::min(result.bounds.low, result.effect);
  result.bounds.high = std::max(result.bounds.high, result.effect);
  return result;
}

}  // namespace zerocount::two_samples
