#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "core/text/text.hpp"

namespace zerocount::text {
namespace {

constexpr std::size_t gap = 2;  ///< Number of terminal columns between the columns of a table.
constexpr std::string_view rule = "─";

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

/// The first characters of a word that fit into `width` terminal columns, at least one.
std::string_view fitting_part(std::string_view word, std::size_t width) {
  std::size_t bytes = 0;
  std::size_t used = 0;
  while (bytes < word.size()) {
    const std::size_t next = decode(word.substr(bytes)).bytes;
    used += display_width(word.substr(bytes, next));
    if (used > width && bytes > 0) break;
    bytes += next;
  }
  return word.substr(0, bytes);
}

/// Index one past the end of the word that begins at `begin`. A percent sign after a space belongs to its
/// number.
std::size_t end_of_word(std::string_view text, std::size_t begin) {
  constexpr std::string_view percent = " %";
  std::size_t end = std::min(text.find(' ', begin), text.size());
  while (text.substr(end, percent.size()) == percent)
    end = std::min(text.find(' ', end + percent.size()), text.size());
  return end;
}

/// Breaks the text into lines: the first of at most `width` terminal columns, the others of at most
/// `later_width`. Runs of spaces between words stay, unless a line ends there.
/// @param breaks_words whether words that are wider than a line are broken
std::vector<std::string> wrapped(std::string_view text, std::size_t width, std::size_t later_width,
                                 bool breaks_words) {
  std::vector<std::string> lines(1);
  while (!text.empty()) {
    const std::size_t limit = lines.size() == 1 ? width : later_width;
    const std::size_t word_begin = std::min(text.find_first_not_of(' '), text.size());
    const std::size_t word_end = end_of_word(text, word_begin);
    std::string_view word = text.substr(word_begin, word_end - word_begin);
    const bool fits =
        display_width(lines.back()) + (lines.back().empty() ? 0 : word_begin) + display_width(word) <= limit;
    if (!fits && !lines.back().empty()) {
      lines.emplace_back();
      continue;
    }
    if (!fits && breaks_words) word = fitting_part(word, limit);
    if (!lines.back().empty()) lines.back() += text.substr(0, word_begin);
    lines.back() += word;
    text.remove_prefix(word_begin + word.size());
  }
  return lines;
}

void append_line(std::string& text, std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  text += line + "\n";
}

/// Indent, in terminal columns, with which the continuation of a line that is too long begins. If the text of
/// the line follows a name and a gap, as in a list of options, it continues below the text, otherwise a
/// little further in.
std::size_t hanging_indent(std::string_view line, std::size_t indent, std::size_t width) {
  std::size_t hanging = std::min(indent + gap, width / 2);
  for (std::size_t at = line.find("  ", indent); at != std::string_view::npos; at = line.find("  ", at)) {
    at = line.find_first_not_of(' ', at);
    if (at == std::string_view::npos || display_width(line.substr(0, at)) > width / 2) break;
    hanging = display_width(line.substr(0, at));
  }
  return hanging;
}

void append_prose(std::string& text, std::string_view line, std::size_t width) {
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t later = hanging_indent(line, indent, width);
  if (display_width(line) <= width || indent >= width / 2) return append_line(text, std::string(line));
  const std::vector<std::string> lines = wrapped(line.substr(indent), width - indent, width - later, false);
  for (std::size_t i = 0; i < lines.size(); ++i)
    append_line(text, std::string(i == 0 ? indent : later, ' ') + lines[i]);
}

/// A column with its width in the table. It is narrower than its cells if they are wrapped.
struct ShownColumn {
  const TextColumn* column;
  std::size_t wide;   ///< Width of the widest cell, in terminal columns.
  std::size_t width;  ///< Width that the column has in the table, in terminal columns.
};

/// Width of a column of text if the terminal has no limit: long cells are wrapped between words, so that
/// lines stay readable.
std::size_t readable_width(const TextColumn& column, std::size_t wide) {
  if (column.numeric || wide <= width_of_prose) return wide;
  std::size_t width = std::max(width_of_prose, display_width(column.head));
  for (const std::string& cell : column.cells) {
    for (std::size_t begin = 0; begin < cell.size(); begin = end_of_word(cell, begin) + 1)
      width = std::max(width,
                       display_width(std::string_view(cell).substr(begin, end_of_word(cell, begin) - begin)));
  }
  return std::min(width, wide);
}

/// Appends a row of a table to `text`: its cells side by side.
/// @param row index of the row; nothing: the heads
void append_row(std::string& text, const std::vector<ShownColumn>& columns, std::optional<std::size_t> row) {
  std::vector<std::vector<std::string>> cells;
  std::size_t height = 1;
  for (const auto& [column, wide, width] : columns) {
    const std::string& cell = row ? column->cells[*row] : column->head;
    const std::string padding(wide - display_width(cell), ' ');
    cells.push_back(width < wide ? wrapped(cell, width, width, true)
                                 : std::vector{column->numeric ? padding + cell : cell});
    height = std::max(height, cells.back().size());
  }
  for (std::size_t i = 0; i < height; ++i) {
    std::string line;
    for (std::size_t column = 0; column < columns.size(); ++column) {
      const std::string cell = i < cells[column].size() ? cells[column][i] : "";
      line += cell + std::string(columns[column].width - display_width(cell) + gap, ' ');
    }
    append_line(text, std::move(line));
  }
}

void append_table(std::string& text, const std::vector<ShownColumn>& columns) {
  if (!text.empty()) text += '\n';
  append_row(text, columns, std::nullopt);
  std::string ruled;
  for (const ShownColumn& column : columns) {
    for (std::size_t i = 0; i < column.width; ++i) ruled += rule;
    ruled += std::string(gap, ' ');
  }
  append_line(text, std::move(ruled));
  for (std::size_t row = 0; row < columns.front().column->cells.size(); ++row) append_row(text, columns, row);
}

}  // namespace

std::string shortened(std::string_view line, std::size_t width) {
  constexpr std::string_view comma = ", ";
  constexpr std::string_view cut = "…";
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(comma, begin), line.size());
    parts.push_back(line.substr(begin, end - begin));
    begin = end + comma.size();
  }
  const auto joined = [&] { return fmt::format("{}", fmt::join(parts, comma)); };
  while (parts.size() > 2 && display_width(joined()) > width) parts.erase(parts.end() - 2);
  if (parts.size() == 2 && display_width(joined()) > width) parts.pop_back();
  std::string text = joined();
  if (display_width(text) <= width) return text;
  return std::string(fitting_part(text, width - 1)).append(cut);
}

std::string unwrapped(std::string_view text, std::size_t width) {
  const auto indent_of = [](std::string_view line) {
    return std::min(line.find_first_not_of(' '), line.size());
  };
  std::string result;
  std::string_view before;
  for (const std::string_view line : lines_of(text)) {
    const std::size_t indent = indent_of(line);
    const std::size_t word = end_of_word(line, indent) - indent;
    const bool item = line.substr(indent).starts_with("- ");
    const bool continues = !before.empty() && !before.ends_with(';') && !line.empty() && !item &&
                           indent == indent_of(before) && display_width(before) + 1 + word > width;
    if (continues) result.back() = ' ';
    result += line.substr(continues ? indent : 0);
    result += '\n';
    before = line;
  }
  if (!text.empty() && text.back() != '\n') result.pop_back();
  return result;
}

std::string fitted(std::string_view text, std::optional<std::size_t> width) {
  if (!width) return std::string(text);
  std::string result;
  for (const std::string_view line : lines_of(text))
    append_prose(result, line, std::min(*width, width_of_prose));
  if (!text.empty() && text.back() != '\n') result.pop_back();
  return result;
}

std::string aligned_table(const std::vector<TextColumn>& columns, std::optional<std::size_t> width) {
  std::string table;
  std::vector<ShownColumn> all;
  std::size_t used = 0;
  for (const TextColumn& column : columns) {
    std::size_t wide = display_width(column.head);
    for (const std::string& cell : column.cells) wide = std::max(wide, display_width(cell));
    all.push_back({&column, wide, all.empty() ? wide : readable_width(column, wide)});
    used += all.back().width + gap;
  }
  if (all.empty()) return table;
  if (!width || used - gap <= *width) {
    append_table(table, all);
    return table;
  }
  ShownColumn key = all.front();
  key.width = std::min(key.wide, all.size() == 1 ? *width : *width / 3);
  const std::size_t room = *width - key.width - std::min(gap, *width - key.width);
  std::vector<ShownColumn> shown{key};
  used = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    all[i].width = std::min(all[i].width, room);
    if (used > 0 && used + gap + all[i].width > room) {
      append_table(table, shown);
      shown = {key};
      used = 0;
    }
    used += (used > 0 ? gap : 0) + all[i].width;
    shown.push_back(all[i]);
  }
  append_table(table, shown);
  return table;
}

}  // namespace zerocount::text
