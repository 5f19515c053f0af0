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
/// continue two columns further in, or below the text of an entry that follows its name after two spaces or
/// more. Words are only broken in tables, where they are wider than their cell.
///
/// @param width columns of the terminal, at least 20; nothing: the text stays as it is
std::string fitted(std::string_view text, std::optional<std::size_t> width);

/// A line of parts between commas that fits into the width: parts are left out, the last but one first, and
/// if the first is still too wide, its end. The first and the last say most.
std::string shortened(std::string_view line, std::size_t width);

/// A text whose paragraphs were wrapped by hand at about `width`, with each paragraph on one line: a line
/// that had no room for the next word is joined with the next line, if both are indented alike
/// and it ends no entry of a list (;).
std::string unwrapped(std::string_view text, std::size_t width);

/// Lines of sentences are not wider than this, on any terminal: longer ones are hard to read.
inline constexpr std::size_t width_of_prose = 120;

}  // namespace zerocount::text
