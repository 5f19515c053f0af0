#include "analysis/basis/text/text.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/document/blocks.hpp"
#include "core/text/text.hpp"

namespace zerocount::document {
namespace {

std::string with_line_end(std::string sentence) {
  if (!sentence.ends_with('\n')) sentence += '\n';
  return sentence;
}

std::string facts_text(const std::vector<Fact>& facts) {
  std::size_t width = 0;
  for (const Fact& fact : facts) width = std::max(width, text::display_width(fact.name));
  std::string lines;
  for (const Fact& fact : facts) {
    const std::string gap(width + 1 - text::display_width(fact.name), ' ');
    lines += fact.name + ':' + gap + fact.value + '\n';
  }
  return lines;
}

std::string table_text(const TableBlock& table, std::optional<std::size_t> width) {
  std::vector<text::TextColumn> columns;
  for (const BlockColumn& column : table.columns) {
    std::vector<std::string> cells;
    for (const std::string& cell : column.cells) cells.push_back(text::printable(cell));
    columns.push_back({column.unit.empty() ? column.head : fmt::format("{} ({})", column.head, column.unit),
                       column.numeric, std::move(cells)});
  }
  const std::string title =
      table.title.empty() ? "" : text::fitted(fmt::format("{}:\n\n", table.title), width);
  return title + text::aligned_table(columns, width);
}

/// Visitor that returns the plain text of each kind of block.
struct BlockText {
  std::optional<std::size_t> width;

  std::string operator()(const HeadlineBlock& block) const { return lines(block.sentence); }
  std::string operator()(const SentenceBlock& block) const { return lines(block.sentence); }
  std::string operator()(const FactsBlock& block) const { return lines(facts_text(block.facts)); }
  std::string operator()(const TableBlock& block) const { return table_text(block, width); }
  std::string operator()(const SectionBlock& block) const { return lines(block.title + ":"); }
  std::string operator()(const VerbatimBlock& block) const {
    return (block.title.empty() ? "" : fmt::format("{}:\n\n", block.title)) + lines(block.lines);
  }

 private:
  std::string lines(const std::string& sentences) const {
    return text::fitted(text::printable_lines(with_line_end(sentences)), width);
  }
};

/// Whether a blank line separates these two successive blocks in plain text.
bool apart(const Block& above, const Block& below) {
  const auto stands_alone = [](const Block& block) {
    return std::holds_alternative<TableBlock>(block) || std::holds_alternative<VerbatimBlock>(block);
  };
  return stands_alone(above) || stands_alone(below) || std::holds_alternative<SectionBlock>(below);
}

}  // namespace

std::string text(const Answer& answer) {
  return text(answer, std::nullopt);
}

std::string text(const Answer& answer, std::optional<std::size_t> width) {
  std::string text;
  const std::vector<Block> all = blocks(answer);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0 && apart(all[i - 1], all[i])) text += '\n';
    text += std::visit(BlockText{width}, all[i]);
  }
  return text;
}

}  // namespace zerocount::document
