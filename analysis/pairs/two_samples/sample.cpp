#include "analysis/pairs/two_samples/sample.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/pairs/two_samples/exact_tests.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::two_samples {
namespace {

struct SampleMoments {
  double n{0.0};
  double mean{0.0};
  double variance_of_mean{0.0};
};

SampleMoments moments_of(std::span<const double> values) {
  SampleMoments moments{static_cast<double>(values.size()), 0.0, 0.0};
  moments.mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - moments.mean) * (value - moments.mean);
  moments.variance_of_mean = squares / (moments.n - 1.0) / moments.n;
  return moments;
}

double half_width(const MeanDifference& difference, double confidence) {
  if (difference.standard_error == 0.0) return 0.0;
  return statistics::student_t_quantile(difference.degrees_of_freedom, confidence) *
         difference.standard_error;
}

/// The values and one more, `distance` beyond their mean.
std::vector<double> with_one_more(std::span<const double> values, double distance) {
  std::vector<double> more(values.begin(), values.end());
  more.push_back(moments_of(values).mean + distance);
  return more;
}

std::vector<double> negated(std::vector<double> values) {
  for (double& value : values) value = -value;
  return values;
}

PairedFailures paired_failures(const Sample& sample) {
  PairedFailures failures{std::ssize(sample.baseline), 0, 0};
  for (std::size_t unit = 0; unit < sample.baseline.size(); ++unit) {
    failures.only_current += sample.baseline[unit] < sample.current[unit];
    failures.only_baseline += sample.baseline[unit] > sample.current[unit];
  }
  return failures;
}

FailureCounts failure_counts(const Sample& sample) {
  const auto failed = [](const std::vector<double>& all) { return std::count(all.begin(), all.end(), 1.0); };
  return {failed(sample.baseline), std::ssize(sample.baseline), failed(sample.current),
          std::ssize(sample.current)};
}

DirectionalP p_of_failures(const Sample& sample) {
  if (sample.paired) {
    const PairedFailures pairs = paired_failures(sample);
    return {mcnemar(pairs), mcnemar({pairs.pairs, pairs.only_baseline, pairs.only_current})};
  }
  const FailureCounts counts = failure_counts(sample);
  return {fisher(counts), fisher({counts.baseline_trials - counts.baseline_failures, counts.baseline_trials,
                                  counts.current_trials - counts.current_failures, counts.current_trials})};
}

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Precision to which a bound of a quantile's change is computed, as a proportion of the largest value.
constexpr double bound_precision = 1e-3;

/// Whether every cluster has a single value, so that its proportion of values above a limit is 0 or 1.
bool are_single(const ClusteredValues& values) {
  return values.clusters == 0 && values.values_of_trial == 1;
}

/// The largest finite value; 0 if no value is finite.
double max_finite(const ClusteredValues& values) {
  double largest = 0.0;
  for (const double value : values.values) {
    if (std::isfinite(value)) largest = std::max(largest, value);
  }
  return largest;
}

/// [cluster] Proportion of the cluster's values that are at or above x.
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

/// Difference of the means, current − baseline, with one unit added `unit` beyond the mean: a negative `unit`
/// for the lower bound, a positive one for the upper.
MeanDifference cautious_difference(const Sample& sample, double unit) {
  if (sample.paired) return mean_difference(with_one_more(known(sample.differences), unit));
  return mean_difference(known(sample.baseline), with_one_more(known(sample.current), unit));
}

statistics::ConfidenceInterval bounds_of_failures(const Sample& sample, double confidence) {
  return sample.paired ? tango(paired_failures(sample), confidence)
                       : newcombe(failure_counts(sample), confidence);
}

/// One-sided error probabilities at which the bounds of the difference of failure proportions just reach
/// +margin (worse) and −margin (better); ½ if the difference itself does not exceed the margin.
DirectionalP levels_of_failures(const Sample& sample, double margin) {
  constexpr double closest = 1e-12;     // to a confidence of 1
  constexpr double least = 0.5 + 1e-9;  // bounds with a confidence of ½ are the estimate
  const auto level_of = [&](const auto& is_beyond) {
    if (!is_beyond(least)) return 0.5;
    if (is_beyond(1.0 - closest)) return closest;
    return 1.0 - numerics::bisect({least, 1.0 - closest}, is_beyond, numerics::within(closest)).holds;
  };
  return {level_of([&](double c) { return bounds_of_failures(sample, c).low > margin; }),
          level_of([&](double c) { return bounds_of_failures(sample, c).high < -margin; })};
}

/// One-sided error probabilities at which the bounds of the difference of means just reach +margin (worse)
/// and −margin (better).
DirectionalP levels_of_mean(const Sample& sample, double margin) {
  MeanDifference low = cautious_difference(sample, -sample.plausible);
  MeanDifference high = cautious_difference(sample, sample.plausible);
  low.value -= margin;
  high.value += margin;
  return {p_of(low), 1.0 - p_of(high)};
}

DirectionalP larger(const DirectionalP& one, const DirectionalP& other) {
  return {std::max(one.worse, other.worse), std::max(one.better, other.better)};
}

/// p-values of a change within ± margin, for Change::beyond.
/// @param none p_of() the sample: p-values of no change
DirectionalP beyond(const DirectionalP& none, const Sample& sample, double margin) {
  if (margin == 0.0) return none;
  return larger(none, sample.failures ? levels_of_failures(sample, margin) : levels_of_mean(sample, margin));
}

/// A sample of proportions by which quantiles are compared: for each cluster, the proportion of values at or
/// above the sample quantile of both files' values together.
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

/// The smallest number from which on `holds` is true, searched between −range and range, rounded up to the
/// precision. +∞ if `holds` is false at range, −∞ if it is true at −range.
template <class Predicate>
double first_from(double range, double precision, const Predicate& holds) {
  if (!holds(range)) return infinity;
  if (holds(-range)) return -infinity;
  return numerics::bisect({range, -range}, holds, numerics::within(precision)).holds;
}

}  // namespace

DirectionalP p_of(const Sample& sample) {
  if (sample.failures) return p_of_failures(sample);
  const double t = p_of(mean_difference(sample));
  if (sample.paired) {
    const std::vector<double> differences = known(sample.differences);
    return {std::max(signed_rank(differences), t), std::max(signed_rank(negated(differences)), 1.0 - t)};
  }
  const std::vector<double> baseline = known(sample.baseline);
  const std::vector<double> current = known(sample.current);
  return {std::max(smirnov(baseline, current), t), std::max(smirnov(current, baseline), 1.0 - t)};
}

Change change_of(const Sample& sample, double confidence, double margin) {
  const DirectionalP p = p_of(sample);
  Change change{.p = p.worse, .improvement_p = p.better, .beyond = beyond(p, sample, margin)};
  if (!sample.failures) {
    change.effect = mean_difference(sample).value;
    change.bounds = sample.paired ? cautious_bounds(known(sample.differences), sample.plausible, confidence)
                                  : cautious_bounds(known(sample.baseline), known(sample.current),
                                                    sample.plausible, confidence);
    return change;
  }
  if (sample.paired) {
    const PairedFailures pairs = paired_failures(sample);
    change.effect =
        static_cast<double>(pairs.only_current - pairs.only_baseline) / static_cast<double>(pairs.pairs);
  } else {
    change.effect = mean_of(sample.current) - mean_of(sample.baseline);
  }
  change.bounds = bounds_of_failures(sample, confidence);
  return change;
}

std::vector<double> known(std::span<const double> values) {
  std::vector<double> all;
  std::ranges::copy_if(values, std::back_inserter(all), [](double value) { return !std::isnan(value); });
  return all;
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

MeanDifference mean_difference(std::span<const double> differences) {
  const SampleMoments moments = moments_of(differences);
  return {moments.mean, std::sqrt(moments.variance_of_mean), moments.n - 1.0};
}

MeanDifference mean_difference(std::span<const double> baseline, std::span<const double> current) {
  const SampleMoments one = moments_of(baseline);
  const SampleMoments two = moments_of(current);
  const double variance = one.variance_of_mean + two.variance_of_mean;
  const double spread = one.variance_of_mean * one.variance_of_mean / (one.n - 1.0) +
                        two.variance_of_mean * two.variance_of_mean / (two.n - 1.0);
  return {two.mean - one.mean, std::sqrt(variance), spread > 0.0 ? variance * variance / spread : 1.0};
}

MeanDifference mean_difference(const Sample& sample) {
  return sample.paired ? mean_difference(known(sample.differences))
                       : mean_difference(known(sample.baseline), known(sample.current));
}

double p_of(const MeanDifference& difference) {
  if (difference.standard_error == 0.0) {
    if (difference.value == 0.0) return 0.5;
    return difference.value > 0.0 ? 0.0 : 1.0;
  }
  return statistics::student_t_upper_tail(difference.degrees_of_freedom,
                                          difference.value / difference.standard_error);
}

statistics::ConfidenceInterval cautious_bounds(std::span<const double> differences, double unit,
                                               double confidence) {
  const MeanDifference lower = mean_difference(with_one_more(differences, -unit));
  const MeanDifference upper = mean_difference(with_one_more(differences, unit));
  return {lower.value - half_width(lower, confidence), upper.value + half_width(upper, confidence)};
}

statistics::ConfidenceInterval cautious_bounds(std::span<const double> baseline,
                                               std::span<const double> current, double unit,
                                               double confidence) {
  const MeanDifference lower = mean_difference(baseline, with_one_more(current, -unit));
  const MeanDifference upper = mean_difference(baseline, with_one_more(current, unit));
  return {lower.value - half_width(lower, confidence), upper.value + half_width(upper, confidence)};
}

double quantile_of(const ClusteredValues& values, double probability) {
  return statistics::sample_quantile({values.values.begin(), values.values.end()}, probability);
}

Change change_of(const QuantileSample& sample, double confidence, double margin) {
  const ClusteredValues& baseline = sample.baseline;
  std::vector<double> shifted(baseline.values.size());
  const auto p_of_shift = [&](double shift) {
    for (std::size_t i = 0; i < shifted.size(); ++i) shifted[i] = baseline.values[i] + shift;
    QuantileSample of_shift = sample;
    of_shift.baseline.values = shifted;
    return p_of(late_values(of_shift));
  };
  const DirectionalP p = p_of_shift(0.0);
  const DirectionalP at_margin{p_of_shift(margin).worse, p_of_shift(-margin).better};
  const double effect =
      quantile_of(sample.current, sample.probability) - quantile_of(baseline, sample.probability);
  const double range = std::max(max_finite(baseline), max_finite(sample.current)) + 1e-9;
  const double alpha = 1.0 - confidence;
  const auto bound = [&](const auto& rejects) { return first_from(range, bound_precision * range, rejects); };
  const double low = -bound([&](double x) { return p_of_shift(-x).worse <= alpha; });
  const double high = bound([&](double x) { return p_of_shift(x).better <= alpha; });
  // The tests are about a shift of all values; quantiles of other shapes may differ by more or less than
  // that.
  return {effect, {std::min(low, effect), std::max(high, effect)}, p.worse, p.better, larger(p, at_margin)};
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
