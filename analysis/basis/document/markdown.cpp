#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/document/blocks.hpp"
#include "analysis/basis/text/text.hpp"

namespace zerocount::document {
namespace {

/// Plain text as Markdown on one line. A bracket ends the text of a link, or the name of its destination,
/// only before (, [ or a colon; other brackets, such as those of bounds, stay as they are.
std::string escaped(std::string_view text) {
  const std::string plain = text::printable(text);
  std::string escaped;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const bool ends_link = plain[i] == ']' && i + 1 < plain.size() &&
                           std::string_view("([:").find(plain[i + 1]) != std::string_view::npos;
    if (ends_link || std::string_view("|\\`*_<&~").find(plain[i]) != std::string_view::npos) escaped += '\\';
    escaped += plain[i];
  }
  return escaped;
}

/// Escapes a text for the beginning of a line of Markdown, where some characters begin a heading, a list, a
/// quotation or a rule.
std::string escaped_line(std::string_view text) {
  std::string line = escaped(text);
  const std::size_t digits = std::min(line.find_first_not_of("0123456789"), line.size());
  const std::string_view special = digits == 0 ? "#-+=>" : ".)";
  if (digits < line.size() && special.find(line[digits]) != std::string_view::npos)
    line.insert(digits, 1, '\\');
  return line;
}

/// The text as Markdown with each line as a paragraph; blank lines are dropped.
std::string paragraphs(std::string_view text) {
  std::string paragraphs;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin != std::string_view::npos) paragraphs += escaped_line(line.substr(begin)) + "\n\n";
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return paragraphs;
}

std::string table_row(const std::vector<std::string>& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string table_markdown(const TableBlock& table) {
  std::vector<std::string> heads;
  std::vector<std::string> rules;
  for (const BlockColumn& column : table.columns) {
    heads.push_back(
        escaped(column.unit.empty() ? column.head : fmt::format("{} ({})", column.head, column.unit)));
    rules.emplace_back(column.numeric ? "---:" : "---");
  }
  std::string markdown = table.title.empty() ? "" : fmt::format("{}\n\n", escaped_line(table.title + ":"));
  markdown += table_row(heads) + table_row(rules);
  for (std::size_t row = 0; !table.columns.empty() && row < table.columns.front().cells.size(); ++row) {
    std::vector<std::string> cells;
    for (const BlockColumn& column : table.columns) cells.push_back(escaped(column.cells[row]));
    markdown += table_row(cells);
  }
  return markdown + "\n";
}

/// Visitor that returns the Markdown of each kind of block.
struct BlockMarkdown {
  std::string operator()(const HeadlineBlock& block) const {
    return fmt::format("**{}**\n\n", escaped(block.sentence));
  }
  std::string operator()(const SentenceBlock& block) const { return paragraphs(block.sentence); }
  std::string operator()(const FactsBlock& block) const {
    std::string list;
    for (const Fact& fact : block.facts)
      list += fmt::format("- {}\n", escaped_line(fmt::format("{}: {}", fact.name, fact.value)));
    return list + "\n";
  }
  std::string operator()(const TableBlock& block) const { return table_markdown(block); }
  std::string operator()(const SectionBlock& block) const {
    return fmt::format("### {}\n\n", escaped(block.title));
  }
  std::string operator()(const VerbatimBlock& block) const {
    const std::string title =
        block.title.empty() ? "" : fmt::format("{}\n\n", escaped_line(block.title + ":"));
    std::string fence = "```";
    while (block.lines.find(fence) != std::string::npos) fence += '`';
    return fmt::format("{}{}\n{}{}{}\n\n", title, fence, block.lines, block.lines.ends_with('\n') ? "" : "\n",
                       fence);
  }
};

}  // namespace

std::string markdown(const Answer& answer) {
  std::string markdown;
  for (const Block& block : blocks(answer)) markdown += std::visit(BlockMarkdown{}, block);
  if (markdown.ends_with("\n\n")) markdown.pop_back();
  return markdown;
}

}  // namespace zerocount::document
