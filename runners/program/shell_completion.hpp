#pragma once

#include <span>
#include <string>

#include "runners/commands/command.hpp"

namespace zerocount::program {

/// The completion of commands, options and files for bash, from the tables of options.
std::string bash_completion(std::span<const commands::Command> commands);

/// The completion for zsh, which also shows the help of each.
std::string zsh_completion(std::span<const commands::Command> commands);

/// The completion for fish, which shows the help too.
std::string fish_completion(std::span<const commands::Command> commands);

}  // namespace zerocount::program
