#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/sensitivity/output_sensitivity.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::sensitivity {
namespace {

std::string joined(const std::vector<std::string>& words) {
  if (words.size() < 2) return words.empty() ? "" : words.front();
  const std::vector<std::string> first(words.begin(), words.end() - 1);
  return fmt::format("{} and {}", fmt::join(first, ", "), words.back());
}

std::string proportion_text(double index) {
  return index < 0.005 ? "< 1 %" : fmt::format("{:.0f} %", 100.0 * index);
}

// Rounded up: what is above it is excluded.
std::string upper_text(double index) {
  return fmt::format("{:.0f} %", std::ceil(100.0 * index));
}

std::string why_nothing(const OutputSensitivity& sensitivity) {
  if (sensitivity.trials == 0) return fmt::format("No trial has a value of {}.", sensitivity.output);
  if (sensitivity.standard_deviation > 0.0) {
    return fmt::format(
        "There are too few trials, or nothing varies in them: nothing can be said of what drives {}.",
        sensitivity.output);
  }
  return fmt::format(
      "{} is {} in all {} trials: it has no variance, and nothing can be said of what drives it.",
      sensitivity.output, text::short_number(sensitivity.mean), sensitivity.trials);
}

}  // namespace

std::string sensitivity_conclusion(const OutputSensitivity& sensitivity, bool from_saltelli,
                                   double confidence) {
  if (!sensitivity.estimated) return why_nothing(sensitivity);
  std::vector<std::string> proportions;
  std::vector<std::string> correlations;
  std::vector<std::string> others;
  for (const FactorSensitivity& factor : sensitivity.factors) {
    const BoundedNumber& index = from_saltelli ? factor.total : factor.first_order;
    if (factor.matters && index.low > 0.0) {
      proportions.push_back(fmt::format("{} ({})", factor.name, proportion_text(index.value)));
    } else if (factor.matters) {
      correlations.push_back(fmt::format("{} ({:+.2f})", factor.name, factor.partial_rank_correlation.value));
    } else if (!std::isnan(index.value)) {
      const bool bounded = from_saltelli && !std::isnan(index.high);
      others.push_back(bounded ? fmt::format("{} (at most {})", factor.name, upper_text(index.high))
                               : factor.name);
    }
  }
  std::vector<std::string> parts;
  if (!proportions.empty()) {
    parts.push_back(fmt::format("what drives {}, with the proportion of its variance that it {}: {}",
                                sensitivity.output, from_saltelli ? "has a part in" : "explains alone",
                                joined(proportions)));
  }
  if (!correlations.empty()) {
    parts.push_back(fmt::format("too little for that, but shown by the partial rank correlation: {}",
                                joined(correlations)));
  }
  if (parts.empty()) parts.push_back(fmt::format("nothing is shown to drive {}", sensitivity.output));
  if (!others.empty()) parts.push_back(fmt::format("no influence shows of {}", joined(others)));
  return fmt::format("By {:g} % bounds, each by itself: {}.", 100.0 * confidence, fmt::join(parts, "; "));
}

}  // namespace zerocount::sensitivity
