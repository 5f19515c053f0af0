#pragma once

#include <string>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/goal/goal_verdict.hpp"

/// How verdicts on a goal stand in answers.
namespace zerocount::goal {

/// "met", "missed", "undecided": the words of text_of().
std::vector<std::string> status_words();

/// A proportion with its bounds.
inline document::Bounded bounded(const BoundedProportion& proportion) {
  return {proportion.value, proportion.low, proportion.high};
}

/// Rigs and trials; for data only, because needs_sentence() says them.
document::Description<Needs> needs_description();

/// Needs that a study of practicable size has; nothing where none is.
const Needs* practicable(const std::optional<Needs>& needs);

}  // namespace zerocount::goal
