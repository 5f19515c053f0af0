#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/sensitivity/output_sensitivity.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::sensitivity {
namespace {

std::string joined(const std::vector<std::string>& words) {
  if (words.size() < 2) return words.empty() ? "" : words.front();
  const std::vector<std::string> first(words.begin(), words.end() - 1);
  return fmt::format("{} and {}", fmt::join(first, ", "), words.back());
}

/// "friction.k1 (23 %, at least 17.2 %)".
std::string influential_text(const std::string& name, const BoundedNumber& index) {
  return fmt::format("{} ({:.0f} %, at least {})", name, 100.0 * index.value,
                     text::percent_at_least(index.low));
}

std::string why_nothing(const OutputSensitivity& sensitivity) {
  if (sensitivity.trials == 0) return fmt::format("No trial has a value of {}.", sensitivity.output);
  if (sensitivity.standard_deviation > 0.0) {
    return fmt::format(
        "There are too few trials, or nothing varies in them: nothing can be said of what influences {}.",
        sensitivity.output);
  }
  return fmt::format(
      "{} is {} in all {} trials: it has no variance, and nothing can be said of what influences it.",
      sensitivity.output, text::short_number(sensitivity.mean), sensitivity.trials);
}

/// The factors of an output by what the bounds of their indices say. Each text names one factor.
struct Findings {
  std::vector<std::string> influential;  ///< the index is above relevant_index
  std::vector<std::string> correlated;   ///< only the partial rank correlation shows it
  std::vector<std::string> open;         ///< the bounds do not exclude relevant_index
  std::vector<std::string> negligible;   ///< the index is below relevant_index
};

void sort_in(Findings& findings, const FactorSensitivity& factor, bool from_saltelli) {
  const BoundedNumber& index = from_saltelli ? factor.total : factor.first_order;
  if (index.low > relevant_index) {
    findings.influential.push_back(influential_text(factor.name, index));
  } else if (factor.matters) {
    findings.correlated.push_back(
        fmt::format("{} ({:+.2f})", factor.name, factor.partial_rank_correlation.value));
  } else if (index.high < relevant_index) {
    findings.negligible.push_back(factor.name);
  } else if (!std::isnan(index.high)) {
    findings.open.push_back(fmt::format("{} (at most {})", factor.name, text::percent_at_most(index.high)));
  } else if (!std::isnan(index.value)) {
    findings.open.push_back(factor.name);
  }
}

/// Sentences on the total indices of a saltelli design.
std::vector<std::string> total_sentences(const Findings& findings, const std::string& output) {
  std::vector<std::string> parts;
  if (findings.influential.empty()) {
    parts.push_back(fmt::format("no parameter is shown to have a part in {} or more of the variance of {}",
                                text::percent(relevant_index), output));
  } else {
    parts.push_back(fmt::format(
        "these parameters influence {}, with their total Sobol' index, the proportion of its variance that "
        "they have a part in, alone or with others (shared parts count for each of them, so these need not "
        "add up to 100 %): {}",
        output, joined(findings.influential)));
  }
  if (!findings.open.empty()) {
    parts.push_back(fmt::format("the study leaves open whether {} or more comes from {}",
                                text::percent(relevant_index), joined(findings.open)));
  }
  if (!findings.negligible.empty()) {
    parts.push_back(fmt::format("less than {} comes from {}", text::percent(relevant_index),
                                joined(findings.negligible)));
  }
  return parts;
}

/// Sentences on first-order indices and correlations, which do not see interactions.
std::vector<std::string> first_order_sentences(const Findings& findings, const std::string& output,
                                               Subject subject) {
  std::vector<std::string> parts;
  if (!findings.influential.empty()) {
    parts.push_back(fmt::format(
        "these parameters influence {}, with their first-order Sobol' index, the proportion of its variance "
        "that they explain alone: {}",
        output, joined(findings.influential)));
  }
  if (!findings.correlated.empty()) {
    parts.push_back(fmt::format("by their partial rank correlation, beyond ±{:g}, {}: {}",
                                relevant_correlation,
                                findings.influential.empty() ? "these influence " + output : "so do these",
                                joined(findings.correlated)));
  }
  if (parts.empty()) {
    parts.push_back(fmt::format("no parameter is shown to explain {} or more of the variance of {} alone",
                                text::percent(relevant_index), output));
  }
  if (!findings.open.empty()) {
    parts.push_back(fmt::format("the study leaves open whether {} or more is explained alone by {}",
                                text::percent(relevant_index), joined(findings.open)));
  }
  if (!findings.negligible.empty()) {
    parts.push_back(fmt::format("less than {} is explained alone by {}", text::percent(relevant_index),
                                joined(findings.negligible)));
  }
  parts.push_back(fmt::format("what a parameter does only together with others these trials cannot show{}",
                              subject == Subject::trials ? " (a study with design: saltelli can)" : ""));
  return parts;
}

}  // namespace

std::string sensitivity_conclusion(const OutputSensitivity& sensitivity, bool from_saltelli,
                                   double confidence, Subject subject) {
  if (!sensitivity.estimated) return why_nothing(sensitivity);
  Findings findings;
  for (const FactorSensitivity& factor : sensitivity.factors) sort_in(findings, factor, from_saltelli);
  const std::vector<std::string> parts = from_saltelli
                                             ? total_sentences(findings, sensitivity.output)
                                             : first_order_sentences(findings, sensitivity.output, subject);
  return fmt::format("By {} bounds, each by itself: {}.", text::percent(confidence), fmt::join(parts, "; "));
}

}  // namespace zerocount::sensitivity
