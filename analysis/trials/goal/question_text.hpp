#pragma once

#include <string>
#include <string_view>

#include "analysis/trials/goal/question.hpp"

/// The words for a question in answers and figures. If the study has a goal, answers count moves; otherwise
/// they count trials, because a trial succeeds as a whole. On an axis with two masses, "zero counts" names
/// the mass whose encoder is read.
namespace zerocount::goal {

/// What moves do that meet the question: "meet the goal", "end at zero counts of the motor".
std::string meeting_predicate(const Question& question);

/// Moves or trials that meet the question: "moves that meet the goal", "trials that end at zero counts".
std::string meeting_noun(const Question& question);

/// Name of the proportion by which the question is judged: "rate of moves in goal", "success rate".
std::string_view name_of_rate(const Question& question);

/// What trials do that succeed: "succeed", or with two masses "end at zero counts of the motor".
std::string success_predicate(const Question& question);

/// Column head of judged_rate(): "machines in goal", "moves in goal", "zero-count".
std::string_view head_of_judged_rate(const Question& question);

/// Machines, moves or trials that judged_rate() counts: "machines that meet the goal", or meeting_noun().
std::string noun_of_judged_rate(const Question& question);

}  // namespace zerocount::goal
