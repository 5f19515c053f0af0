#pragma once

#include <span>
#include <string>
#include <string_view>

#include "runners/commands/command.hpp"

/// Completion in the shells. The script of a shell passes the words of the line to the program ('zerocount
/// completion candidates -- WORD...'), offers the lines that it prints, and knows how the shell quotes.
namespace zerocount::program {

/// The manual page zerocount(1) in the language of man(7), from the help of the commands.
/// @param version of the program
std::string manual_page(std::span<const commands::Command> commands, const std::string& version);

commands::Command completion_command();
commands::Command manual_command();
commands::Command schema_command();

/// What may stand in place of the last of the words that follow the program's name, a line each: the
/// candidate, or after a tab its help. Before them ":files" stands for files, ":keys" says that no blank
/// follows, ":list" that the word is a list with commas. For a word in the form --option=value: of the value
/// alone.
void print_candidates(std::span<const commands::Command> commands, std::span<const std::string> words);

/// @param shell bash, zsh or fish
std::string_view completion_script(std::string_view shell);

}  // namespace zerocount::program
