#include "analysis/comparison/measure_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <fmt/format.h>

#include "analysis/comparison/mean_tests.hpp"
#include "analysis/comparison/proportion_tests.hpp"
#include "analysis/comparison/rank_tests.hpp"

namespace zerocount::comparison {
namespace {

/// The values of a mean in two files: differences where they are paired.
struct ComparedValues {
  std::vector<double> baseline;
  std::vector<double> current;
  std::vector<double> differences;
};

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<double> negated(std::vector<double> values) {
  for (double& value : values) value = -value;
  return values;
}

/// With rigs, the mean of each rig, because trials of one rig are not independent. Units without a value are
/// left out.
ComparedValues rig_values(const ComparedValues& values, std::int64_t baseline_rigs,
                          std::int64_t current_rigs) {
  return {means_by_rig(values.baseline, baseline_rigs), means_by_rig(values.current, current_rigs),
          means_by_rig(values.differences, current_rigs)};
}

/// Values trial by trial, over the moves that have one in both; NaN where none has.
ComparedValues paired_values(const PointTrials& baseline, const PointTrials& current,
                             const GateMeasure& measure) {
  ComparedValues values;
  const std::vector<double>& before = baseline.of(measure);
  const std::vector<double>& after = current.of(measure);
  const auto trials = static_cast<std::size_t>(baseline.trials);
  const std::size_t before_width = before.size() / trials;
  const std::size_t after_width = after.size() / trials;
  for (std::size_t trial = 0; trial < trials; ++trial) {
    double one = 0.0;
    double two = 0.0;
    double count = 0.0;
    for (std::size_t move = 0; move < std::min(before_width, after_width); ++move) {
      const double old_value = before[trial * before_width + move];
      const double new_value = after[trial * after_width + move];
      if (std::isnan(old_value) || std::isnan(new_value)) continue;
      one += old_value;
      two += new_value;
      count += 1.0;
    }
    values.baseline.push_back(one / count);
    values.current.push_back(two / count);
    values.differences.push_back((two - one) / count);
  }
  return values;
}

/// 1 for each trial that failed, 0 for the others. If less of the quality is worse, a failed trial lacks it;
/// otherwise a failed trial has it.
std::vector<double> failures_of(const PointTrials& trials, const GateMeasure& measure) {
  std::vector<double> failures = trials.of(measure);
  if (measure.measure->gate->worse == layout::Worse::less) {
    for (double& quality : failures) quality = 1.0 - quality;
  }
  return failures;
}

/// The proportion of trials with a quality, where a proportion `failures` of them failed.
double proportion_with(const GateMeasure& measure, double failures) {
  return measure.measure->gate->worse == layout::Worse::less ? 1.0 - failures : failures;
}

/// Failures as numbers: their means are the rates of failure.
ComparedValues compared_failures(const PointTrials& baseline, const PointTrials& current,
                                 const GateMeasure& measure, bool paired) {
  ComparedValues values{failures_of(baseline, measure), failures_of(current, measure), {}};
  if (paired) {
    for (std::size_t i = 0; i < values.baseline.size(); ++i)
      values.differences.push_back(values.current[i] - values.baseline[i]);
  }
  return rig_values(values, baseline.rigs, current.rigs);
}

/// @param baseline, current 1 for each trial that failed, else 0
PairedFailures paired_failures(const std::vector<double>& baseline, const std::vector<double>& current) {
  PairedFailures failures;
  failures.pairs = std::ssize(baseline);
  for (std::size_t trial = 0; trial < baseline.size(); ++trial) {
    failures.only_current += baseline[trial] < current[trial];
    failures.only_baseline += baseline[trial] > current[trial];
  }
  return failures;
}

void compare_proportion(MeasureComparison& result, const GateMeasure& measure,
                        const PointTrials& baseline_trials, const PointTrials& current_trials, bool paired,
                        double confidence) {
  const std::vector<double> baseline = failures_of(baseline_trials, measure);
  const std::vector<double> current = failures_of(current_trials, measure);
  const FailureCounts counts{std::count(baseline.begin(), baseline.end(), 1.0), std::ssize(baseline),
                             std::count(current.begin(), current.end(), 1.0), std::ssize(current)};
  result.baseline_n = counts.baseline_trials;
  result.current_n = counts.current_trials;
  result.baseline =
      proportion_with(measure, statistics::rate(counts.baseline_failures, counts.baseline_trials));
  result.current = proportion_with(measure, statistics::rate(counts.current_failures, counts.current_trials));
  if (paired) {
    const PairedFailures failures = paired_failures(baseline, current);
    result.test = "McNemar, exact";
    result.paired_proportion = true;
    result.effect = static_cast<double>(failures.only_current - failures.only_baseline) /
                    static_cast<double>(failures.pairs);
    result.bounds = tango(failures, confidence);
    result.p = mcnemar(failures);
    result.improvement_p = mcnemar({failures.pairs, failures.only_baseline, failures.only_current});
    return;
  }
  result.test = "Fisher, exact";
  result.effect = statistics::rate(counts.current_failures, counts.current_trials) -
                  statistics::rate(counts.baseline_failures, counts.baseline_trials);
  result.bounds = newcombe(counts, confidence);
  result.p = fisher(counts);
  result.improvement_p = fisher({counts.baseline_trials - counts.baseline_failures, counts.baseline_trials,
                                 counts.current_trials - counts.current_failures, counts.current_trials});
}

/// Plausible difference of a single trial, the `unit` of cautious_bounds(): 1 for counts; for times the
/// larger of both means, or 1 ms without one.
double unit_of(const GateMeasure& measure, double baseline, double current) {
  if (measure.measure->field.column.element != hdf5::Element::float64) return 1.0;
  const double value = std::max(std::abs(baseline), std::abs(current));
  return value > 0.0 ? value : 1e-3;
}

std::string test_of_means(bool paired, bool over_rigs) {
  return fmt::format("{}{}", paired ? "signed rank and paired t" : "Smirnov and Welch's t",
                     over_rigs ? ", over rigs" : "");
}

/// p is the larger of the p-values of a rank test and a t-test: both must show a change.
void test_means(MeasureComparison& result, const ComparedValues& values, double unit, bool paired,
                double confidence) {
  MeanDifference worse;
  if (paired) {
    worse = mean_difference(values.differences);
    result.bounds = cautious_bounds(values.differences, unit, confidence);
    result.p = std::max(signed_rank(values.differences), p_of(worse));
    result.improvement_p = std::max(signed_rank(negated(values.differences)), 1.0 - p_of(worse));
  } else {
    worse = mean_difference(values.baseline, values.current);
    result.bounds = cautious_bounds(values.baseline, values.current, unit, confidence);
    result.p = std::max(smirnov(values.baseline, values.current), p_of(worse));
    result.improvement_p = std::max(smirnov(values.current, values.baseline), 1.0 - p_of(worse));
  }
  result.effect = worse.value;
}

void compare_mean(MeasureComparison& result, const GateMeasure& measure, const PointTrials& baseline,
                  const PointTrials& current, bool paired, double confidence) {
  const bool over_rigs = baseline.rigs > 0 || current.rigs > 0;
  ComparedValues values =
      paired ? rig_values(paired_values(baseline, current, measure), baseline.rigs, current.rigs)
             : ComparedValues{trial_means(baseline, measure), trial_means(current, measure), {}};
  result.baseline_n = std::ssize(values.baseline);
  result.current_n = std::ssize(values.current);
  if (result.baseline_n > 0) result.baseline = mean_of(values.baseline);
  if (result.current_n > 0) result.current = mean_of(values.current);
  result.test = test_of_means(paired, over_rigs);
  if (std::min(result.baseline_n, result.current_n) < least_values) {
    result.note = fmt::format("fewer than {} {} have a value{}", least_values, over_rigs ? "rigs" : "trials",
                              paired ? " in both files" : "");
    return;
  }
  if (measure.measure->gate->worse == layout::Worse::less) {
    values = {negated(values.baseline), negated(values.current), negated(values.differences)};
  }
  test_means(result, values, unit_of(measure, result.baseline, result.current), paired, confidence);
}

/// Compares the failure rates of the rigs. One more rig might fail in all of its trials, so the unit is 1.
void compare_proportion_over_rigs(MeasureComparison& result, const GateMeasure& measure,
                                  const ComparedValues& failures, bool paired, double confidence) {
  result.baseline_n = std::ssize(failures.baseline);
  result.current_n = std::ssize(failures.current);
  result.baseline = proportion_with(measure, mean_of(failures.baseline));
  result.current = proportion_with(measure, mean_of(failures.current));
  result.test = test_of_means(paired, true);
  test_means(result, failures, 1.0, paired, confidence);
}

/// The value with the sign with which larger is worse.
MeasureSample sample_of_mean(const GateMeasure& measure, const PointTrials& baseline,
                             const PointTrials& current, bool paired) {
  ComparedValues values =
      paired ? paired_values(baseline, current, measure)
             : ComparedValues{values_of_trials(baseline, measure), values_of_trials(current, measure), {}};
  MeasureSample sample;
  sample.paired = paired;
  sample.baseline = means_of_units(values.baseline, baseline.rigs);
  sample.current = means_of_units(values.current, current.rigs);
  const auto mean = [](const std::vector<double>& all) { return mean_of(means_by_rig(all, 0)); };
  sample.plausible = unit_of(measure, mean(sample.baseline), mean(sample.current));
  if (measure.measure->gate->worse == layout::Worse::less) {
    sample.baseline = negated(sample.baseline);
    sample.current = negated(sample.current);
  }
  return sample;
}

MeasureSample sample_of_proportion(const GateMeasure& measure, const PointTrials& baseline,
                                   const PointTrials& current, bool paired) {
  MeasureSample sample;
  sample.paired = paired;
  sample.proportion = baseline.rigs == 0 && current.rigs == 0;
  sample.baseline = means_of_units(failures_of(baseline, measure), baseline.rigs);
  sample.current = means_of_units(failures_of(current, measure), current.rigs);
  return sample;
}

}  // namespace

std::vector<MeasureSample> measure_samples(const GateRules& rules, const PointTrials& baseline,
                                           const PointTrials& current, bool paired) {
  std::vector<MeasureSample> samples;
  for (const GateMeasure& measure : gate_measures(*current.table)) {
    if (!is_judged(rules, measure)) continue;
    samples.push_back(measure.proportion() ? sample_of_proportion(measure, baseline, current, paired)
                                           : sample_of_mean(measure, baseline, current, paired));
  }
  return samples;
}

std::vector<MeasureComparison> compare_measures(const GateRules& rules, const std::string& label,
                                                const PointTrials& baseline, const PointTrials& current,
                                                bool paired) {
  std::vector<MeasureComparison> results;
  for (const GateMeasure& measure : gate_measures(*current.table)) {
    if (!is_judged(rules, measure)) continue;
    MeasureComparison result;
    result.measure = measure.name;
    result.unit = measure.unit;
    if (!measure.proportion()) {
      compare_mean(result, measure, baseline, current, paired, rules.confidence);
    } else if (baseline.rigs > 0 || current.rigs > 0) {
      compare_proportion_over_rigs(result, measure, compared_failures(baseline, current, measure, paired),
                                   paired, rules.confidence);
    } else {
      compare_proportion(result, measure, baseline, current, paired, rules.confidence);
    }
    const GateMargin margin = margin_of(rules, label, measure);
    result.margin = margin.absolute;
    if (!std::isnan(result.baseline)) {
      result.margin = std::max(margin.absolute, margin.relative * std::abs(result.baseline));
    }
    result.changed_fails = rules.changed_fails || margin.changed_fails;
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace zerocount::comparison
