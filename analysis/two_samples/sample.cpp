#include "analysis/two_samples/sample.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>

#include "analysis/statistics/distributions.hpp"
#include "analysis/two_samples/exact_tests.hpp"

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

/// `values` and one more, `distance` beyond their mean.
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

Change change_of(const Sample& sample, double confidence) {
  const DirectionalP p = p_of(sample);
  Change change{.p = p.worse, .improvement_p = p.better};
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
    change.bounds = tango(pairs, confidence);
    return change;
  }
  change.effect = mean_of(sample.current) - mean_of(sample.baseline);
  change.bounds = newcombe(failure_counts(sample), confidence);
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

}  // namespace zerocount::two_samples
