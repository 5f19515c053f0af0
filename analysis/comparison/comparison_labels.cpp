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
    case GateVerdict::inconclusive:
      return "inconclusive";
    case GateVerdict::not_measured:
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
    counts.inconclusive += verdict == GateVerdict::inconclusive;
    counts.not_measured += verdict == GateVerdict::not_measured;
  };
  for (const PointComparison& point : comparison.points) {
    for (const MeasureComparison& measure : point.measures) {
      count(measure.verdict);
      counts.improved += measure.improved;
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

std::string verdict_sentence(const StudyComparison& comparison) {
  const VerdictCounts counts = count_verdicts(comparison);
  const std::int64_t all = counts.passed + counts.regressions + counts.inconclusive;
  const bool unequal = comparison.layer == ComparisonLayer::bits && !comparison.equal_to_the_bit;
  if (comparison.verdict == GateVerdict::regression) {
    const std::string bits =
        unequal ? fmt::format("the data must be equal to the bit and are not: {}{}",
                              comparison.first_difference, counts.regressions > 0 ? "; " : "")
                : "";
    const std::string worse =
        counts.regressions > 0 ? fmt::format("{} of {} judgements failed", counts.regressions, all) : "";
    return "regression: " + bits + worse;
  }
  if (comparison.verdict == GateVerdict::passed) {
    if (comparison.equal_to_the_bit) return "passed: every dataset is equal to the bit";
    return fmt::format(
        "passed: all {} judgements at {} design points; nothing is worse by more than its margin", all,
        comparison.points.size());
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
