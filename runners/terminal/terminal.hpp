#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

/// Properties of the terminals to which standard output and standard error may lead.
namespace zerocount::terminal {

/// Number of columns for text that is written to a descriptor; nothing: lines have any length. For a terminal
/// it is the terminal's width, else the environment's COLUMNS, else 80. For a file or a pipe it is the
/// environment's COLUMNS, else nothing. If COLUMNS is 0, lines have any length.
std::optional<std::size_t> width_of(int descriptor);

/// Whether the descriptor is a terminal that obeys escape sequences. A terminal with TERM=dumb does not.
bool obeys_escapes(int descriptor);

/// Text for people, prepared for a descriptor: without control characters, and fitted to its width
/// (text::fitted).
std::string fitted_to(int descriptor, std::string_view text);

}  // namespace zerocount::terminal
