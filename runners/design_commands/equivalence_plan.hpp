#pragma once

#include "analysis/document/answer.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::design_commands {

/// `plan --margin MEASURE=M … MANIFEST`: simulates a pilot of the study; the trials with which two equal
/// studies are shown to be equivalent.
document::Answer equivalence_plan(const command_line::Arguments& arguments);

document::AnswerType equivalence_plan_type();

}  // namespace zerocount::design_commands
