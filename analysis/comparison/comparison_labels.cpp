#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/comparison/comparison_report.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::comparison {

std::string_view to_string(GateVerdict verdict) {
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

std::string_view to_string(ChangeVerdict change) {
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

std::string_view to_string(ComparisonLayer layer) {
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

namespace {

/// True if there are measures, and a change for the better fails at each.
bool every_change_fails(const StudyComparison& comparison) {
  bool any = false;
  for (const PointComparison& point : comparison.points) {
    for (const MeasureComparison& measure : point.measures) {
      if (!measure.changed_fails) return false;
      any = true;
    }
  }
  return any;
}

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

/// The advice on how many trials would decide the comparison.
std::string advice_text(const StudyComparison& comparison) {
  if (comparison.trials_to_decide) {
    return fmt::format("; {} trials per design point would decide, with a probability of {:.0f} %",
                       trials_text(*comparison.trials_to_decide), 100.0 * decision_probability);
  }
  if (std::isnan(comparison.max_trials_to_decide)) return "";
  std::vector<std::string> open;
  for (const PointComparison& point : comparison.points) {
    for (const MeasureComparison& measure : point.measures) {
      if (std::isnan(measure.max_trials_margin)) continue;
      open.push_back(fmt::format("{} at {} (margin {}; {} would be decided)", measure.measure,
                                 text::printable(point.label),
                                 value_text(measure.margin, measure.measure, measure.unit),
                                 value_text(measure.max_trials_margin, measure.measure, measure.unit)));
    }
    for (const RequirementResult& one : point.requirements) {
      if (one.verdict == GateVerdict::inconclusive && !one.trials_to_decide)
        open.push_back(fmt::format("{} at {}", one.text, text::printable(point.label)));
    }
  }
  return fmt::format("; {} trials per design point would not decide{}{}",
                     trials_text(comparison.max_trials_to_decide), open.empty() ? " all of them" : ": ",
                     fmt::join(open, ", "));
}

/// "better: success_rate, settling_time; worse: none; ..." of the point that is compared with another, under
/// each condition.
std::string answer_text(const StudyComparison& comparison) {
  const auto measures_that_are = [&](ChangeVerdict change) {
    std::vector<std::string> names;
    for (const PointComparison& point : comparison.points) {
      for (const MeasureComparison& measure : point.measures) {
        if (measure.change != change) continue;
        names.push_back(measure.measure);
        if (!point.condition.empty()) names.back() += " under " + text::printable(point.condition);
      }
    }
    return names.empty() ? "" : fmt::format("; {}: {}", to_string(change), fmt::join(names, ", "));
  };
  std::string text = fmt::format("{} against {}", text::printable(comparison.points.front().design_point),
                                 text::printable(comparison.baseline_label));
  for (const ChangeVerdict change : {ChangeVerdict::better, ChangeVerdict::worse, ChangeVerdict::equivalent,
                                     ChangeVerdict::not_worse, ChangeVerdict::undecided})
    text += measures_that_are(change);
  return text;
}

}  // namespace

std::string verdict_sentence(const StudyComparison& comparison) {
  const VerdictCounts counts = count_verdicts(comparison);
  const std::int64_t all = counts.judged();
  if (compares_points(comparison) && all > 0) {
    return answer_text(comparison) +
           (comparison.verdict == GateVerdict::inconclusive ? advice_text(comparison) : "");
  }
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
    return fmt::format("passed: all {} judgements at {} design points; nothing {} by more than its margin{}",
                       all, comparison.points.size(), every_change_fails(comparison) ? "changed" : "is worse",
                       counts.better > 0
                           ? fmt::format(", {} {} better", counts.better, counts.better == 1 ? "is" : "are")
                           : "");
  }
  if (all == 0) return "inconclusive: nothing was measured";
  return fmt::format("inconclusive: {} of {} judgements are open{}", counts.inconclusive, all,
                     advice_text(comparison));
}

std::string detectable_sentence(const StudyComparison& comparison) {
  struct Range {
    const MeasureComparison* lowest;
    const MeasureComparison* highest;
  };
  std::vector<Range> ranges;
  for (const PointComparison& point : comparison.points) {
    for (const MeasureComparison& measure : point.measures) {
      if (std::isnan(measure.detectable_change)) continue;
      const auto range = std::find_if(ranges.begin(), ranges.end(), [&](const Range& known) {
        return known.lowest->measure == measure.measure;
      });
      if (range == ranges.end()) {
        ranges.push_back({&measure, &measure});
        continue;
      }
      if (measure.detectable_change < range->lowest->detectable_change) range->lowest = &measure;
      if (measure.detectable_change > range->highest->detectable_change) range->highest = &measure;
    }
  }
  if (ranges.empty()) return "";
  std::vector<std::string> texts;
  for (const auto& [lowest, highest] : ranges) {
    const auto text = [](const MeasureComparison& one) {
      return value_text(one.detectable_change, one.measure, one.unit);
    };
    texts.push_back(lowest == highest
                        ? fmt::format("{} {}", lowest->measure, text(*lowest))
                        : fmt::format("{} {} to {}", lowest->measure, text(*lowest), text(*highest)));
  }
  return fmt::format("Detectable changes: {}", fmt::join(texts, ", "));
}

std::string value_text(double value, std::string_view quantity, std::string_view unit) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
  const std::string_view measure = without_goal(quantity);
  if (measure.ends_with("_rate") || measure == "goal_machines") return fmt::format("{:.4g} %", 100.0 * value);
  return unit == "1" ? text::short_number(value) : fmt::format("{} {}", text::short_number(value), unit);
}

double shown_p(const MeasureComparison& measure) {
  return measure.change == ChangeVerdict::better ? measure.adjusted_improvement_p : measure.adjusted_p;
}

std::string trials_text(double trials) {
  if (trials < 100.0) return fmt::format("{:.0f}", trials);
  const double step = std::pow(10.0, std::floor(std::log10(trials)) - 1.0);
  return fmt::format("{:.0f}", std::ceil(trials / step) * step);
}

}  // namespace zerocount::comparison
