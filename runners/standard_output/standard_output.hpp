#pragma once

#include <string_view>
#include <utility>

#include <fmt/format.h>

/// The output of the commands. It repeats names from manifests and files, which may contain control
/// characters.
namespace zerocount::standard_output {

/// Writes data (JSON, CSV, pictures) as they are; to a terminal, with the control characters replaced.
/// @throws std::system_error if it cannot be written
void write(std::string_view data);

/// Writes tables and sentences for people, as terminal::fitted_to.
/// @throws std::system_error if they cannot be written
void write_fitted(std::string_view text);

/// Lets readers have what was written, before the command goes on.
/// @throws std::system_error if it cannot be written
void flush();

/// Writes a formatted text likewise.
template <class... Arguments>
void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_fitted(fmt::format(format, std::forward<Arguments>(arguments)...));
}

}  // namespace zerocount::standard_output
