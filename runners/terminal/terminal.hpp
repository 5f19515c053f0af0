#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

/// Properties of the terminals to which standard output and standard error may lead.
namespace zerocount::terminal {

/// Width, in characters, for text that is written to a file descriptor; nothing: lines may have any length.
/// For a terminal it is the terminal's width, else the environment's COLUMNS, else 80. For a file or a pipe
/// it is the environment's COLUMNS, else nothing. If COLUMNS is 0, lines may have any length.
std::optional<std::size_t> width_of(int descriptor);

/// Whether the file descriptor is a terminal that obeys escape sequences. A terminal with TERM=dumb does not.
bool obeys_escapes(int descriptor);

/// The text, prepared for people and a file descriptor: without control characters, and with lines broken to
/// its width (text::fitted).
std::string fitted_to(int descriptor, std::string_view text);

}  // namespace zerocount::terminal
