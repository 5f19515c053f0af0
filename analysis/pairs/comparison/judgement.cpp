#include "analysis/pairs/comparison/judgement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "analysis/basis/statistics/distributions.hpp"

namespace zerocount::comparison {
namespace {

/// Number of steps of the fixed-point iteration with which detectable_change() finds the smallest detectable
/// change; each step at least halves the error.
constexpr int detectable_steps = 40;

/// The harmonic number 1 + 1/2 + … + 1/n.
double harmonic_number(std::size_t n) {
  double sum = 0.0;
  for (std::size_t i = 1; i <= n; ++i) sum += 1.0 / static_cast<double>(i);
  return sum;
}

/// The p-value of a failure of the gate: one-sided, for a change for the worse beyond the margin; two-sided
/// if a change in either direction fails.
double failure_p(const TestedMeasure& measure) {
  const two_samples::DirectionalP& p = measure.beyond;
  return measure.changed_fails ? std::min(1.0, 2.0 * std::min(p.worse, p.better)) : p.worse;
}

/// Computes the p-values that are adjusted for false discoveries. Failures of the gate form one family of
/// tests, improvements another. If a change of a measure in either direction fails, its p-value in the first
/// family counts for the direction of its effect.
void adjust(std::span<TestedMeasure> tested) {
  std::vector<double> failures;
  std::vector<double> improvements;
  for (const TestedMeasure& measure : tested) {
    failures.push_back(failure_p(measure));
    improvements.push_back(measure.beyond.better);
  }
  failures = benjamini_yekutieli(failures);
  improvements = benjamini_yekutieli(improvements);
  for (std::size_t i = 0; i < tested.size(); ++i) {
    TestedMeasure& measure = tested[i];
    const bool worse = !measure.changed_fails || measure.beyond.worse <= measure.beyond.better;
    measure.adjusted_p = worse ? failures[i] : 1.0;
    measure.adjusted_improvement_p = !measure.changed_fails ? improvements[i] : worse ? 1.0 : failures[i];
  }
}

ChangeVerdict change_of(const TestedMeasure& measure, double rate) {
  if (measure.adjusted_p <= rate && measure.bounds.low > measure.margin) return ChangeVerdict::worse;
  if (measure.adjusted_improvement_p <= rate && measure.bounds.high < -measure.margin)
    return ChangeVerdict::better;
  if (!(measure.bounds.high < measure.margin)) return ChangeVerdict::undecided;
  return measure.bounds.low > -measure.margin ? ChangeVerdict::equivalent : ChangeVerdict::not_worse;
}

/// The reason why a measure is inconclusive, as a text for the reader.
std::string reason_of(const TestedMeasure& measure) {
  const bool beyond =
      measure.effect > measure.margin || (measure.changed_fails && -measure.effect > measure.margin);
  return beyond ? "beyond the margin, but not significantly" : "not shown to be within the margin";
}

}  // namespace

std::string_view to_string(GateVerdict verdict) {
  constexpr std::array<std::string_view, 5> words{"regression", "changed", "inconclusive", "passed",
                                                  "not measured"};
  return words[static_cast<std::size_t>(verdict)];
}

std::string_view to_string(ChangeVerdict change) {
  constexpr std::array<std::string_view, 6> words{"worse",     "better",    "equivalent",
                                                  "not worse", "undecided", "not measured"};
  return words[static_cast<std::size_t>(change)];
}

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

bool has_finite_bounds(const TestedMeasure& measure) {
  return !std::isnan(measure.p) && std::isfinite(measure.effect) && std::isfinite(measure.bounds.low) &&
         std::isfinite(measure.bounds.high);
}

double standard_error_of(const statistics::ConfidenceInterval& bounds, double confidence) {
  return bounds.half_width() / statistics::normal_quantile(confidence);
}

double largest_possible_change(const TestedMeasure& measure) {
  return measure.changed_fails ? std::max(measure.bounds.high, -measure.bounds.low) : measure.bounds.high;
}

double detectable_change(const Judgement& measure, const GateRules& rules, std::size_t tests) {
  if (!has_finite_bounds(measure)) return statistics::unknown;
  const double error = standard_error_of(measure.bounds, rules.confidence);
  const double rate = rules.false_discovery_rate / (measure.changed_fails ? 2.0 : 1.0);
  const double strictest = rate / (static_cast<double>(tests) * harmonic_number(tests));
  const double power = statistics::normal_quantile(decision_probability);
  const double needed = statistics::normal_quantile(1.0 - strictest) + power;
  const double per_change = measure.paired_proportion ? 1.0 / static_cast<double>(measure.current_n) : 0.0;
  double change = 0.0;
  for (int step = 0; step < detectable_steps; ++step) {
    const double spread = std::sqrt(error * error + change * per_change);
    change = measure.margin + needed * spread;
  }
  return change;
}

void decide(std::span<TestedMeasure> tested, double rate) {
  adjust(tested);
  for (TestedMeasure& measure : tested) measure.change = change_of(measure, rate);
}

std::int64_t decide(std::span<Judgement* const> measures, const GateRules& rules) {
  std::vector<Judgement*> judged;
  std::vector<TestedMeasure> tested;
  for (Judgement* const measure : measures) {
    if (std::isnan(measure->p)) continue;
    judged.push_back(measure);
    tested.push_back(*measure);
  }
  decide(tested, rules.false_discovery_rate);
  for (std::size_t i = 0; i < tested.size(); ++i) {
    Judgement& measure = *judged[i];
    static_cast<TestedMeasure&>(measure) = tested[i];
    measure.detectable_change = detectable_change(measure, rules, tested.size());
    measure.verdict = gate_verdict(measure.change, measure.changed_fails);
    if (measure.is_open()) measure.note += (measure.note.empty() ? "" : "; ") + reason_of(measure);
  }
  return std::ssize(tested);
}

std::vector<double> benjamini_yekutieli(std::span<const double> p) {
  const std::size_t count = p.size();
  const double harmonic = harmonic_number(count);
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
