#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/comparison/point_judgements.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/quantile.hpp"
#include "analysis/two_samples/sample.hpp"

namespace zerocount::comparison {
namespace {

/// Bounds of a proportion of the hits among the events: `low` with one confidence, `high` with another.
statistics::ConfidenceInterval proportion_bounds(const two_samples::Sums& sums, bool clustered,
                                                 double low_confidence, double high_confidence) {
  const std::int64_t hits = std::llround(sums[1]);
  const std::int64_t events = std::llround(sums[2]);
  if (clustered) {
    const statistics::ClusterSums by_rig{std::llround(sums[0]), hits, events, sums[3], sums[4], sums[5]};
    return {statistics::clustered_at_least(by_rig, low_confidence),
            statistics::clustered_at_most(by_rig, high_confidence)};
  }
  return {statistics::clopper_pearson(hits, events, 2.0 * low_confidence - 1.0).low,
          statistics::clopper_pearson(hits, events, 2.0 * high_confidence - 1.0).high};
}

GateVerdict verdict_of(const statistics::ConfidenceInterval& bounds, double limit, bool at_least) {
  const bool shown = at_least ? bounds.low >= limit : bounds.high <= limit;
  const bool contradicted = at_least ? bounds.high < limit : bounds.low > limit;
  if (shown) return GateVerdict::passed;
  return contradicted ? GateVerdict::regression : GateVerdict::inconclusive;
}

void judge_proportion(Judgement& result, const RequirementSample& sample, double confidence, double failing) {
  two_samples::Sums sums{};
  for (std::size_t i = 0; i < sample.hits.size(); ++i)
    two_samples::add(sums, sums_of_unit(sample.hits[i], sample.events[i]));
  result.current_n = std::llround(sums[2]);
  result.current = statistics::rate(std::llround(sums[1]), result.current_n);
  result.bounds = sample.at_least ? proportion_bounds(sums, sample.clustered, confidence, failing)
                                  : proportion_bounds(sums, sample.clustered, failing, confidence);
  result.verdict = verdict_of(result.bounds, sample.limit, sample.at_least);
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
  result.verdict = verdict_of(result.bounds, result.margin, result.at_least);
}

/// The verdict of the goal; its confidence is that of the manifest.
void judge_goal(Judgement& result, const GoalTrials& required, std::size_t claims) {
  const study::Goal& asked = required.goal;
  const measures::MoveCounts counts = required.counts.sum();
  const goal::Verdict verdict = goal::judge_goal(asked, required.counts, 1, claims);
  const bool machines = asked.machines.has_value();
  const goal::BoundedProportion& judged = machines ? verdict.machines : verdict.moves;
  result.current_n = machines ? std::ssize(counts.rigs) : counts.moves;
  result.margin = machines ? *asked.machines : asked.moves;
  result.current = judged.value;
  result.bounds = {judged.low, judged.high};
  result.verdict = verdict.status == goal::Status::met      ? GateVerdict::passed
                   : verdict.status == goal::Status::missed ? GateVerdict::regression
                                                            : GateVerdict::inconclusive;
}

/// The hits and events of trials, by unit: trial i is of unit i mod units, 0: each is one.
void add_units(RequirementSample& sample, std::span<const double> hits, double events, std::int64_t units) {
  const std::size_t count = units > 0 ? static_cast<std::size_t>(units) : hits.size();
  sample.hits.assign(count, 0.0);
  sample.events.assign(count, 0.0);
  for (std::size_t trial = 0; trial < hits.size(); ++trial) {
    sample.hits[trial % count] += hits[trial];
    sample.events[trial % count] += events;
  }
}

/// The moves of each rig or trial that meet the goal; if the goal asks for machines, whether the rig meets
/// it. Where worlds take the place of rigs, by world.
RequirementSample goal_sample(const PointTrials& trials, const GoalTrials& counted) {
  const study::Goal& goal = counted.goal;
  RequirementSample sample{RequirementKind::goal, true, goal.machines.value_or(goal.moves), true};
  const auto asked = static_cast<double>(counted.asked_moves(trials.moves));
  add_units(sample, counted.moves_in_goal, asked, counted.rigs);
  for (std::size_t rig = 0; goal.machines && rig < sample.hits.size(); ++rig) {
    sample.hits[rig] = sample.hits[rig] >= goal.moves * sample.events[rig] ? 1.0 : 0.0;
    sample.events[rig] = 1.0;
  }
  const std::vector<double> hits = sample.hits;
  const std::vector<double> events = sample.events;
  const auto groups = static_cast<std::size_t>(trials.rigs);
  if (groups == 0 || groups >= hits.size()) return sample;
  sample.hits.assign(groups, 0.0);
  sample.events.assign(groups, 0.0);
  for (std::size_t unit = 0; unit < hits.size(); ++unit) {
    sample.hits[unit % groups] += hits[unit];
    sample.events[unit % groups] += events[unit];
  }
  return sample;
}

/// [trial] 1 for each trial that meets the requirement by itself, otherwise 0.
std::vector<double> met_by_trial(const Requirement& requirement, const PointTrials& trials) {
  const RequirableQuantity& quantity = requirement.quantity;
  if (quantity.kind == RequirementKind::proportion) return trials.of(quantity.measure);
  std::vector<double> met = worst_of_moves(trials, quantity.measure);
  for (double& value : met) value = value <= requirement.limit ? 1.0 : 0.0;
  return met;
}

}  // namespace

RequirementSample requirement_sample(const Requirement& requirement, const PointTrials& trials) {
  const RequirableQuantity& quantity = requirement.quantity;
  if (quantity.kind == RequirementKind::goal) return goal_sample(trials, trials.required[requirement.goal]);
  RequirementSample sample{quantity.kind, requirement.at_least, requirement.limit, trials.rigs > 0};
  if (quantity.kind == RequirementKind::mean) {
    sample.hits = two_samples::known(means_of_units(values_of_trials(trials, quantity.measure), trials.rigs));
    sample.events.assign(sample.hits.size(), 1.0);
    return sample;
  }
  if (quantity.kind == RequirementKind::quantile) {
    sample.at_least = true;
    sample.limit = quantity.probability;
  }
  add_units(sample, met_by_trial(requirement, trials), 1.0, trials.rigs);
  return sample;
}

two_samples::Sums sums_of_unit(double hits, double events) {
  return {1.0, hits, events, hits * hits, hits * events, events * events};
}

GateVerdict requirement_verdict(const RequirementSample& sample, const two_samples::Sums& sums,
                                double confidence, double failing_confidence) {
  const double low = sample.at_least ? confidence : failing_confidence;
  const double high = sample.at_least ? failing_confidence : confidence;
  const statistics::ConfidenceInterval bounds =
      sample.kind == RequirementKind::mean
          ? two_samples::quick_bounds({sums[0], sums[1], sums[3]}, 1.0, low, high)
          : proportion_bounds(sums, sample.clustered, low, high);
  return verdict_of(bounds, sample.limit, sample.at_least);
}

Judgement judge_requirement(const Requirement& requirement, const PointTrials& trials, double confidence,
                            double failing_confidence) {
  const RequirableQuantity& quantity = requirement.quantity;
  Judgement result;
  result.requirement = requirement.text;
  result.measure = quantity.name;
  result.unit = quantity.unit;
  result.at_least = requirement.at_least;
  result.margin = requirement.limit;
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
