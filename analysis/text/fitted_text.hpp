#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace zerocount::text {

/// Fits a text to the width of a terminal.
///
/// A table of aligned_table that is too wide is divided into tables one below the other. Each repeats the
/// first column, which names the rows, and takes as many of the other columns as fit; words of a column that
/// does not fit by itself are wrapped within its cells. All other lines are wrapped between words, and
/// continue two columns further in. Words are only broken in tables, where they are wider than their cell.
///
/// @param width columns of the terminal, at least 20; nothing: the text stays as it is
std::string fitted(std::string_view text, std::optional<std::size_t> width);

/// Lines of sentences are not wider than this, on any terminal: longer ones are hard to read.
inline constexpr std::size_t width_of_prose = 120;

}  // namespace zerocount::text
