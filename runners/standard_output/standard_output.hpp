#pragma once

#include <string_view>
#include <utility>

#include <fmt/format.h>

/// Writes the output of the commands to standard output. Names from manifests and files may contain control
/// characters, which are not sent to a terminal.
namespace zerocount::standard_output {

/// Writes data (JSON, CSV, pictures) unchanged to standard output. On a terminal, control characters are
/// replaced.
/// @throws std::system_error if it cannot be written
void write(std::string_view data);

/// Writes tables and sentences for people to standard output, fitted to the width of a terminal
/// (terminal::fitted_to()).
/// @throws std::system_error if they cannot be written
void write_fitted(std::string_view text);

/// Flushes standard output, so that readers get the text before the command goes on.
/// @throws std::system_error if it cannot be written
void flush();

/// Formats a text and writes it to standard output with write_fitted().
template <class... Arguments>
void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_fitted(fmt::format(format, std::forward<Arguments>(arguments)...));
}

}  // namespace zerocount::standard_output
