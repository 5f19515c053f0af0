#pragma once

#include <string>

#include "analysis/document/answer.hpp"
#include "analysis/summary_answer/parts.hpp"

namespace zerocount::summary_answer {

/// The answer of the summary of a study: the verdict on the chosen point, the points (of an open-loop study
/// their torque levels), and what else the study has of them.
/// @param summary of the study; stays as long as the description
document::AnswerDescription<SummaryReading> summary_description(const summary::StudySummary& summary);

/// The table of the points with what their columns mean, and the tables of what the study has of them.
document::Description<SummaryReading> point_tables(const summary::StudySummary& summary);

/// The type of the answers of all studies: what only some have is optional.
document::AnswerType summary_type();

/// The answer for everyone.
document::Answer summary_answer(const summary::StudySummary& summary, const SummaryForm& form = {});

/// "unfinished: of the 12000 of 50000 trials that the run has finished so far; 3 of 5 points have none yet";
/// empty for a complete study.
std::string unfinished_sentence(const summary::StudySummary& summary);

/// The effect of the study's design on the bounds, one line.
std::string design_line(const summary::StudySummary& summary);

}  // namespace zerocount::summary_answer
