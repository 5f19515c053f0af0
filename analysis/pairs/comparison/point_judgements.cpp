#include "analysis/pairs/comparison/point_judgements.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/pairs/two_samples/sample.hpp"
#include "analysis/trials/goal/goal_verdict.hpp"

namespace zerocount::comparison {
namespace {

using two_samples::QuantileSample;
using two_samples::Sample;

/// The value of the measure, transformed so that a larger value is worse; the transform is its own inverse.
/// If less of the measure is worse, a proportion p becomes 1 − p, and any other value changes its sign.
double worsened(const GateMeasure& measure, double value) {
  if (measure.worse == layout::Worse::more) return value;
  return measure.proportion() ? 1.0 - value : -value;
}

/// Whether the trials of either file share machines (or worlds in place of machines), so that trials are
/// dependent.
bool over_machines(const BothTrials& trials) {
  return trials.baseline.machines > 0 || trials.current.machines > 0;
}

/// [trial] The mean value of the measure in both files, over the moves that have a value in both; NaN if no
/// move has a value in both. For paired trials.
Sample values_of_pairs(const BothTrials& trials, const GateMeasure& measure) {
  Sample sample{.paired = true};
  const std::vector<double>& before = trials.baseline.of(measure);
  const std::vector<double>& after = trials.current.of(measure);
  const auto count = static_cast<std::size_t>(trials.baseline.trials);
  const std::size_t before_width = before.size() / count;
  const std::size_t after_width = after.size() / count;
  for (std::size_t trial = 0; trial < count; ++trial) {
    double one = 0.0;
    double two = 0.0;
    double moves = 0.0;
    for (std::size_t move = 0; move < std::min(before_width, after_width); ++move) {
      const double old_value = before[trial * before_width + move];
      const double new_value = after[trial * after_width + move];
      if (std::isnan(old_value) || std::isnan(new_value)) continue;
      one += old_value;
      two += new_value;
      moves += 1.0;
    }
    sample.baseline.push_back(one / moves);
    sample.current.push_back(two / moves);
    sample.differences.push_back((two - one) / moves);
  }
  return sample;
}

/// Number of trials of each machine that are used in both files: the smaller one of the two. Machines are
/// judged by the moves seen on each, so both files must contribute equally many.
std::int64_t common_trials_of_machine(const BothTrials& trials, std::size_t goal) {
  const auto of_machine = [goal](const PointTrials& all) {
    return all.trials / std::max<std::int64_t>(all.judged[goal].machines, 1);
  };
  return std::min(of_machine(trials.baseline), of_machine(trials.current));
}

/// [machine] 1 if the machine meets the goal in the proportion Goal::moves of its moves, otherwise 0. Only
/// the first `trials_of_machine` trials of each machine count.
std::vector<double> machines_in_goal(const PointTrials& trials, const GoalTrials& goal,
                                     std::int64_t trials_of_machine) {
  const auto machines = static_cast<std::size_t>(goal.machines);
  std::vector<double> met(machines, 0.0);
  for (std::size_t trial = 0; trial < machines * static_cast<std::size_t>(trials_of_machine); ++trial)
    met[trial % machines] += goal.moves_in_goal[trial];
  const auto moves = static_cast<double>(trials_of_machine * goal.asked_moves(trials.moves));
  for (double& of_machine : met) of_machine = of_machine >= goal.goal.moves * moves ? 1.0 : 0.0;
  return met;
}

/// [trial] Proportion of the moves that meet the goal, among the moves of the trial that the goal judges.
std::vector<double> moves_in_goal(const PointTrials& trials, const GoalTrials& goal) {
  std::vector<double> met = goal.moves_in_goal;
  for (double& value : met) value /= static_cast<double>(goal.asked_moves(trials.moves));
  return met;
}

/// Number of clusters (machines or worlds) that the values of a file form; 0 if each value is independent.
std::int64_t clusters_of(const PointTrials& trials, const GateMeasure& measure) {
  const bool of_machines =
      measure.statistic == GateStatistic::machines && trials.machines == trials.judged[measure.goal].machines;
  return of_machines ? 0 : trials.machines;
}

/// Whether the values behind the measure are independent and each exactly 0 or 1, so that exact tests of
/// proportions apply.
bool are_whole(const PointTrials& trials, const GateMeasure& measure) {
  return measure.proportion() && clusters_of(trials, measure) == 0 &&
         (measure.statistic != GateStatistic::moves ||
          trials.judged[measure.goal].asked_moves(trials.moves) == 1);
}

/// The values of the measure in both files, one per trial; for GateStatistic::machines, one per machine.
Sample values_of_both(const BothTrials& trials, const GateMeasure& measure) {
  if (!measure.proportion() && trials.paired) return values_of_pairs(trials, measure);
  const auto values = [&](const PointTrials& all) {
    switch (measure.statistic) {
      case GateStatistic::moves:
        return moves_in_goal(all, all.judged[measure.goal]);
      case GateStatistic::machines:
        return machines_in_goal(all, all.judged[measure.goal],
                                common_trials_of_machine(trials, measure.goal));
      case GateStatistic::trials:
      case GateStatistic::mean:
      case GateStatistic::quantile:
        break;
    }
    return values_of_trials(all, measure);
  };
  return {.paired = trials.paired, .baseline = values(trials.baseline), .current = values(trials.current)};
}

/// Plausible difference between two values of the measure in a single trial, the `unit` of cautious_bounds().
/// It is 1 for counts and proportions. For times it is the larger mean of the two files, or 1 ms if there is
/// none.
double plausible_difference(const GateMeasure& measure, const Sample& sample) {
  if (measure.proportion() || measure.measure->field.column.element != hdf5::Element::float64) return 1.0;
  const auto mean = [](const std::vector<double>& values) {
    return std::abs(two_samples::mean_of(two_samples::known(values)));
  };
  const double value = std::max(mean(sample.baseline), mean(sample.current));
  return value > 0.0 ? value : 1e-3;
}

/// The values of the measure for the independent units (trials, machines or worlds) in both files,
/// transformed by worsened() so that larger is worse.
Sample sample_of(const BothTrials& trials, const GateMeasure& measure) {
  Sample sample = values_of_both(trials, measure);
  sample.failures = are_whole(trials.baseline, measure) && are_whole(trials.current, measure);
  for (std::vector<double>* values : {&sample.baseline, &sample.current}) {
    for (double& value : *values) value = worsened(measure, value);
  }
  if (measure.proportion()) {
    for (std::size_t i = 0; trials.paired && i < sample.current.size(); ++i)
      sample.differences.push_back(sample.current[i] - sample.baseline[i]);
  } else {
    for (double& difference : sample.differences) difference = worsened(measure, difference);
  }
  sample.baseline = means_of_units(sample.baseline, clusters_of(trials.baseline, measure));
  sample.current = means_of_units(sample.current, clusters_of(trials.current, measure));
  sample.differences = means_of_units(sample.differences, clusters_of(trials.current, measure));
  sample.plausible = plausible_difference(measure, sample);
  return sample;
}

std::string test_name(const Sample& sample, bool over_machines) {
  if (sample.failures) return sample.paired ? "McNemar, exact" : "Fisher, exact";
  return fmt::format("{}{}", sample.paired ? "signed rank and paired t" : "Smirnov and Welch's t",
                     over_machines ? ", over machines" : "");
}

/// The margin as a change in the measure's unit, for this value of the baseline: the larger of the absolute
/// margin and of the relative one times the value. If the value is unknown or infinite, only the absolute
/// margin applies.
double margin_at(const GateMargin& margin, double baseline) {
  return std::isfinite(baseline) ? std::max(margin.absolute, margin.relative * std::abs(baseline))
                                 : margin.absolute;
}

/// Stores the values of both files in the judgement and, if there are enough of them, the change that they
/// show with its bounds and p-values.
void compare_sample(Judgement& result, const GateMeasure& measure, const BothTrials& trials,
                    const GateMargin& margin, double confidence) {
  const Sample sample = sample_of(trials, measure);
  const std::vector<double> before = two_samples::known(sample.baseline);
  const std::vector<double> after = two_samples::known(sample.current);
  result.baseline_n = std::ssize(before);
  result.current_n = std::ssize(after);
  result.baseline = worsened(measure, two_samples::mean_of(before));
  result.current = worsened(measure, two_samples::mean_of(after));
  result.margin = margin_at(margin, result.baseline);
  result.test = test_name(sample, over_machines(trials));
  result.paired_proportion = sample.failures && sample.paired;
  if (!measure.proportion() && std::min(result.baseline_n, result.current_n) < min_values) {
    result.note =
        fmt::format("fewer than {} {} have a value{}", min_values,
                    over_machines(trials) ? "machines" : "trials", trials.paired ? " in both files" : "");
    return;
  }
  static_cast<two_samples::Change&>(result) = two_samples::change_of(sample, confidence, result.margin);
}

/// Probability of that quantile of the goal's settling time that is compared between the files.
constexpr double judged_quantile = 0.95;

QuantileSample times_of(const BothTrials& trials, const GateMeasure& measure) {
  const auto times = [&](const PointTrials& all) {
    return two_samples::ClusteredValues{all.of(measure), all.judged[measure.goal].asked_moves(all.moves),
                                        all.machines};
  };
  return {times(trials.baseline), times(trials.current), trials.paired, judged_quantile};
}

void compare_quantile(Judgement& result, const GateMeasure& measure, const BothTrials& trials,
                      const GateMargin& margin, double confidence) {
  result.margin = margin_at(margin, statistics::unknown);
  const auto units = [](const PointTrials& all) {
    return all.machines > 0 ? std::min(all.machines, all.trials) : all.trials;
  };
  result.baseline_n = units(trials.baseline);
  result.current_n = units(trials.current);
  result.test = fmt::format("{} % quantile of all moves of the goal, by the moves later than that of both{}",
                            100.0 * judged_quantile, over_machines(trials) ? ", over machines" : "");
  if (std::min(result.baseline_n, result.current_n) < min_values) {
    result.note = fmt::format("fewer than {} {}", min_values, over_machines(trials) ? "machines" : "trials");
    return;
  }
  const QuantileSample times = times_of(trials, measure);
  result.baseline = two_samples::quantile_of(times.baseline, judged_quantile);
  result.current = two_samples::quantile_of(times.current, judged_quantile);
  result.margin = margin_at(margin, result.baseline);
  if (std::isnan(result.current - result.baseline)) {
    result.note = "not within the hold in either";
    return;
  }
  static_cast<two_samples::Change&>(result) = two_samples::change_of(times, confidence, result.margin);
}

/// Bounds of a proportion of hits among events.
/// @param sums sums_of_unit() summed over all units
/// @param clustered whether the units are machines, on which events are dependent
/// @param low_confidence, high_confidence confidence of the lower and of the upper bound
statistics::ConfidenceInterval proportion_bounds(const two_samples::Sums& sums, bool clustered,
                                                 double low_confidence, double high_confidence) {
  const std::int64_t hits = std::llround(sums[1]);
  const std::int64_t events = std::llround(sums[2]);
  if (clustered) {
    const statistics::ClusterSums by_machine{std::llround(sums[0]), hits, events, sums[3], sums[4], sums[5]};
    return {statistics::clustered_at_least(by_machine, low_confidence),
            statistics::clustered_at_most(by_machine, high_confidence)};
  }
  return {statistics::clopper_pearson(hits, events, 2.0 * low_confidence - 1.0).low,
          statistics::clopper_pearson(hits, events, 2.0 * high_confidence - 1.0).high};
}

/// The verdict that follows from bounds of the value that must keep the limit.
GateVerdict verdict_of(const statistics::ConfidenceInterval& bounds, const text::Limit& limit) {
  const bool is_lower = text::is_lower_limit(limit.relation);
  const bool shown = text::keeps(is_lower ? bounds.low : bounds.high, limit);
  const bool contradicted = text::keeps(is_lower ? bounds.high : bounds.low, negation(limit));
  if (shown) return GateVerdict::passed;
  return contradicted ? GateVerdict::regression : GateVerdict::inconclusive;
}

void judge_proportion(Judgement& result, const RequirementSample& sample, double confidence, double failing) {
  two_samples::Sums sums{};
  for (std::size_t i = 0; i < sample.hits.size(); ++i)
    two_samples::add(sums, sums_of_unit(sample.hits[i], sample.events[i]));
  result.current_n = std::llround(sums[2]);
  result.current = statistics::rate(std::llround(sums[1]), result.current_n);
  result.bounds = text::is_lower_limit(sample.limit.relation)
                      ? proportion_bounds(sums, sample.clustered, confidence, failing)
                      : proportion_bounds(sums, sample.clustered, failing, confidence);
  result.verdict = verdict_of(result.bounds, sample.limit);
}

double quantile_of(const std::vector<double>& values, double probability) {
  return statistics::order_statistic(values, statistics::quantile_rank(std::ssize(values), probability));
}

void judge_mean(Judgement& result, const std::vector<double>& values, double confidence, double failing) {
  result.current_n = std::ssize(values);
  if (result.current_n < 2) return;
  result.current = two_samples::mean_of(values);
  result.bounds = {two_samples::cautious_bounds(values, 1.0, failing).low,
                   two_samples::cautious_bounds(values, 1.0, confidence).high};
  result.verdict = verdict_of(result.bounds, {result.relation, result.margin});
}

/// Judges the requirement that the goal is met by the verdict on the goal, with the confidence that the
/// manifest states.
/// @param claims number of claims that must all be met
void judge_goal(Judgement& result, const GoalTrials& required, std::size_t claims) {
  const study::Goal& asked = required.goal;
  const measures::MoveCounts counts = required.counts.sum();
  const goal::Verdict verdict = goal::judge_goal(asked, required.counts, 1, claims);
  const bool machines = asked.machines.has_value();
  const goal::BoundedProportion& judged = goal::judged_rate(asked, verdict);
  result.current_n = machines ? std::ssize(counts.machines) : counts.moves;
  result.margin = study::demanded_proportion(asked);
  result.current = judged.value;
  result.bounds = {judged.low, judged.high};
  result.verdict = verdict.status == goal::Status::met      ? GateVerdict::passed
                   : verdict.status == goal::Status::missed ? GateVerdict::regression
                                                            : GateVerdict::inconclusive;
}

/// Sets the hits and events of the sample, summed by unit. Trial i belongs to unit i mod `units`; if `units`
/// is 0, each trial is a unit.
/// @param hits [trial] number of hits
/// @param events number of events of each trial
void add_units(RequirementSample& sample, std::span<const double> hits, double events, std::int64_t units) {
  const std::size_t count = units > 0 ? static_cast<std::size_t>(units) : hits.size();
  sample.hits.assign(count, 0.0);
  sample.events.assign(count, 0.0);
  for (std::size_t trial = 0; trial < hits.size(); ++trial) {
    sample.hits[trial % count] += hits[trial];
    sample.events[trial % count] += events;
  }
}

/// The sample behind the requirement that the goal is met: for each machine, or each trial without machines,
/// its moves and those that meet the goal. If the goal asks for a proportion of machines: whether each
/// machine meets it. If worlds take the place of machines, the units are worlds.
RequirementSample goal_sample(const PointTrials& trials, const GoalTrials& counted) {
  const study::Goal& goal = counted.goal;
  RequirementSample sample{
      RequirementKind::goal, {text::Relation::at_least, study::demanded_proportion(goal)}, true};
  const auto asked = static_cast<double>(counted.asked_moves(trials.moves));
  add_units(sample, counted.moves_in_goal, asked, counted.machines);
  for (std::size_t machine = 0; goal.machines && machine < sample.hits.size(); ++machine) {
    sample.hits[machine] = sample.hits[machine] >= goal.moves * sample.events[machine] ? 1.0 : 0.0;
    sample.events[machine] = 1.0;
  }
  const std::vector<double> hits = sample.hits;
  const std::vector<double> events = sample.events;
  const auto groups = static_cast<std::size_t>(trials.machines);
  if (groups == 0 || groups >= hits.size()) return sample;
  sample.hits.assign(groups, 0.0);
  sample.events.assign(groups, 0.0);
  for (std::size_t unit = 0; unit < hits.size(); ++unit) {
    sample.hits[unit % groups] += hits[unit];
    sample.events[unit % groups] += events[unit];
  }
  return sample;
}

/// [trial] 1 if the value of this trial satisfies the requirement, otherwise 0.
std::vector<double> met_by_trial(const Requirement& requirement, const PointTrials& trials) {
  const RequirableQuantity& quantity = requirement.quantity;
  if (quantity.kind == RequirementKind::proportion) return trials.of(quantity.measure);
  std::vector<double> met = worst_of_moves(trials, quantity.measure);
  for (double& value : met) value = text::keeps(value, requirement.limit) ? 1.0 : 0.0;
  return met;
}

}  // namespace

std::vector<GateMeasure> judged_measures(const GateRules& rules, const PointTrials& trials) {
  std::vector<study::Goal> goals;
  for (const GoalTrials& one : trials.judged) {
    goals.push_back(one.goal);
    if (one.machines == 0) goals.back().machines.reset();
  }
  return judged_measures(rules, *trials.table, goals);
}

std::vector<Judgement> compare_measures(const GateRules& rules, const std::string& label,
                                        const BothTrials& trials) {
  std::vector<Judgement> results;
  for (const GateMeasure& measure : judged_measures(rules, trials.current)) {
    Judgement& result = results.emplace_back();
    result.measure = measure.name;
    result.unit = measure.unit;
    const GateMargin margin = margin_of(rules, label, measure);
    if (measure.statistic == GateStatistic::quantile) {
      compare_quantile(result, measure, trials, margin, rules.confidence);
    } else {
      compare_sample(result, measure, trials, margin, rules.confidence);
    }
    if (measure.statistic == GateStatistic::machines) {
      const std::int64_t of_machine = common_trials_of_machine(trials, measure.goal);
      if (of_machine * trials.baseline.judged[measure.goal].machines < trials.baseline.trials ||
          of_machine * trials.current.judged[measure.goal].machines < trials.current.trials)
        result.note = fmt::format("by the first {} trials on each", of_machine);
    }
    result.changed_fails = rules.changed_fails || margin.changed_fails;
  }
  return results;
}

std::vector<Sample> measure_samples(const GateRules& rules, std::span<const Judgement> found,
                                    const BothTrials& trials) {
  std::vector<Sample> samples;
  for (const GateMeasure& measure : judged_measures(rules, trials.current)) {
    if (measure.statistic != GateStatistic::quantile) {
      samples.push_back(sample_of(trials, measure));
      continue;
    }
    const Judgement& quantile = found[samples.size()];
    samples.push_back(two_samples::linearised(times_of(trials, measure), quantile,
                                              standard_error_of(quantile.bounds, rules.confidence)));
  }
  return samples;
}

RequirementSample requirement_sample(const Requirement& requirement, const PointTrials& trials) {
  const RequirableQuantity& quantity = requirement.quantity;
  if (quantity.kind == RequirementKind::goal) return goal_sample(trials, trials.required[requirement.goal]);
  RequirementSample sample{quantity.kind, requirement.limit, trials.machines > 0};
  if (quantity.kind == RequirementKind::mean) {
    sample.hits =
        two_samples::known(means_of_units(values_of_trials(trials, quantity.measure), trials.machines));
    sample.events.assign(sample.hits.size(), 1.0);
    return sample;
  }
  if (quantity.kind == RequirementKind::quantile) {
    sample.limit = {text::Relation::at_least, quantity.probability};
  }
  add_units(sample, met_by_trial(requirement, trials), 1.0, trials.machines);
  return sample;
}

two_samples::Sums sums_of_unit(double hits, double events) {
  return {1.0, hits, events, hits * hits, hits * events, events * events};
}

GateVerdict requirement_verdict(const RequirementSample& sample, const two_samples::Sums& sums,
                                double confidence, double failing_confidence) {
  const bool is_lower = text::is_lower_limit(sample.limit.relation);
  const double low = is_lower ? confidence : failing_confidence;
  const double high = is_lower ? failing_confidence : confidence;
  const statistics::ConfidenceInterval bounds =
      sample.kind == RequirementKind::mean
          ? two_samples::quick_bounds({sums[0], sums[1], sums[3]}, 1.0, low, high)
          : proportion_bounds(sums, sample.clustered, low, high);
  return verdict_of(bounds, sample.limit);
}

Judgement judge_requirement(const Requirement& requirement, const PointTrials& trials, double confidence,
                            double failing_confidence) {
  const RequirableQuantity& quantity = requirement.quantity;
  Judgement result;
  result.requirement = requirement.text;
  result.measure = quantity.name;
  result.unit = quantity.unit;
  result.relation = requirement.limit.relation;
  result.margin = requirement.limit.value;
  result.verdict = GateVerdict::inconclusive;
  const RequirementSample sample = requirement_sample(requirement, trials);
  switch (quantity.kind) {
    case RequirementKind::proportion:
      judge_proportion(result, sample, confidence, failing_confidence);
      break;
    case RequirementKind::quantile:
      judge_proportion(result, sample, confidence, failing_confidence);
      result.current = quantile_of(worst_of_moves(trials, quantity.measure), quantity.probability);
      break;
    case RequirementKind::mean:
      judge_mean(result, sample.hits, confidence, failing_confidence);
      break;
    case RequirementKind::goal:
      judge_goal(result, trials.required[requirement.goal], trials.claims);
      break;
  }
  return result;
}

double failing_confidence(double confidence, std::int64_t count) {
  return 1.0 - (1.0 - confidence) / static_cast<double>(std::max<std::int64_t>(count, 1));
}

}  // namespace zerocount::comparison
