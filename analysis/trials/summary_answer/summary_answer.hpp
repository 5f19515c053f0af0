#pragma once

#include <string>

#include "analysis/basis/document/answer.hpp"
#include "analysis/trials/summary_answer/parts.hpp"

namespace zerocount::summary_answer {

/// The description of the answer that summarises a study: the verdict on the chosen design point, the points
/// (for an open-loop study their torque levels), and the parts that the study has.
/// @param summary summary of the study; must outlive the description
document::AnswerDescription<SummaryResults> summary_description(const summary::StudySummary& summary);

/// The description of the table of design points with its legend, and of the tables of further parts (such as
/// undecided moves) that the study has.
document::Description<SummaryResults> point_tables(const summary::StudySummary& summary);

/// The type (schema) of the summary answers of all studies. Items that only some studies have are optional.
document::AnswerType summary_type();

/// The summary answer in the forms for all audiences (document::Audience::all).
document::Answer summary_answer(const summary::StudySummary& summary, const SummaryForm& form = {});

/// Sentence on a run that has not ended: "unfinished: of the 12000 of 50000 trials that the run has finished
/// so far; 3 of 5 points have none yet"; empty for a complete study.
std::string unfinished_sentence(const summary::StudySummary& summary);

/// Sentence on how the study's design affects the bounds, in one line.
std::string design_line(const summary::StudySummary& summary);

}  // namespace zerocount::summary_answer
