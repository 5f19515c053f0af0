#include <fmt/format.h>

#include "analysis/document/answer.hpp"
#include "analysis/document/blocks.hpp"
#include "analysis/document/markup.hpp"

namespace zerocount::document {
namespace {

std::string table_html(const TableBlock& table) {
  std::string html = table.title.empty() ? "" : fmt::format("<h3>{}</h3>\n", prose_markup(table.title));
  html += "<div class=\"scroll\"><table><thead><tr>";
  for (const BlockColumn& column : table.columns) {
    html += fmt::format(
        "<th{}>{}{}</th>", column.numeric ? "" : " class=\"text\"", markup(column.head),
        column.unit.empty() ? "" : fmt::format("<span class=\"unit\">{}</span>", markup(column.unit)));
  }
  html += "</tr></thead><tbody>\n";
  for (std::size_t row = 0; !table.columns.empty() && row < table.columns.front().cells.size(); ++row) {
    html += "<tr>";
    for (const BlockColumn& column : table.columns)
      html += fmt::format("<td{}>{}</td>", column.numeric ? "" : " class=\"text wrap\"",
                          markup(column.cells[row]));
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

/// The HTML of each kind of block.
struct BlockHtml {
  std::string operator()(const HeadlineBlock& block) const {
    return fmt::format("<div class=\"verdict\"><p class=\"headline\">{}</p></div>\n",
                       prose_markup(block.sentence));
  }
  std::string operator()(const SentenceBlock& block) const {
    return fmt::format("<p class=\"lines\">{}</p>\n", prose_markup(block.sentence));
  }
  std::string operator()(const FactsBlock& block) const {
    std::string html = "<div class=\"scroll\"><table class=\"facts\"><tbody>\n";
    for (const Fact& fact : block.facts)
      html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", markup(fact.name), markup(fact.value));
    return html + "</tbody></table></div>\n";
  }
  std::string operator()(const TableBlock& block) const { return table_html(block); }
  std::string operator()(const SectionBlock& block) const {
    return fmt::format("<h3>{}</h3>\n", prose_markup(block.title));
  }
  std::string operator()(const VerbatimBlock& block) const {
    const std::string title =
        block.title.empty() ? "" : fmt::format("<h3>{}</h3>\n", prose_markup(block.title));
    return fmt::format("{}<pre>{}</pre>\n", title, markup(block.lines));
  }
};

}  // namespace

std::string html(const Answer& answer) {
  std::string html;
  for (const Block& block : blocks(answer)) html += std::visit(BlockHtml{}, block);
  return html;
}

}  // namespace zerocount::document
