#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace zerocount::text {

/// Fits sentences to the width of a terminal: lines are wrapped between words, and continue two columns
/// further in, or below the text of an entry that follows its name after two spaces or more. Tables are made
/// for a width (aligned_table).
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
