#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/comparison/comparison_report.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::comparison {

std::string_view word_of(GateVerdict verdict) {
  switch (verdict) {
    case GateVerdict::passed:
      return "passed";
    case GateVerdict::regression:
      return "regression";
    case GateVerdict::changed:
      return "changed";
    case GateVerdict::inconclusive:
      return "inconclusive";
    case GateVerdict::not_measured:
      break;
  }
  return "not measured";
}

std::string_view word_of(ChangeVerdict change) {
  switch (change) {
    case ChangeVerdict::worse:
      return "worse";
    case ChangeVerdict::better:
      return "better";
    case ChangeVerdict::equivalent:
      return "equivalent";
    case ChangeVerdict::not_worse:
      return "not worse";
    case ChangeVerdict::undecided:
      return "undecided";
    case ChangeVerdict::not_measured:
      break;
  }
  return "not measured";
}

std::string_view word_of(ComparisonLayer layer) {
  if (layer == ComparisonLayer::bits) return "bits";
  return layer == ComparisonLayer::paired ? "paired" : "two_samples";
}

VerdictCounts count_verdicts(const StudyComparison& comparison) {
  VerdictCounts counts;
  const auto count = [&](GateVerdict verdict) {
    counts.passed += verdict == GateVerdict::passed;
    counts.regressions += verdict == GateVerdict::regression;
    counts.changed += verdict == GateVerdict::changed;
    counts.inconclusive += verdict == GateVerdict::inconclusive;
    counts.not_measured += verdict == GateVerdict::not_measured;
  };
  for (const PointComparison& point : comparison.points) {
    for (const MeasureComparison& measure : point.measures) {
      count(measure.verdict);
      counts.worse += measure.change == ChangeVerdict::worse;
      counts.better += measure.change == ChangeVerdict::better;
      counts.equivalent += measure.change == ChangeVerdict::equivalent;
      counts.not_worse += measure.change == ChangeVerdict::not_worse;
      counts.undecided += measure.change == ChangeVerdict::undecided;
    }
    for (const RequirementResult& requirement : point.requirements) count(requirement.verdict);
  }
  return counts;
}

std::optional<double> trials_to_decide(const StudyComparison& comparison) {
  double most = 0.0;
  bool known = true;
  const auto take = [&](GateVerdict verdict, const std::optional<double>& trials) {
    if (verdict != GateVerdict::inconclusive) return;
    known = known && trials.has_value();
    most = std::max(most, trials.value_or(0.0));
  };
  for (const PointComparison& point : comparison.points) {
    for (const MeasureComparison& measure : point.measures) take(measure.verdict, measure.trials_to_decide);
    for (const RequirementResult& one : point.requirements) take(one.verdict, one.trials_to_decide);
  }
  if (!known || most == 0.0) return std::nullopt;
  return most;
}

namespace {

/// "3 of 40 judgements failed (1 worse, 2 better)"; empty where none did.
std::string failures_text(const VerdictCounts& counts) {
  if (counts.failed() == 0) return "";
  std::string text = fmt::format("{} of {} judgements failed", counts.failed(), counts.judged());
  if (counts.changed > 0) {
    text += fmt::format(" ({} worse or below a requirement, {} better, where every change fails)",
                        counts.regressions, counts.changed);
  }
  return text;
}

}  // namespace

std::string verdict_sentence(const StudyComparison& comparison) {
  const VerdictCounts counts = count_verdicts(comparison);
  const std::int64_t all = counts.judged();
  const bool unequal = comparison.layer == ComparisonLayer::bits && !comparison.equal_to_the_bit;
  if (comparison.verdict == GateVerdict::regression) {
    const std::string bits = unequal
                                 ? fmt::format("the data must be equal to the bit and are not: {}{}",
                                               comparison.first_difference, counts.failed() > 0 ? "; " : "")
                                 : "";
    return "regression: " + bits + failures_text(counts);
  }
  if (comparison.verdict == GateVerdict::changed) return "changed: " + failures_text(counts);
  if (comparison.verdict == GateVerdict::passed) {
    if (comparison.equal_to_the_bit) return "passed: every dataset is equal to the bit";
    return fmt::format(
        "passed: all {} judgements at {} design points; nothing is worse by more than its margin{}", all,
        comparison.points.size(),
        counts.better > 0 ? fmt::format(", {} {} better", counts.better, counts.better == 1 ? "is" : "are")
                          : "");
  }
  if (all == 0) return "inconclusive: nothing was measured";
  const std::optional<double> needed = trials_to_decide(comparison);
  return fmt::format(
      "inconclusive: {} of {} judgements are open{}", counts.inconclusive, all,
      needed ? fmt::format("; about {} trials per design point would decide", trials_text(*needed))
             : std::string());
}

std::string value_text(double value, std::string_view quantity, std::string_view unit) {
  if (std::isnan(value)) return "–";
  if (quantity.ends_with("_rate")) return fmt::format("{:.4g} %", 100.0 * value);
  return unit == "1" ? text::short_number(value) : fmt::format("{} {}", text::short_number(value), unit);
}

std::string trials_text(double trials) {
  if (trials < 100.0) return fmt::format("{:.0f}", trials);
  const double step = std::pow(10.0, std::floor(std::log10(trials)) - 1.0);
  return fmt::format("{:.0f}", std::ceil(trials / step) * step);
}

}  // namespace zerocount::comparison
