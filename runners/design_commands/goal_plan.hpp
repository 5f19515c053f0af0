#pragma once

#include <vector>

#include "analysis/document/answer.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::design_commands {

/// `plan MANIFEST` and `plan PILOT` without another question: the trials and rigs that decide the goal of the
/// manifest. Of a manifest the smallest studies that can meet it, of a results file the study that
/// decides it with a probability of 90 %.
/// @throws Failure (bad_input) if there is no goal
document::Answer goal_plan(const command_line::Arguments& arguments);

std::vector<document::AnswerType> goal_plan_types();

}  // namespace zerocount::design_commands
