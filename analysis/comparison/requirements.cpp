#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/comparison/measure_comparison.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/quantile.hpp"
#include "analysis/two_samples/mean_tests.hpp"
#include "analysis/two_samples/quick_tests.hpp"

namespace zerocount::comparison {
namespace {

/// k of n, and the limit it is held against.
struct ProportionClaim {
  std::int64_t successes{0};
  std::int64_t trials{0};
  double limit{0.0};
  bool at_least{true};
  std::optional<statistics::ClusterSums> by_rig{};  ///< where trials share rigs
};

/// @param quality 1 for each trial that has it, otherwise 0
ProportionClaim claim_of(const std::vector<double>& quality, std::int64_t rigs, double limit, bool at_least) {
  return {std::count(quality.begin(), quality.end(), 1.0), std::ssize(quality), limit, at_least,
          rigs == 0 ? std::nullopt : std::optional(statistics::sums_by_rig(quality, rigs))};
}

/// One-sided bounds: `low` with one confidence, `high` with another.
statistics::ConfidenceInterval one_sided(const ProportionClaim& claim, double low_confidence,
                                         double high_confidence) {
  if (claim.by_rig) {
    return {statistics::clustered_at_least(*claim.by_rig, low_confidence),
            statistics::clustered_at_most(*claim.by_rig, high_confidence)};
  }
  return {statistics::clopper_pearson(claim.successes, claim.trials, 2.0 * low_confidence - 1.0).low,
          statistics::clopper_pearson(claim.successes, claim.trials, 2.0 * high_confidence - 1.0).high};
}

statistics::ConfidenceInterval bounds_of(const ProportionClaim& claim, double confidence, double failing) {
  return claim.at_least ? one_sided(claim, confidence, failing) : one_sided(claim, failing, confidence);
}

GateVerdict verdict_of(const statistics::ConfidenceInterval& bounds, double limit, bool at_least) {
  const bool shown = at_least ? bounds.low >= limit : bounds.high <= limit;
  const bool contradicted = at_least ? bounds.high < limit : bounds.low > limit;
  if (shown) return GateVerdict::passed;
  return contradicted ? GateVerdict::regression : GateVerdict::inconclusive;
}

void judge_proportion(RequirementResult& result, const ProportionClaim& claim, double confidence,
                      double failing) {
  result.n = claim.trials;
  result.bounds = bounds_of(claim, confidence, failing);
  result.verdict = verdict_of(result.bounds, claim.limit, claim.at_least);
}

void judge_quality(RequirementResult& result, const std::vector<double>& quality, std::int64_t rigs,
                   double confidence, double failing) {
  const ProportionClaim claim = claim_of(quality, rigs, result.limit, result.at_least);
  result.value = statistics::rate(claim.successes, claim.trials);
  judge_proportion(result, claim, confidence, failing);
}

void judge_quantile(RequirementResult& result, const std::vector<double>& values, std::int64_t rigs,
                    double probability, double confidence, double failing) {
  statistics::Histogram<double> histogram;
  std::vector<double> within;  // [trial] 1 for a value within the limit
  for (const double value : values) {
    histogram.add(value);
    within.push_back(value <= result.limit ? 1.0 : 0.0);
  }
  result.value =
      statistics::order_statistic(histogram, statistics::quantile_rank(histogram.size, probability));
  judge_proportion(result, claim_of(within, rigs, probability, true), confidence, failing);
}

void judge_mean(RequirementResult& result, const std::vector<double>& values, double confidence,
                double failing) {
  result.n = std::ssize(values);
  if (result.n < 2) return;
  const two_samples::MeanDifference mean = two_samples::mean_difference(values);
  result.value = mean.value;
  result.bounds = {two_samples::cautious_bounds(values, 1.0, failing).low,
                   two_samples::cautious_bounds(values, 1.0, confidence).high};
  result.verdict = verdict_of(result.bounds, result.limit, result.at_least);
}

/// The verdict of the goal; its confidence is that of the manifest.
void judge_goal(RequirementResult& result, const GoalTrials& required, std::size_t claims) {
  const study::Goal& asked = required.goal;
  const measures::MoveCounts& counts = required.counts;
  const goal::Verdict verdict = goal::judge_goal(asked, counts, 1, claims);
  const bool machines = asked.machines.has_value();
  const goal::BoundedProportion& judged = machines ? verdict.machines : verdict.moves;
  result.n = machines ? std::ssize(counts.rigs) : counts.moves;
  result.limit = machines ? *asked.machines : asked.moves;
  result.value = judged.value;
  result.bounds = {judged.low, judged.high};
  result.verdict = verdict.status == goal::Status::met      ? GateVerdict::passed
                   : verdict.status == goal::Status::missed ? GateVerdict::regression
                                                            : GateVerdict::inconclusive;
}

/// The sample in so many groups, unit i in group i mod groups; 0: unchanged.
RequirementSample by_group(RequirementSample sample, std::int64_t groups) {
  const auto count = static_cast<std::size_t>(groups);
  if (count == 0 || count >= sample.hits.size()) return sample;
  for (std::size_t i = count; i < sample.hits.size(); ++i) {
    sample.hits[i % count] += sample.hits[i];
    sample.events[i % count] += sample.events[i];
  }
  sample.hits.resize(count);
  sample.events.resize(count);
  return sample;
}

/// The moves of each rig or trial that meet the goal; if the goal asks for machines, whether the rig meets
/// it.
RequirementSample goal_sample(const PointTrials& trials, const GoalTrials& counted) {
  const study::Goal& goal = counted.goal;
  RequirementSample sample{RequirementKind::goal, true, goal.machines.value_or(goal.moves), true, {}, {}};
  const std::size_t units =
      counted.rigs > 0 ? static_cast<std::size_t>(counted.rigs) : counted.moves_in_goal.size();
  sample.hits.assign(units, 0.0);
  sample.events.assign(units, 0.0);
  for (std::size_t trial = 0; trial < counted.moves_in_goal.size(); ++trial) {
    sample.hits[trial % units] += counted.moves_in_goal[trial];
    sample.events[trial % units] += static_cast<double>(counted.asked_moves(trials.moves));
  }
  if (!goal.machines) return by_group(std::move(sample), trials.rigs);
  for (std::size_t rig = 0; rig < units; ++rig) {
    sample.hits[rig] = sample.hits[rig] >= goal.moves * sample.events[rig] ? 1.0 : 0.0;
    sample.events[rig] = 1.0;
  }
  return by_group(std::move(sample), trials.rigs);
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
  RequirementSample sample{quantity.kind, requirement.at_least, requirement.limit, trials.rigs > 0, {}, {}};
  if (quantity.kind == RequirementKind::mean) {
    sample.hits = trial_means(trials, quantity.measure);
    sample.events.assign(sample.hits.size(), 1.0);
    return sample;
  }
  if (quantity.kind == RequirementKind::quantile) {
    sample.at_least = true;
    sample.limit = quantity.probability;
  }
  const std::vector<double> met = met_by_trial(requirement, trials);
  const std::size_t units = trials.rigs > 0 ? static_cast<std::size_t>(trials.rigs) : met.size();
  sample.hits.assign(units, 0.0);
  sample.events.assign(units, 0.0);
  for (std::size_t trial = 0; trial < met.size(); ++trial) {
    sample.hits[trial % units] += met[trial];
    sample.events[trial % units] += 1.0;
  }
  return sample;
}

GateVerdict requirement_verdict(const RequirementSample& sample, const RequirementSums& sums,
                                double confidence, double failing_confidence) {
  const double low = sample.at_least ? confidence : failing_confidence;
  const double high = sample.at_least ? failing_confidence : confidence;
  if (sample.kind == RequirementKind::mean) {
    const two_samples::ValueSums values{sums.units, sums.hits, sums.hits_squared};
    return verdict_of(two_samples::quick_mean_bounds(values, 1.0, low, high), sample.limit, sample.at_least);
  }
  ProportionClaim claim{std::llround(sums.hits), std::llround(sums.events), sample.limit, sample.at_least};
  if (sample.clustered) {
    claim.by_rig = {std::llround(sums.units), claim.successes,     claim.trials,
                    sums.hits_squared,        sums.hits_by_events, sums.events_squared};
  }
  return verdict_of(one_sided(claim, low, high), sample.limit, sample.at_least);
}

RequirementResult judge_requirement(const Requirement& requirement, const PointTrials& trials,
                                    double confidence, double failing_confidence) {
  const RequirableQuantity& quantity = requirement.quantity;
  RequirementResult result;
  result.text = requirement.text;
  result.quantity = quantity.name;
  result.unit = quantity.unit;
  result.at_least = requirement.at_least;
  result.limit = requirement.limit;
  switch (quantity.kind) {
    case RequirementKind::proportion:
      judge_quality(result, trials.of(quantity.measure), trials.rigs, confidence, failing_confidence);
      break;
    case RequirementKind::quantile:
      judge_quantile(result, worst_of_moves(trials, quantity.measure), trials.rigs, quantity.probability,
                     confidence, failing_confidence);
      break;
    case RequirementKind::mean:
      judge_mean(result, trial_means(trials, quantity.measure), confidence, failing_confidence);
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
