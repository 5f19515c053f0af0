#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount {

/// k of n as a percentage with one decimal at most; "–" where n is 0. Only 0 of n is "0 %" and only n of n
/// "100 %": what would round to them is "< 0.1 %" or "> 99.9 %".
std::string percentage(std::int64_t successes, std::int64_t trials);

/// `value` with four significant digits, "–" for NaN.
std::string short_number(double value);

/// Columns that UTF-8 text takes on a terminal: combining marks none, East Asian wide characters and emoji
/// two.
std::size_t display_width(std::string_view text);

/// `text` on one line: each control character, and each byte that is not UTF-8, replaced by U+FFFD.
std::string printable(std::string_view text);

/// A column of a table.
struct TextColumn {
  std::string head;
  bool numeric{false};             ///< aligned to the right
  std::vector<std::string> cells;  ///< [row], without the head
};

/// A table as text: columns of equal length two spaces apart, the heads underlined.
std::string aligned_table(const std::vector<TextColumn>& columns);

/// A table as text: cells[row][column] in aligned columns two spaces apart, the first row underlined;
/// `numeric` columns are aligned to the right. All rows must have the length of `numeric`.
std::string aligned_table(const std::vector<std::vector<std::string>>& cells,
                          const std::vector<bool>& numeric);

/// As text or a quoted attribute of HTML or XML: & < > " ' escaped.
std::string escaped_markup(std::string_view text);

}  // namespace zerocount
