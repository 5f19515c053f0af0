#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/text/utf8.hpp"

/// The output of the commands. It repeats names from manifests and files, which may contain control
/// characters.
namespace zerocount::standard_output {

/// Writes data (JSON, CSV, pictures) as they are; to a terminal, with the control characters replaced.
/// @throws std::system_error if it cannot be written
void write(std::string_view data);

/// Writes a formatted text, whose control characters are replaced.
/// @throws std::system_error if it cannot be written
template <class... Arguments>
void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write(text::printable_lines(fmt::format(format, std::forward<Arguments>(arguments)...)));
}

/// Width of the terminal that standard output is, in columns: that of the device, else the environment's
/// COLUMNS, else 80. Nothing if standard output is no terminal.
std::optional<std::size_t> terminal_width();

/// Writes tables and sentences for people, fitted to the width of the terminal (text::fitted).
/// @throws std::system_error if they cannot be written
void write_fitted(std::string_view text);

/// Writes a formatted text likewise.
template <class... Arguments>
void show(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_fitted(fmt::format(format, std::forward<Arguments>(arguments)...));
}

}  // namespace zerocount::standard_output
