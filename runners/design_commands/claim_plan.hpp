#pragma once

#include <vector>

#include "analysis/document/answer.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::design_commands {

/// `plan --success …`, `plan --rigs-share …` and `plan --halfwidth …`: the trials and rigs that show a claim,
/// or bring the bounds of a rate within a half-width; the latter also beside the former.
/// @throws Failure (bad_input) for options that do not go together
document::Answer claim_plan(const command_line::Arguments& arguments);

std::vector<document::AnswerType> claim_plan_types();

}  // namespace zerocount::design_commands
