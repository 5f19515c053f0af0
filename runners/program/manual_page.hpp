#pragma once

#include <span>
#include <string>

#include "runners/commands/command.hpp"

namespace zerocount::program {

/// The manual page zerocount(1) in the language of man(7), from the help of the commands.
/// @param version of the program
std::string manual_page(std::span<const commands::Command> commands, const std::string& version);

}  // namespace zerocount::program
