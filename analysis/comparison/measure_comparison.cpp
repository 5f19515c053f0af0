#include "analysis/comparison/measure_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <fmt/format.h>

#include "analysis/comparison/mean_tests.hpp"
#include "analysis/comparison/proportion_tests.hpp"
#include "analysis/comparison/rank_tests.hpp"

namespace zerocount {
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

/// With rigs, the means of every rig: trials of one rig are not independent.
ComparedValues over_rigs(const ComparedValues& values, std::int64_t baseline_rigs,
                         std::int64_t current_rigs) {
  return {means_by_rig(values.baseline, baseline_rigs), means_by_rig(values.current, current_rigs),
          means_by_rig(values.differences, current_rigs)};
}

/// Settling times trial by trial, over the moves that arrived in both; NaN where none did.
ComparedValues paired_settling_times(const PointTrials& baseline, const PointTrials& current) {
  ComparedValues values;
  const auto moves = static_cast<std::size_t>(std::min(baseline.moves, current.moves));
  for (std::size_t trial = 0; trial < static_cast<std::size_t>(baseline.trials); ++trial) {
    double one = 0.0;
    double two = 0.0;
    double count = 0.0;
    for (std::size_t move = 0; move < moves; ++move) {
      const double before = baseline.settling_time[trial * static_cast<std::size_t>(baseline.moves) + move];
      const double after = current.settling_time[trial * static_cast<std::size_t>(current.moves) + move];
      if (std::isnan(before) || std::isnan(after)) continue;
      one += before;
      two += after;
      count += 1.0;
    }
    values.baseline.push_back(one / count);
    values.current.push_back(two / count);
    values.differences.push_back((two - one) / count);
  }
  return over_rigs(values, baseline.rigs, current.rigs);
}

ComparedValues compared_values(const PointTrials& baseline, const PointTrials& current, GateQuantity quantity,
                               bool paired) {
  if (quantity == GateQuantity::settling_time) {
    if (paired) return paired_settling_times(baseline, current);
    return {settling_times(baseline), settling_times(current), {}};
  }
  ComparedValues values{baseline.jerks, current.jerks, {}};
  if (paired) {
    values.differences.resize(baseline.jerks.size());
    std::transform(current.jerks.begin(), current.jerks.end(), baseline.jerks.begin(),
                   values.differences.begin(), std::minus<>());
  }
  return over_rigs(values, baseline.rigs, current.rigs);
}

/// Failures as numbers, 1 for each trial that failed: their means are the rates of failure.
ComparedValues compared_failures(const PointTrials& baseline, const PointTrials& current,
                                 GateQuantity quantity, bool paired) {
  const auto failures_of = [&](const PointTrials& trials) {
    std::vector<double> failures;
    for (const bool quality : qualities(trials, quantity)) failures.push_back(quality ? 0.0 : 1.0);
    return failures;
  };
  ComparedValues values{failures_of(baseline), failures_of(current), {}};
  if (paired) {
    for (std::size_t i = 0; i < values.baseline.size(); ++i)
      values.differences.push_back(values.current[i] - values.baseline[i]);
  }
  return over_rigs(values, baseline.rigs, current.rigs);
}

PairedFailures paired_failures(const std::vector<bool>& baseline, const std::vector<bool>& current) {
  PairedFailures failures;
  failures.pairs = std::ssize(baseline);
  for (std::size_t trial = 0; trial < baseline.size(); ++trial) {
    failures.only_current += baseline[trial] && !current[trial];
    failures.only_baseline += !baseline[trial] && current[trial];
  }
  return failures;
}

void compare_share(MeasureComparison& result, const std::vector<bool>& baseline,
                   const std::vector<bool>& current, bool paired, double confidence) {
  const auto failures_in = [](const std::vector<bool>& quality) {
    return static_cast<std::int64_t>(std::count(quality.begin(), quality.end(), false));
  };
  const FailureCounts counts{failures_in(baseline), std::ssize(baseline), failures_in(current),
                             std::ssize(current)};
  result.baseline_n = counts.baseline_trials;
  result.current_n = counts.current_trials;
  result.baseline = 1.0 - rate(counts.baseline_failures, counts.baseline_trials);
  result.current = 1.0 - rate(counts.current_failures, counts.current_trials);
  if (paired) {
    const PairedFailures failures = paired_failures(baseline, current);
    result.test = "McNemar, exact";
    result.effect = static_cast<double>(failures.only_current - failures.only_baseline) /
                    static_cast<double>(failures.pairs);
    result.bounds = tango(failures, confidence);
    result.p = mcnemar(failures);
    result.improvement_p = mcnemar({failures.pairs, failures.only_baseline, failures.only_current});
    return;
  }
  result.test = "Fisher, exact";
  result.effect = rate(counts.current_failures, counts.current_trials) -
                  rate(counts.baseline_failures, counts.baseline_trials);
  result.bounds = newcombe(counts, confidence);
  result.p = fisher(counts);
  result.improvement_p = fisher({counts.baseline_trials - counts.baseline_failures, counts.baseline_trials,
                                 counts.current_trials - counts.current_failures, counts.current_trials});
}

/// What one trial may well differ by: a jerk; the time that settling takes.
double unit_of(GateQuantity quantity, const MeasureComparison& result) {
  if (quantity == GateQuantity::jerk_count) return 1.0;
  const double time = std::max(result.baseline, result.current);
  return time > 0.0 ? time : 1e-3;
}

std::string test_of_means(bool paired, bool over_rigs) {
  return fmt::format("{}{}", paired ? "signed rank and paired t" : "Smirnov and Welch's t",
                     over_rigs ? ", over rigs" : "");
}

/// Both the ranks and the means must speak for a change: each test alone can be moved by what the other does
/// not see.
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

/// @param values of trials, or of rigs
void compare_mean(MeasureComparison& result, const ComparedValues& values, GateQuantity quantity, bool paired,
                  bool over_rigs, double confidence) {
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
  test_means(result, values, unit_of(quantity, result), paired, confidence);
}

/// Shares of trials on rigs: the rates of failure of the rigs. One rig more might fail in all of its trials.
void compare_share_over_rigs(MeasureComparison& result, const ComparedValues& failures, bool paired,
                             double confidence) {
  result.baseline_n = std::ssize(failures.baseline);
  result.current_n = std::ssize(failures.current);
  result.baseline = 1.0 - mean_of(failures.baseline);
  result.current = 1.0 - mean_of(failures.current);
  result.test = test_of_means(paired, true);
  test_means(result, failures, 1.0, paired, confidence);
}

}  // namespace

std::vector<MeasureComparison> compare_measures(const GateRules& rules, const std::string& label,
                                                const PointTrials& baseline, const PointTrials& current,
                                                bool paired) {
  std::vector<MeasureComparison> results;
  for (const GateMeasure& measure : gate_measures()) {
    if (!is_judged(rules, measure)) continue;
    MeasureComparison result;
    result.measure = measure.name;
    result.unit = measure.unit;
    const bool rigs = baseline.rigs > 0 || current.rigs > 0;
    if (measure.proportion && rigs) {
      compare_share_over_rigs(result, compared_failures(baseline, current, measure.quantity, paired), paired,
                              rules.confidence);
    } else if (measure.proportion) {
      compare_share(result, qualities(baseline, measure.quantity), qualities(current, measure.quantity),
                    paired, rules.confidence);
    } else {
      compare_mean(result, compared_values(baseline, current, measure.quantity, paired), measure.quantity,
                   paired, rigs, rules.confidence);
    }
    const GateMargin margin = margin_of(rules, label, measure);
    result.margin = margin.absolute;
    if (!std::isnan(result.baseline)) {
      result.margin = std::max(margin.absolute, margin.relative * std::abs(result.baseline));
    }
    result.both_ways = margin.both_ways;
    if (result.both_ways) result.p = std::min(1.0, 2.0 * std::min(result.p, result.improvement_p));
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace zerocount
