#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/summary.hpp"

namespace zerocount::summary {

/// A design point judged by the goal of its study.
struct JudgedPoint {
  std::int64_t point{0};
  std::int64_t chosen_from{1};  ///< points; the bounds allow for the choice (Bonferroni)
  goal::Verdict verdict;
  std::optional<goal::Needs> needs{};  ///< of a verdict that is undecided
};

/// @param point nothing: the best point by the goal, chosen by its trials
/// @param summary of a study with a goal
JudgedPoint judge_point(const StudySummary& summary, std::optional<std::int64_t> point = {});

/// The judgement as a paragraph: the goal, the point, the verdict with its bounds, what would decide it.
std::string judgement_text(const StudySummary& summary, const JudgedPoint& judged);

}  // namespace zerocount::summary
