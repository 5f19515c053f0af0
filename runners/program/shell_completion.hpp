#pragma once

#include <span>
#include <string>
#include <string_view>

#include "runners/commands/command.hpp"

/// Completion in the shells. The script of a shell passes the words of the line to the program ('zerocount
/// completion candidates -- WORD...'), offers the lines that it prints, and knows how the shell quotes.
namespace zerocount::program {

/// What may stand in place of the last of the words that follow the program's name, a line each: the
/// candidate, or after a tab its help. Before them ":files" stands for files, ":keys" says that no blank
/// follows, ":list" that the word is a list with commas. For a word in the form --option=value: of the value
/// alone.
void print_candidates(std::span<const commands::Command> commands, std::span<const std::string> words);

/// @param shell bash, zsh or fish
std::string_view completion_script(std::string_view shell);

}  // namespace zerocount::program
