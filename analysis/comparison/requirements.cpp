#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/comparison/mean_tests.hpp"
#include "analysis/comparison/measure_comparison.hpp"
#include "analysis/statistics/clustered_proportion.hpp"
#include "analysis/statistics/quantile.hpp"

namespace zerocount::comparison {
namespace {

constexpr std::int64_t max_planned = 1'000'000'000;

/// k of n, and the limit it is held against.
struct ProportionClaim {
  std::int64_t successes{0};
  std::int64_t trials{0};
  double limit{0.0};
  bool at_least{true};
  std::optional<statistics::ClusterSums> by_rig{};  ///< where trials share rigs
};

/// As if there were `times` as many rigs like those that were seen.
statistics::ClusterSums scaled(const statistics::ClusterSums& sums, double times) {
  const auto whole = [&](std::int64_t number) {
    return static_cast<std::int64_t>(std::llround(times * static_cast<double>(number)));
  };
  return {whole(sums.clusters),        whole(sums.hits),
          whole(sums.events),          times * sums.hits_squared,
          times * sums.hits_by_events, times * sums.events_squared};
}

/// @param quality 1 for each trial that has it, otherwise 0
std::optional<statistics::ClusterSums> sums_by_rig(const std::vector<double>& quality, std::int64_t rigs) {
  if (rigs == 0) return std::nullopt;
  statistics::ClusterSums sums;
  for (std::int64_t rig = 0; rig < rigs; ++rig) {
    std::int64_t hits = 0;
    std::int64_t trials = 0;
    for (auto i = static_cast<std::size_t>(rig); i < quality.size(); i += static_cast<std::size_t>(rigs)) {
      hits += quality[i] > 0.0;
      ++trials;
    }
    sums.add(hits, trials);
  }
  return sums;
}

/// @param quality 1 for each trial that has it, otherwise 0
ProportionClaim claim_of(const std::vector<double>& quality, std::int64_t rigs, double limit, bool at_least) {
  return {std::count(quality.begin(), quality.end(), 1.0), std::ssize(quality), limit, at_least,
          sums_by_rig(quality, rigs)};
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

/// The fewest trials that decide, if the proportion in them is the one that was seen.
std::optional<double> trials_to_decide(const ProportionClaim& claim, double confidence, double failing) {
  const double proportion = statistics::rate(claim.successes, claim.trials);
  const auto decides = [&](std::int64_t trials) {
    const auto successes = std::llround(proportion * static_cast<double>(trials));
    ProportionClaim more{successes, trials, claim.limit, claim.at_least};
    if (claim.by_rig) {
      more.by_rig = scaled(*claim.by_rig, static_cast<double>(trials) / static_cast<double>(claim.trials));
    }
    return verdict_of(bounds_of(more, confidence, failing), claim.limit, claim.at_least) !=
           GateVerdict::inconclusive;
  };
  std::int64_t few = claim.trials;
  std::int64_t enough = few;
  while (enough < max_planned && !decides(enough)) {
    few = enough;
    enough *= 2;
  }
  if (enough >= max_planned) return std::nullopt;
  while (enough - few > 1) {
    const std::int64_t middle = few + (enough - few) / 2;
    (decides(middle) ? enough : few) = middle;
  }
  return static_cast<double>(enough);
}

void judge_proportion(RequirementResult& result, const ProportionClaim& claim, double confidence,
                      double failing) {
  result.n = claim.trials;
  result.bounds = bounds_of(claim, confidence, failing);
  result.verdict = verdict_of(result.bounds, claim.limit, claim.at_least);
  if (result.verdict == GateVerdict::inconclusive) {
    result.trials_to_decide = trials_to_decide(claim, confidence, failing);
  }
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
  const MeanDifference mean = mean_difference(values);
  result.value = mean.value;
  result.bounds = {cautious_bounds(values, 1.0, failing).low, cautious_bounds(values, 1.0, confidence).high};
  result.verdict = verdict_of(result.bounds, result.limit, result.at_least);
  if (result.verdict != GateVerdict::inconclusive || mean.value == result.limit) return;
  const double reach =
      mean.value < result.limit ? result.bounds.high - mean.value : mean.value - result.bounds.low;
  const double times = reach / std::abs(result.limit - mean.value);
  const double needed = std::ceil(static_cast<double>(result.n) * times * times) + 1.0;
  if (needed < static_cast<double>(max_planned)) result.trials_to_decide = needed;
}

}  // namespace

RequirementResult judge_requirement(const Requirement& requirement, const PointTrials& trials,
                                    double confidence, double failing_confidence) {
  const RequirableQuantity& quantity = *requirement.quantity;
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
  }
  return result;
}

double failing_confidence(double confidence, std::int64_t count) {
  return 1.0 - (1.0 - confidence) / static_cast<double>(std::max<std::int64_t>(count, 1));
}

}  // namespace zerocount::comparison
