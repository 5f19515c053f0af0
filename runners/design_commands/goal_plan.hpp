#pragma once

#include "core/failure/failure.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::design_commands {

/// `plan MANIFEST` and `plan PILOT` without another question: the trials and rigs that decide the goal of the
/// manifest. Of a manifest the smallest studies that can meet it, of a results file the study that
/// decides it with a probability of 90 %.
/// @throws Failure (bad_input) if there is no goal
ExitCode print_goal_plan(const command_line::Arguments& arguments);

}  // namespace zerocount::design_commands
