#include "analysis/text/fitted_text.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/text/text.hpp"
#include "core/text/utf8.hpp"

namespace zerocount::text {
namespace {

constexpr std::size_t gap = 2;  ///< columns of the terminal between the columns of a table
constexpr std::string_view rule = "─";

/// Where a column of a table stands in its lines, in columns of the terminal.
struct Span {
  std::size_t first{0};
  std::size_t width{0};

  std::size_t end() const { return first + width; }
};

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

/// The part of a line that stands in the span.
std::string_view part_of(std::string_view line, const Span& span) {
  std::size_t at = 0;
  std::size_t begin = line.size();
  for (std::string_view rest = line; !rest.empty();) {
    if (at >= span.first) begin = std::min(begin, line.size() - rest.size());
    if (at >= span.end()) return line.substr(begin, line.size() - rest.size() - begin);
    const CodePoint point = decode(rest);
    at += display_width(rest.substr(0, point.bytes));
    rest.remove_prefix(point.bytes);
  }
  return line.substr(begin);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

/// The columns of a table from the line below its head; none where the line is another.
std::vector<Span> columns_of(std::string_view line) {
  std::vector<Span> columns;
  std::size_t at = 0;
  bool in_column = false;
  while (!line.empty()) {
    const bool ruled = line.substr(0, rule.size()) == rule;
    if (!ruled && line.front() != ' ') return {};
    if (ruled && !in_column) columns.push_back({at, 0});
    if (ruled) ++columns.back().width;
    in_column = ruled;
    line.remove_prefix(ruled ? rule.size() : 1);
    ++at;
  }
  return columns;
}

/// Whether the line can be a row of a table: between its columns there is nothing.
bool is_row(std::string_view line, const std::vector<Span>& columns) {
  if (trimmed(line).empty()) return false;
  if (display_width(line) > columns.back().end()) return false;
  for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
    const Span between{columns[i].end(), columns[i + 1].first - columns[i].end()};
    if (!trimmed(part_of(line, between)).empty()) return false;
  }
  return true;
}

/// The first characters of a word that fit into the width.
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

/// The end of the word that begins there; a percent sign belongs to its number.
std::size_t end_of_word(std::string_view text, std::size_t begin) {
  constexpr std::string_view percent = " %";
  std::size_t end = std::min(text.find(' ', begin), text.size());
  while (text.substr(end, percent.size()) == percent)
    end = std::min(text.find(' ', end + percent.size()), text.size());
  return end;
}

/// Text in lines of at most `width`. Runs of spaces between words stay, unless a line ends there.
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

/// Where a line that is too long continues: below its text if that follows a name and a gap, as in a list of
/// options, otherwise a little further in.
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

/// A column as wide as it is shown.
struct ShownColumn {
  Span span;
  std::size_t width{0};
};

/// A row of a table: its cells, wrapped to their widths, side by side.
void append_row(std::string& text, std::string_view line, const std::vector<ShownColumn>& columns) {
  std::vector<std::vector<std::string>> cells;
  std::size_t height = 1;
  for (const ShownColumn& column : columns) {
    const std::string_view cell = part_of(line, column.span);
    // Cells that fit keep their place in the column: they may be aligned to the right.
    cells.push_back(column.width == column.span.width
                        ? std::vector<std::string>{std::string(cell)}
                        : wrapped(trimmed(cell), column.width, column.width, true));
    height = std::max(height, cells.back().size());
  }
  for (std::size_t i = 0; i < height; ++i) {
    std::string shown;
    for (std::size_t column = 0; column < columns.size(); ++column) {
      const std::string cell = i < cells[column].size() ? cells[column][i] : "";
      shown += cell + std::string(columns[column].width - display_width(cell) + gap, ' ');
    }
    append_line(text, std::move(shown));
  }
}

void append_table(std::string& text, const std::vector<std::string_view>& lines,
                  const std::vector<ShownColumn>& columns) {
  for (std::size_t row = 0; row < lines.size(); ++row) {
    if (row != 1) {
      append_row(text, lines[row], columns);
      continue;
    }
    std::string ruled;
    for (const ShownColumn& column : columns) {
      for (std::size_t i = 0; i < column.width; ++i) ruled += rule;
      ruled += std::string(gap, ' ');
    }
    append_line(text, std::move(ruled));
  }
}

/// Divides a table that is wider than `width`.
void append_divided(std::string& text, const std::vector<std::string_view>& lines,
                    const std::vector<Span>& columns, std::size_t width) {
  const std::size_t of_key = columns.size() == 1 ? width : width / 3;
  const ShownColumn key{columns.front(), std::min(columns.front().width, of_key)};
  const std::size_t room = width - key.width - gap;
  std::vector<ShownColumn> shown{key};
  std::size_t used = 0;
  bool first = true;
  const auto finish = [&] {
    if (!first) text += "\n";
    first = false;
    append_table(text, lines, shown);
  };
  for (std::size_t i = 1; i < columns.size(); ++i) {
    const std::size_t wide = std::min(columns[i].width, room);
    if (used > 0 && used + gap + wide > room) {
      finish();
      shown = {key};
      used = 0;
    }
    used += (used > 0 ? gap : 0) + wide;
    shown.push_back({columns[i], wide});
  }
  finish();
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
  const std::size_t of_prose = std::min(*width, width_of_prose);
  const std::vector<std::string_view> lines = lines_of(text);
  std::string result;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::vector<Span> columns = i + 1 < lines.size() ? columns_of(lines[i + 1]) : std::vector<Span>{};
    if (columns.empty()) {
      append_prose(result, lines[i], of_prose);
      continue;
    }
    std::vector<std::string_view> table{lines[i], lines[i + 1]};
    for (i += 2; i < lines.size() && is_row(lines[i], columns); ++i) table.push_back(lines[i]);
    --i;
    if (columns.back().end() <= *width) {
      for (const std::string_view line : table) append_line(result, std::string(line));
    } else {
      append_divided(result, table, columns, *width);
    }
  }
  if (!text.empty() && text.back() != '\n') result.pop_back();
  return result;
}

}  // namespace zerocount::text
