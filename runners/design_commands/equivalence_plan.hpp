#pragma once

#include "core/failure/failure.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::design_commands {

/// `plan --margin MEASURE=M … MANIFEST`: simulates a pilot of the study, and prints the trials with which two
/// equal studies are shown to be equivalent.
ExitCode print_equivalence_plan(const command_line::Arguments& arguments);

}  // namespace zerocount::design_commands
