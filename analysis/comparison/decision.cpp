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

/// The p that a failure is judged by: against a change for the worse; where every change fails, two-sided.
double failure_p(const MeasureComparison& measure) {
  if (!measure.changed_fails) return measure.p;
  return std::min(1.0, 2.0 * std::min(measure.p, measure.improvement_p));
}

/// Failures are one family, improvements that do not fail are another. A measure of which every change fails
/// has one p in the first family, which counts for the direction of its effect.
void adjust(const std::vector<MeasureComparison*>& tested) {
  std::vector<double> failures;
  std::vector<double> improvements;
  for (const MeasureComparison* measure : tested) {
    failures.push_back(failure_p(*measure));
    improvements.push_back(measure->improvement_p);
  }
  failures = benjamini_yekutieli(failures);
  improvements = benjamini_yekutieli(improvements);
  for (std::size_t i = 0; i < tested.size(); ++i) {
    MeasureComparison& measure = *tested[i];
    const bool worse = !measure.changed_fails || measure.p <= measure.improvement_p;
    measure.adjusted_p = worse ? failures[i] : 1.0;
    measure.adjusted_improvement_p = !measure.changed_fails ? improvements[i] : worse ? 1.0 : failures[i];
  }
}

ChangeVerdict change_of(const MeasureComparison& measure, double rate) {
  if (measure.adjusted_p <= rate && measure.effect > measure.margin) return ChangeVerdict::worse;
  if (measure.adjusted_improvement_p <= rate && -measure.effect > measure.margin)
    return ChangeVerdict::better;
  if (!(measure.bounds.high < measure.margin)) return ChangeVerdict::undecided;
  return measure.bounds.low > -measure.margin ? ChangeVerdict::equivalent : ChangeVerdict::not_worse;
}

/// How many times the trials that there are would decide, if the true effect is the one that was seen, or
/// none where it cannot be told from none.
///
/// With s the standard error, e the effect and M the margin: equivalence is shown where e + z_c·s < M; a
/// failure where e/s > z_t, z_t of the strictest test of the family, and e > M. Each with the planned power.
double times_to_decide(const MeasureComparison& measure, const GateRules& rules, std::size_t tests) {
  const double z_confidence = statistics::normal_quantile(rules.confidence);
  const double z_power = statistics::normal_quantile(planned_power);
  const bool better = measure.changed_fails && measure.effect < 0.0;
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

GateVerdict gate_verdict(ChangeVerdict change, bool changed_fails) {
  switch (change) {
    case ChangeVerdict::worse:
      return GateVerdict::regression;
    case ChangeVerdict::better:
      return changed_fails ? GateVerdict::changed : GateVerdict::passed;
    case ChangeVerdict::equivalent:
      return GateVerdict::passed;
    case ChangeVerdict::not_worse:
      return changed_fails ? GateVerdict::inconclusive : GateVerdict::passed;
    case ChangeVerdict::undecided:
      return GateVerdict::inconclusive;
    case ChangeVerdict::not_measured:
      break;
  }
  return GateVerdict::not_measured;
}

GateVerdict worst_of(std::span<const GateVerdict> verdicts) {
  return verdicts.empty() ? GateVerdict::not_measured : *std::min_element(verdicts.begin(), verdicts.end());
}

std::int64_t decide(std::span<PointComparison> points, const GateRules& rules) {
  const std::vector<MeasureComparison*> tested = tested_measures(points);
  adjust(tested);
  for (PointComparison& point : points) {
    const std::int64_t trials = std::max(point.baseline_trials, point.current_trials);
    for (MeasureComparison& measure : point.measures) {
      if (std::isnan(measure.p)) continue;
      measure.change = change_of(measure, rules.false_discovery_rate);
      measure.verdict = gate_verdict(measure.change, measure.changed_fails);
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
