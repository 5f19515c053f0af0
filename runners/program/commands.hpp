#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/failure/failure.hpp"
#include "runners/commands/command.hpp"

namespace zerocount::program {

/// All commands of the program, in the order in which the help lists them.
std::vector<commands::Command> commands();

/// Runs the program with its command-line arguments. Returns the exit code.
/// @param words arguments without the name of the program
/// @throws Failure with the message for the user and the exit code.
ExitCode run_command_line(std::span<const std::string> words);

// Completion in the shells. The script of a shell passes the words of the line to the program ('zerocount
// completion candidates -- WORD...'), offers the lines that it prints, and knows how the shell quotes.

/// Manual page zerocount(1) in the language of man(7), made from the help of the commands.
/// @param version version of the program
std::string manual_page(std::span<const commands::Command> commands, const std::string& version);

commands::Command completion_command();
commands::Command manual_command();
commands::Command schema_command();

/// Prints the shell completions of the last word, one candidate per line, with its help after a tab. A first
/// line tells how the shell completes: ":files" adds files, ":keys" adds no blank, ":list" completes in a
/// list with commas. For --option=value, only the value is completed.
/// @param words words that follow the name of the program
void print_candidates(std::span<const commands::Command> commands, std::span<const std::string> words);

/// Completion script of a shell.
/// @param shell bash, zsh or fish
std::string_view completion_script(std::string_view shell);

}  // namespace zerocount::program
