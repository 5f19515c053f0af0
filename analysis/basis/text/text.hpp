#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/text/relation.hpp"

namespace zerocount::text {

/// Fits sentences to the width of a terminal: lines are wrapped between words, and continue two columns
/// further in, or below the text of an entry that follows its name after two spaces or more. Tables are made
/// for a width (aligned_table).
/// @param width columns of the terminal, at least 20; nothing: the text stays as it is
std::string fitted(std::string_view text, std::optional<std::size_t> width);

/// Shortens a line of parts between commas to `width` terminal columns. Parts are left out, the last but one
/// first, because the first and the last say most. If the first part alone is still too wide, its end is cut
/// off.
std::string shortened(std::string_view line, std::size_t width);

/// A text whose paragraphs were wrapped by hand at about `width`, with each paragraph on one line: a line
/// that had no room for the next word is joined with the next line, if both are indented alike
/// and it ends no entry of a list (;).
std::string unwrapped(std::string_view text, std::size_t width);

/// Largest width of lines of sentences on any terminal. Longer lines are hard to read.
inline constexpr std::size_t width_of_prose = 120;

// Proportions as percentages. No bound is ever rounded towards what it does not show: a lower bound is
// rounded down, an upper bound up.

/// Text of an exactly known proportion as a percentage, with as many digits as distinguish it from 0 and 1:
/// "95 %", "99.99999 %".
std::string percent(double proportion);

/// Text of an observed proportion as a percentage, rounded to as many digits as distinguish it from 0 and 1,
/// with at least one decimal: "97.4 %", "99.96 %"; "0 %" and "100 %" are exact.
std::string percent_near(double proportion);

/// Text of a lower bound p of a proportion as a percentage, rounded down to two significant digits of the
/// smaller of p and 1 − p, and to one decimal if both are above 1 %. Never "100 %": no sample shows that.
std::string percent_at_least(double proportion);

/// Text of an upper bound of a proportion as a percentage, rounded up to two significant digits, and to one
/// decimal above 1 %. Never "0 %" unless it is 0.
std::string percent_at_most(double proportion);

/// Text of a number rounded down (next function: up) to `decimals` decimals. Digits that come from rounding
/// errors do not count.
std::string rounded_down(double value, int decimals);
std::string rounded_up(double value, int decimals);

/// Text of two bounds of a proportion in percent, rounded outward: "96.6, 99.1".
std::string percent_bounds(double low, double high, int decimals = 1, const char* between = ", ");

// Numbers with their units, as people write them.

/// Text of a number with `digits` significant digits and a short exponent: "5.9e6", "0.0125"; "–" for NaN.
std::string number_text(double value, int digits = 4);

/// Text of a number with its unit; lengths, angles, times and frequencies have a prefix: "10 nm", "1.2 mm/s",
/// "16 kHz", "5.9e6 N/m". No unit where it is "1".
std::string quantity_text(double value, std::string_view unit, int digits = 4);

/// Text of a range with its unit, with one prefix for both ends: "310 … 930 N s/m"; one number if the ends
/// are equal.
std::string range_text(double low, double high, std::string_view unit);

/// Text of numbers with one unit: "20, 21, 20, 0 µm".
std::string list_text(std::span<const double> values, std::string_view unit);

/// The values, with each value that answers show as the same number as the limit replaced by the limit, so
/// that a number copied from an answer means the value that the answer shows rounded. Nothing is replaced if
/// a value is equal to the limit.
///
///     = and !=   compare at the digits in which the limit is written
///     others     compare at these digits too, but at no fewer than answers show (short_digits):
///                11767.76 is at most 11767.7 and at most 1.176e4, but 12 300 is not at most 1.2e4
///
/// @param limit a number as text
std::vector<double> values_as_written(Relation relation, std::vector<double> values, std::string_view limit);

/// Text of k successes in n trials as a percentage with at most one decimal; "–" if n is 0. Values that would
/// round to 0 % or 100 % are written "< 0.1 %" or "> 99.9 %".
std::string percentage(std::int64_t successes, std::int64_t trials);

/// Number of significant digits of short_number(), the smallest that an answer shows.
inline constexpr int short_digits = 4;

/// Text of `value` with four significant digits, "–" for NaN.
std::string short_number(double value);

/// Width of UTF-8 text on a terminal in columns: combining marks have 0, East Asian wide characters and
/// emoji 2.
std::size_t display_width(std::string_view text);

/// `text` on one line: each control character (is_control), and each byte that is not UTF-8,
/// replaced by U+FFFD.
std::string printable(std::string_view text);

/// A column of a table.
struct TextColumn {
  std::string head;
  bool numeric{false};             ///< True if the cells are aligned to the right.
  std::vector<std::string> cells;  ///< [row] Cells without the header.
};

/// A table as text: columns of equal length, two spaces apart, with underlined headers.
///
/// One that is wider than `width` is divided into tables one below the other. Each repeats the first column,
/// which names the rows, and takes as many of the other columns as fit; a column that does not fit by itself
/// is wrapped within its cells, where words that are wider are broken.
/// @param width columns of the terminal, at least 20. Nothing: no limit, and the table is not divided. In
/// either case a cell behind the first column is wrapped between its words at width_of_prose
std::string aligned_table(const std::vector<TextColumn>& columns, std::optional<std::size_t> width = {});

/// Escapes & < > " ' for text and quoted attributes of HTML or XML.
std::string escaped_markup(std::string_view text);

}  // namespace zerocount::text
