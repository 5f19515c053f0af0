#pragma once

#include <vector>

#include "analysis/document/answer.hpp"
#include "runners/command_line/command_line.hpp"

/// The questions of `plan`.
namespace zerocount::design_commands {

/// `plan --success …`, `plan --rigs-share …` and `plan --halfwidth …`: the trials and rigs that show a claim,
/// or bring the bounds of a rate within a half-width; the latter also beside the former.
/// @throws Failure (bad_input) for options that do not go together
document::Answer claim_plan(const command_line::Arguments& arguments);

std::vector<document::AnswerType> claim_plan_types();

/// `plan MANIFEST` and `plan PILOT` without another question: the trials and rigs that decide the goal of the
/// manifest. Of a manifest the smallest studies that can meet it, of a results file the study that
/// decides it with a probability of 90 %.
/// @throws Failure (bad_input) if there is no goal
document::Answer goal_plan(const command_line::Arguments& arguments);

std::vector<document::AnswerType> goal_plan_types();

/// `plan --margin MEASURE=M … MANIFEST`: simulates a pilot of the study; the trials with which two equal
/// studies are shown to be equivalent.
document::Answer equivalence_plan(const command_line::Arguments& arguments);

document::AnswerType equivalence_plan_type();

}  // namespace zerocount::design_commands
