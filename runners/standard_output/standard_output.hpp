#pragma once

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

}  // namespace zerocount::standard_output
