#include "analysis/comparison/measure_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <fmt/format.h>

#include "analysis/two_samples/mean_tests.hpp"
#include "analysis/two_samples/proportion_tests.hpp"
#include "analysis/two_samples/quantile_tests.hpp"

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

/// The proportion of the moves of each trial that meet the goal, [trial].
std::vector<double> moves_in_goal(const PointTrials& trials, const GoalTrials& goal) {
  std::vector<double> met = goal.moves_in_goal;
  for (double& value : met) value /= static_cast<double>(goal.asked_moves(trials.moves));
  return met;
}

/// 1 for each rig that meets the goal in Goal::moves of its moves, else 0, [rig].
std::vector<double> rigs_in_goal(const PointTrials& trials, const GoalTrials& goal) {
  const auto rigs = static_cast<std::size_t>(goal.rigs);
  std::vector<double> met(rigs, 0.0);
  std::vector<double> moves(rigs, 0.0);
  for (std::size_t trial = 0; trial < goal.moves_in_goal.size(); ++trial) {
    met[trial % rigs] += goal.moves_in_goal[trial];
    moves[trial % rigs] += static_cast<double>(goal.asked_moves(trials.moves));
  }
  for (std::size_t rig = 0; rig < rigs; ++rig)
    met[rig] = met[rig] >= goal.goal.moves * moves[rig] ? 1.0 : 0.0;
  return met;
}

/// The quality of each trial, or of each rig.
std::vector<double> qualities_of(const PointTrials& trials, const GateMeasure& measure) {
  switch (measure.statistic) {
    case GateStatistic::moves:
      return moves_in_goal(trials, trials.judged[measure.goal]);
    case GateStatistic::machines:
      return rigs_in_goal(trials, trials.judged[measure.goal]);
    case GateStatistic::trials:
    case GateStatistic::mean:
    case GateStatistic::quantile:
      break;
  }
  return trials.of(measure);
}

/// How far each trial (of machines: each rig) failed: 1 where it did, 0 where it did not. If less of the
/// quality is worse, it failed where it lacks the quality; otherwise where it has it.
std::vector<double> failures_of(const PointTrials& trials, const GateMeasure& measure) {
  std::vector<double> failures = qualities_of(trials, measure);
  if (measure.worse == layout::Worse::less) {
    for (double& quality : failures) quality = 1.0 - quality;
  }
  return failures;
}

/// The clusters in which the failures_of() are: the number of rigs or worlds, 0 where each is independent.
std::int64_t clusters_of_failures(const PointTrials& trials, const GateMeasure& measure) {
  const bool of_rigs =
      measure.statistic == GateStatistic::machines && trials.rigs == trials.judged[measure.goal].rigs;
  return of_rigs ? 0 : trials.rigs;
}

/// Whether the failures_of() are independent, and each 0 or 1.
bool are_whole(const PointTrials& trials, const GateMeasure& measure) {
  return clusters_of_failures(trials, measure) == 0 &&
         (measure.statistic != GateStatistic::moves ||
          trials.judged[measure.goal].asked_moves(trials.moves) == 1);
}

/// The proportion of trials with a quality, where a proportion `failures` of them failed.
double proportion_with(const GateMeasure& measure, double failures) {
  return measure.worse == layout::Worse::less ? 1.0 - failures : failures;
}

/// Failures as numbers: their means are the rates of failure.
ComparedValues compared_failures(const PointTrials& baseline, const PointTrials& current,
                                 const GateMeasure& measure, bool paired) {
  ComparedValues values{failures_of(baseline, measure), failures_of(current, measure), {}};
  if (paired) {
    for (std::size_t i = 0; i < values.baseline.size(); ++i)
      values.differences.push_back(values.current[i] - values.baseline[i]);
  }
  return rig_values(values, clusters_of_failures(baseline, measure), clusters_of_failures(current, measure));
}

/// @param baseline, current 1 for each trial that failed, else 0
two_samples::PairedFailures paired_failures(const std::vector<double>& baseline,
                                            const std::vector<double>& current) {
  two_samples::PairedFailures failures;
  failures.pairs = std::ssize(baseline);
  for (std::size_t trial = 0; trial < baseline.size(); ++trial) {
    failures.only_current += baseline[trial] < current[trial];
    failures.only_baseline += baseline[trial] > current[trial];
  }
  return failures;
}

void take_p(MeasureComparison& result, const two_samples::DirectionalP& p) {
  result.p = p.worse;
  result.improvement_p = p.better;
}

void compare_proportion(MeasureComparison& result, const GateMeasure& measure,
                        const PointTrials& baseline_trials, const PointTrials& current_trials, bool paired,
                        double confidence) {
  const std::vector<double> baseline = failures_of(baseline_trials, measure);
  const std::vector<double> current = failures_of(current_trials, measure);
  const two_samples::FailureCounts counts{
      std::count(baseline.begin(), baseline.end(), 1.0), std::ssize(baseline),
      std::count(current.begin(), current.end(), 1.0), std::ssize(current)};
  result.baseline_n = counts.baseline_trials;
  result.current_n = counts.current_trials;
  result.baseline =
      proportion_with(measure, statistics::rate(counts.baseline_failures, counts.baseline_trials));
  result.current = proportion_with(measure, statistics::rate(counts.current_failures, counts.current_trials));
  take_p(result, two_samples::p_of_failures(baseline, current, paired));
  if (paired) {
    const two_samples::PairedFailures failures = paired_failures(baseline, current);
    result.test = "McNemar, exact";
    result.paired_proportion = true;
    result.effect = static_cast<double>(failures.only_current - failures.only_baseline) /
                    static_cast<double>(failures.pairs);
    result.bounds = two_samples::tango(failures, confidence);
    return;
  }
  result.test = "Fisher, exact";
  result.effect = statistics::rate(counts.current_failures, counts.current_trials) -
                  statistics::rate(counts.baseline_failures, counts.baseline_trials);
  result.bounds = two_samples::newcombe(counts, confidence);
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
  if (paired) {
    result.effect = two_samples::mean_difference(values.differences).value;
    result.bounds = two_samples::cautious_bounds(values.differences, unit, confidence);
    take_p(result, two_samples::p_of_differences(values.differences));
  } else {
    result.effect = two_samples::mean_difference(values.baseline, values.current).value;
    result.bounds = two_samples::cautious_bounds(values.baseline, values.current, unit, confidence);
    take_p(result, two_samples::p_of_means(values.baseline, values.current));
  }
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
  if (std::min(result.baseline_n, result.current_n) < min_values) {
    result.note = fmt::format("fewer than {} {} have a value{}", min_values, over_rigs ? "rigs" : "trials",
                              paired ? " in both files" : "");
    return;
  }
  if (measure.worse == layout::Worse::less) {
    values = {negated(values.baseline), negated(values.current), negated(values.differences)};
  }
  test_means(result, values, unit_of(measure, result.baseline, result.current), paired, confidence);
}

/// Compares the failure rates of rigs, or of trials with several moves. One more might fail in all of its
/// moves, so the unit is 1.
void compare_rates_of_units(MeasureComparison& result, const GateMeasure& measure,
                            const ComparedValues& failures, bool paired, bool over_rigs, double confidence) {
  result.baseline_n = std::ssize(failures.baseline);
  result.current_n = std::ssize(failures.current);
  result.baseline = proportion_with(measure, mean_of(failures.baseline));
  result.current = proportion_with(measure, mean_of(failures.current));
  result.test = test_of_means(paired, over_rigs);
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
  if (measure.worse == layout::Worse::less) {
    sample.baseline = negated(sample.baseline);
    sample.current = negated(sample.current);
  }
  return sample;
}

MeasureSample sample_of_proportion(const GateMeasure& measure, const PointTrials& baseline,
                                   const PointTrials& current, bool paired) {
  MeasureSample sample;
  sample.paired = paired;
  sample.proportion = are_whole(baseline, measure) && are_whole(current, measure);
  sample.baseline = means_of_units(failures_of(baseline, measure), clusters_of_failures(baseline, measure));
  sample.current = means_of_units(failures_of(current, measure), clusters_of_failures(current, measure));
  return sample;
}

/// Probability of the quantile of the goal's settling time that is compared.
constexpr double judged_quantile = 0.95;

two_samples::ClusteredValues clustered_times(const PointTrials& trials, const GateMeasure& measure) {
  return {trials.of(measure), trials.judged[measure.goal].asked_moves(trials.moves), trials.rigs};
}

std::int64_t units_in(const PointTrials& trials) {
  return trials.rigs > 0 ? std::min(trials.rigs, trials.trials) : trials.trials;
}

void compare_quantile(MeasureComparison& result, const GateMeasure& measure, const PointTrials& baseline,
                      const PointTrials& current, bool paired, double confidence) {
  const bool over_rigs = baseline.rigs > 0 || current.rigs > 0;
  result.baseline_n = units_in(baseline);
  result.current_n = units_in(current);
  result.test = fmt::format("{} % quantile of all moves of the goal, by the moves later than that of both{}",
                            100.0 * judged_quantile, over_rigs ? ", over rigs" : "");
  if (std::min(result.baseline_n, result.current_n) < min_values) {
    result.note = fmt::format("fewer than {} {}", min_values, over_rigs ? "rigs" : "trials");
    return;
  }
  const two_samples::QuantileDifference found =
      two_samples::quantile_difference(clustered_times(baseline, measure), clustered_times(current, measure),
                                       paired, judged_quantile, confidence);
  result.baseline = found.baseline;
  result.current = found.current;
  if (std::isnan(found.effect)) {
    result.note = "not within the hold in either";
    return;
  }
  result.effect = found.effect;
  result.bounds = found.bounds;
  take_p(result, found.p);
}

/// A quantile is to first order the mean of what each unit has to do with it (Bahadur, Annals of Mathematical
/// Statistics 37 (1966), 577): its proportion of moves later than the quantile, times the scale with which
/// their mean varies as much as the bounds say.
MeasureSample sample_of_quantile(const MeasureComparison& found, const GateMeasure& measure,
                                 const PointTrials& baseline, const PointTrials& current, bool paired,
                                 double confidence) {
  const two_samples::ClusteredValues before = clustered_times(baseline, measure);
  const two_samples::ClusteredValues after = clustered_times(current, measure);
  const double x = two_samples::pooled_quantile(before, after, judged_quantile);
  MeasureSample sample;
  sample.paired = paired;
  sample.baseline = two_samples::proportions_from(before, x);
  sample.current = two_samples::proportions_from(after, x);
  std::vector<double> differences;
  for (std::size_t i = 0; paired && i < sample.current.size(); ++i)
    differences.push_back(sample.current[i] - sample.baseline[i]);
  const two_samples::MeanDifference mean =
      paired ? two_samples::mean_difference(differences)
             : two_samples::mean_difference(sample.baseline, sample.current);
  const double error = standard_error_of(found.bounds, confidence);
  const double scale = mean.standard_error > 0.0 ? error / mean.standard_error : error;
  const double rest = found.effect - scale * mean.value;
  for (double& value : sample.baseline) value *= scale;
  for (double& value : sample.current) value = scale * value + rest;
  sample.plausible = std::max(scale, 1e-9);
  return sample;
}

/// The larger of the two parts of a margin. Nothing is a proportion of a value that is unknown or infinite.
double margin_at(const GateMargin& margin, double baseline) {
  return std::isfinite(baseline) ? std::max(margin.absolute, margin.relative * std::abs(baseline))
                                 : margin.absolute;
}

void compare_by_statistic(MeasureComparison& result, const GateMeasure& measure, const PointTrials& baseline,
                          const PointTrials& current, bool paired, double confidence) {
  if (measure.statistic == GateStatistic::quantile) {
    compare_quantile(result, measure, baseline, current, paired, confidence);
  } else if (!measure.proportion()) {
    compare_mean(result, measure, baseline, current, paired, confidence);
  } else if (are_whole(baseline, measure) && are_whole(current, measure)) {
    compare_proportion(result, measure, baseline, current, paired, confidence);
  } else {
    compare_rates_of_units(result, measure, compared_failures(baseline, current, measure, paired), paired,
                           baseline.rigs > 0 || current.rigs > 0, confidence);
  }
}

/// Machines are judged by the moves that were seen of each, so both files must show as many.
/// @param goal of machines
std::pair<PointTrials, PointTrials> as_many_moves(const PointTrials& baseline, const PointTrials& current,
                                                  std::size_t goal) {
  const auto trials_of_rig = [goal](const PointTrials& all) {
    return all.trials / std::max<std::int64_t>(all.judged[goal].rigs, 1);
  };
  const std::int64_t each = std::min(trials_of_rig(baseline), trials_of_rig(current));
  const auto first = [&](const PointTrials& all) { return first_trials(all, each * all.judged[goal].rigs); };
  return {first(baseline), first(current)};
}

}  // namespace

std::vector<GateMeasure> judged_measures(const GateRules& rules, const PointTrials& trials) {
  std::vector<JudgedGoal> goals;
  for (const GoalTrials& one : trials.judged)
    goals.push_back({one.goal.name, one.goal.machines.has_value() && one.rigs > 0});
  return judged_measures(rules, *trials.table, goals);
}

std::vector<MeasureSample> measure_samples(const GateRules& rules, std::span<const MeasureComparison> found,
                                           const PointTrials& baseline, const PointTrials& current,
                                           bool paired) {
  std::vector<MeasureSample> samples;
  for (const GateMeasure& measure : judged_measures(rules, current)) {
    if (measure.statistic == GateStatistic::machines) {
      const auto [before, after] = as_many_moves(baseline, current, measure.goal);
      samples.push_back(sample_of_proportion(measure, before, after, paired));
    } else if (measure.statistic == GateStatistic::quantile) {
      samples.push_back(
          sample_of_quantile(found[samples.size()], measure, baseline, current, paired, rules.confidence));
    } else if (measure.proportion()) {
      samples.push_back(sample_of_proportion(measure, baseline, current, paired));
    } else {
      samples.push_back(sample_of_mean(measure, baseline, current, paired));
    }
  }
  return samples;
}

std::vector<MeasureComparison> compare_measures(const GateRules& rules, const std::string& label,
                                                const PointTrials& baseline, const PointTrials& current,
                                                bool paired) {
  std::vector<MeasureComparison> results;
  for (const GateMeasure& measure : judged_measures(rules, current)) {
    MeasureComparison result;
    result.measure = measure.name;
    result.unit = measure.unit;
    if (measure.statistic == GateStatistic::machines) {
      const auto [before, after] = as_many_moves(baseline, current, measure.goal);
      compare_by_statistic(result, measure, before, after, paired, rules.confidence);
      if (before.trials < baseline.trials || after.trials < current.trials)
        result.note =
            fmt::format("by the first {} trials on each", after.trials / after.judged[measure.goal].rigs);
    } else {
      compare_by_statistic(result, measure, baseline, current, paired, rules.confidence);
    }
    const GateMargin margin = margin_of(rules, label, measure);
    result.margin = margin_at(margin, result.baseline);
    result.changed_fails = rules.changed_fails || margin.changed_fails;
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace zerocount::comparison
