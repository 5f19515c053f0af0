#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/chosen_point.hpp"

namespace zerocount::summary {

/// A design point judged by the goal of its study.
struct JudgedPoint {
  ChosenPoint chosen;  ///< the bounds allow for its choice (Bonferroni)
  goal::Verdict verdict;
  std::optional<goal::Needs> needs{};  ///< of a verdict that is undecided
};

/// @param summary of a study with a goal
JudgedPoint judge_point(const StudySummary& summary, const ChosenPoint& chosen);

/// "the goal is met", "the goal is missed", "it is undecided whether the goal is met".
std::string_view verdict_words(goal::Status status);

/// "best of 8 points: 3 (kp=400): the goal is met".
std::string judgement_headline(const StudySummary& summary, const JudgedPoint& judged);

/// What the verdict rests on, whole lines: its bounds, what would decide it, the competitors of the point.
std::string judgement_details(const StudySummary& summary, const JudgedPoint& judged);

/// The judgement as a paragraph: the goal, judgement_headline() and judgement_details().
std::string judgement_text(const StudySummary& summary, const JudgedPoint& judged);

}  // namespace zerocount::summary
