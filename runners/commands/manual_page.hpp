#pragma once

#include <span>
#include <string>

#include "runners/commands/commands.hpp"

namespace zerocount::commands {

/// The manual page zerocount(1) in the language of man(7), from the help of the commands.
/// @param version of the program
std::string manual_page(std::span<const Command> commands, const std::string& version);

}  // namespace zerocount::commands
