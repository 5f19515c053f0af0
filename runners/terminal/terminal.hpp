#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

/// The terminals that standard output and standard error may be.
namespace zerocount::terminal {

/// The number of columns for what is written to the descriptor: that of the terminal, else the environment's
/// COLUMNS, else 80; of a file or a pipe the environment's COLUMNS, else nothing. Where it is nothing, or
/// COLUMNS is 0, lines have any length.
std::optional<std::size_t> width_of(int descriptor);

/// Whether the descriptor is a terminal that obeys escape sequences; TERM=dumb says that it does not.
bool obeys_escapes(int descriptor);

/// A text for people as it is written to the descriptor: without control characters, fitted to its width
/// (text::fitted).
std::string fitted_to(int descriptor, std::string_view text);

}  // namespace zerocount::terminal
