#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/comparison/comparison_report.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::comparison {

std::string_view to_string(ComparisonLayer layer) {
  if (layer == ComparisonLayer::bits) return "bits";
  return layer == ComparisonLayer::paired ? "paired" : "two_samples";
}

std::int64_t count(const StudyComparison& comparison, GateVerdict verdict) {
  std::int64_t count = 0;
  for (const PointComparison& point : comparison.points)
    count += std::ranges::count(point.judgements, verdict, &Judgement::verdict);
  return count;
}

std::int64_t count(const StudyComparison& comparison, ChangeVerdict change) {
  std::int64_t count = 0;
  for (const PointComparison& point : comparison.points) {
    for (const Judgement& one : point.judgements) count += one.is_measure() && one.change == change;
  }
  return count;
}

namespace {

std::int64_t failed(const StudyComparison& comparison) {
  return count(comparison, GateVerdict::regression) + count(comparison, GateVerdict::changed);
}

/// "3 of 40 judgements failed (1 worse, 2 better)"; empty where none did.
std::string failures_text(const StudyComparison& comparison) {
  if (failed(comparison) == 0) return "";
  std::string text = fmt::format("{} of {} judgements failed", failed(comparison), judged(comparison));
  if (const std::int64_t changed = count(comparison, GateVerdict::changed); changed > 0)
    text += fmt::format(" ({} worse or below a requirement, {} better, where every change fails)",
                        count(comparison, GateVerdict::regression), changed);
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
    const std::string label = text::printable(point.label);
    for (const Judgement& one : point.judgements) {
      const auto text = [&](double value) { return value_text(value, one.measure, one.unit); };
      if (one.is_measure() && !std::isnan(one.max_trials_margin))
        open.push_back(fmt::format("{} at {} (margin {}; {} would be decided)", one.measure, label,
                                   text(one.margin), text(one.max_trials_margin)));
      if (!one.is_measure() && one.is_open() && !one.trials_to_decide)
        open.push_back(fmt::format("{} at {}", one.requirement, label));
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
      for (const Judgement& one : point.judgements) {
        if (!one.is_measure() || one.change != change) continue;
        names.push_back(one.measure);
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

std::int64_t judged(const StudyComparison& comparison) {
  return failed(comparison) + count(comparison, GateVerdict::inconclusive) +
         count(comparison, GateVerdict::passed);
}

std::string verdict_sentence(const StudyComparison& comparison) {
  const std::int64_t all = judged(comparison);
  const bool open = comparison.verdict == GateVerdict::inconclusive;
  if (compares_points(comparison) && all > 0)
    return answer_text(comparison) + (open ? advice_text(comparison) : "");
  switch (comparison.verdict) {
    case GateVerdict::regression:
      if (!is_unequal(comparison)) return "regression: " + failures_text(comparison);
      return fmt::format("regression: the data must be equal to the bit and are not: {}{}{}",
                         comparison.first_difference, failed(comparison) > 0 ? "; " : "",
                         failures_text(comparison));
    case GateVerdict::changed:
      return "changed: " + failures_text(comparison);
    case GateVerdict::passed:
      if (comparison.equal_to_the_bit) return "passed: every dataset is equal to the bit";
      return fmt::format(
          "passed: all {} judgements at {} design points are within their margins or better; {} better", all,
          comparison.points.size(), count(comparison, ChangeVerdict::better));
    case GateVerdict::inconclusive:
    case GateVerdict::not_measured:
      break;
  }
  if (all == 0) return "inconclusive: nothing was measured";
  return fmt::format("inconclusive: {} of {} judgements are open{}",
                     count(comparison, GateVerdict::inconclusive), all, advice_text(comparison));
}

std::string detectable_sentence(const StudyComparison& comparison) {
  std::vector<const Judgement*> measured;
  for (const PointComparison& point : comparison.points) {
    for (const Judgement& one : point.judgements) {
      if (!std::isnan(one.detectable_change)) measured.push_back(&one);
    }
  }
  std::vector<std::string> texts;
  while (!measured.empty()) {
    const std::string name = measured.front()->measure;
    const auto others =
        std::ranges::stable_partition(measured, [&](const Judgement* one) { return one->measure == name; });
    const auto [lowest, highest] = std::ranges::minmax(
        std::ranges::subrange(measured.begin(), others.begin()), {}, &Judgement::detectable_change);
    const auto text = [](const Judgement* one) {
      return value_text(one->detectable_change, one->measure, one->unit);
    };
    texts.push_back(text(lowest) == text(highest)
                        ? fmt::format("{} {}", name, text(lowest))
                        : fmt::format("{} {} to {}", name, text(lowest), text(highest)));
    measured.erase(measured.begin(), others.begin());
  }
  return texts.empty() ? "" : fmt::format("Detectable changes: {}", fmt::join(texts, ", "));
}

std::string value_text(double value, std::string_view quantity, std::string_view unit) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
  const std::string_view measure = without_goal(quantity);
  if (measure.ends_with("_rate") || measure == "goal_machines") return fmt::format("{:.4g} %", 100.0 * value);
  return unit == "1" ? text::short_number(value) : fmt::format("{} {}", text::short_number(value), unit);
}

std::string trials_text(double trials) {
  if (trials < 100.0) return fmt::format("{:.0f}", trials);
  const double step = std::pow(10.0, std::floor(std::log10(trials)) - 1.0);
  return fmt::format("{:.0f}", std::ceil(trials / step) * step);
}

}  // namespace zerocount::comparison
