#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <vector>

#include "analysis/comparison/measure_comparison.hpp"
#include "analysis/statistics/normal.hpp"

namespace zerocount::comparison {
namespace {

/// Probability with which the number of trials that would decide does decide.
constexpr double planned_power = 0.8;
constexpr double max_trials = 1e9;

std::vector<MeasureComparison*> tested_measures(std::span<PointComparison> points) {
  std::vector<MeasureComparison*> tested;
  for (PointComparison& point : points) {
    for (MeasureComparison& measure : point.measures) {
      if (!std::isnan(measure.p)) tested.push_back(&measure);
    }
  }
  return tested;
}

void adjust(const std::vector<MeasureComparison*>& tested, double MeasureComparison::*p,
            double MeasureComparison::*adjusted) {
  std::vector<double> values;
  values.reserve(tested.size());
  for (const MeasureComparison* measure : tested) values.push_back(measure->*p);
  const std::vector<double> results = benjamini_yekutieli(values);
  for (std::size_t i = 0; i < tested.size(); ++i) tested[i]->*adjusted = results[i];
}

GateVerdict verdict_of(const MeasureComparison& measure, double rate) {
  const double effect = measure.both_ways ? std::abs(measure.effect) : measure.effect;
  if (measure.adjusted_p <= rate && effect > measure.margin) return GateVerdict::regression;
  const bool not_worse = measure.bounds.high < measure.margin;
  const bool not_better = !measure.both_ways || measure.bounds.low > -measure.margin;
  return not_worse && not_better ? GateVerdict::passed : GateVerdict::inconclusive;
}

/// How many times the trials that there are would decide, if the true effect is the one that was seen, or
/// none where it cannot be told from none.
///
/// With s the standard error, e the effect and M the margin: equivalence is shown where e + z_c·s < M; a
/// failure where e/s > z_t, z_t of the strictest test of the family, and e > M. Each with the planned power.
double times_to_decide(const MeasureComparison& measure, const GateRules& rules, std::size_t tests) {
  const double z_confidence = statistics::normal_quantile(rules.confidence);
  const double z_power = statistics::normal_quantile(planned_power);
  const bool better = measure.both_ways && measure.effect < 0.0;
  const double reach = better ? measure.effect - measure.bounds.low : measure.bounds.high - measure.effect;
  const double error = reach / z_confidence;
  const double seen = better ? -measure.effect : measure.effect;
  const double effect = std::abs(seen) < 1.96 * error ? 0.0 : seen;
  const auto square = [](double x) { return x * x; };
  if (effect < measure.margin) return square((z_confidence + z_power) * error / (measure.margin - effect));
  double harmonic = 0.0;
  for (std::size_t i = 1; i <= tests; ++i) harmonic += 1.0 / static_cast<double>(i);
  const double strictest = rules.false_discovery_rate / (static_cast<double>(tests) * harmonic);
  return std::max(square((statistics::normal_quantile(1.0 - strictest) + z_power) * error / effect),
                  square(z_power * error / (effect - measure.margin)));
}

std::optional<double> trials_to_decide(const MeasureComparison& measure, std::int64_t trials,
                                       const GateRules& rules, std::size_t tests) {
  const double needed = static_cast<double>(trials) * std::max(1.0, times_to_decide(measure, rules, tests));
  if (!(needed < max_trials)) return std::nullopt;
  return std::ceil(needed) + 1.0;
}

/// Why an inconclusive measure is so.
std::string reason_of(const MeasureComparison& measure) {
  if (!measure.trials_to_decide) return "the change lies at the margin: no number of trials decides";
  if (measure.effect > measure.margin) return "beyond the margin, but not significantly worse";
  return "not shown to be within the margin";
}

}  // namespace

GateVerdict worst_of(std::span<const GateVerdict> verdicts) {
  return verdicts.empty() ? GateVerdict::not_measured : *std::min_element(verdicts.begin(), verdicts.end());
}

std::int64_t decide(std::span<PointComparison> points, const GateRules& rules) {
  const std::vector<MeasureComparison*> tested = tested_measures(points);
  adjust(tested, &MeasureComparison::p, &MeasureComparison::adjusted_p);
  adjust(tested, &MeasureComparison::improvement_p, &MeasureComparison::adjusted_improvement_p);
  for (PointComparison& point : points) {
    const std::int64_t trials = std::max(point.baseline_trials, point.current_trials);
    for (MeasureComparison& measure : point.measures) {
      if (std::isnan(measure.p)) continue;
      measure.verdict = verdict_of(measure, rules.false_discovery_rate);
      measure.improved =
          measure.adjusted_improvement_p <= rules.false_discovery_rate && -measure.effect > measure.margin;
      if (measure.verdict != GateVerdict::inconclusive) continue;
      measure.trials_to_decide = trials_to_decide(measure, trials, rules, tested.size());
      measure.note = reason_of(measure);
    }
  }
  return std::ssize(tested);
}

std::vector<double> benjamini_yekutieli(std::span<const double> p) {
  const std::size_t count = p.size();
  double harmonic = 0.0;
  for (std::size_t i = 1; i <= count; ++i) harmonic += 1.0 / static_cast<double>(i);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });

  std::vector<double> adjusted(count);
  double least = 1.0;
  for (std::size_t rank = count; rank > 0; --rank) {
    const double scale = static_cast<double>(count) * harmonic / static_cast<double>(rank);
    least = std::min(least, scale * p[order[rank - 1]]);
    adjusted[order[rank - 1]] = least;
  }
  return adjusted;
}

}  // namespace zerocount::comparison
