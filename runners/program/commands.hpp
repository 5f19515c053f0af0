#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/failure/failure.hpp"
#include "runners/commands/command.hpp"

namespace zerocount::program {

/// All verbs, in the order of the help.
std::vector<commands::Command> commands();

/// Runs the program with its command-line arguments.
/// @throws Failure with the message for the user and the exit code.
ExitCode run_command_line(std::span<const std::string> words);

}  // namespace zerocount::program
