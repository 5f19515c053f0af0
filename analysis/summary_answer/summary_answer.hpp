#pragma once

#include <string>

#include "analysis/document/answer.hpp"
#include "analysis/summary_answer/parts.hpp"

namespace zerocount::summary_answer {

/// The description of the answer that summarises a study: the verdict on the chosen point, the points (for an
/// open-loop study their torque levels), and the parts that the study has.
/// @param summary summary of the study; must outlive the description
document::AnswerDescription<SummaryResults> summary_description(const summary::StudySummary& summary);

/// The description of the table of points with its legend, and of the tables of the parts that the study has.
document::Description<SummaryResults> point_tables(const summary::StudySummary& summary);

/// The type of the answers for all studies. Items that only some studies have are optional.
document::AnswerType summary_type();

/// The answer for all audiences (document::Audience::all).
document::Answer summary_answer(const summary::StudySummary& summary, const SummaryForm& form = {});

/// "unfinished: of the 12000 of 50000 trials that the run has finished so far; 3 of 5 points have none yet";
/// empty for a complete study.
std::string unfinished_sentence(const summary::StudySummary& summary);

/// The effect of the study's design on the bounds, one line.
std::string design_line(const summary::StudySummary& summary);

}  // namespace zerocount::summary_answer
