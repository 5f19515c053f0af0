#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount::text {

/// k of n as a percentage with at most one decimal; "–" if n is 0. Values that would round to 0 % or 100 %
/// are written "< 0.1 %" or "> 99.9 %".
std::string percentage(std::int64_t successes, std::int64_t trials);

/// `value` with four significant digits, "–" for NaN.
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
  bool numeric{false};             ///< aligned to the right
  std::vector<std::string> cells;  ///< [row], without the header
};

/// A table as text: columns of equal length, two spaces apart, with underlined headers.
///
/// One that is wider than `width` is divided into tables one below the other. Each repeats the first column,
/// which names the rows, and takes as many of the other columns as fit; a column that does not fit by itself
/// is wrapped within its cells, where words that are wider are broken.
/// @param width columns of the terminal, at least 20; nothing: no limit
std::string aligned_table(const std::vector<TextColumn>& columns, std::optional<std::size_t> width = {});

/// Escapes & < > " ' for text and quoted attributes of HTML or XML.
std::string escaped_markup(std::string_view text);

}  // namespace zerocount::text
