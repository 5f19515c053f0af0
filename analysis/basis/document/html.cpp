#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/document/blocks.hpp"

namespace zerocount::document {
namespace {

/// Largest number of columns of a table that fits on a page.
constexpr std::size_t max_columns = 10;

std::string facts_html(const std::vector<Fact>& facts) {
  std::string html = "<table class=\"facts\"><tbody>\n";
  for (const Fact& fact : facts)
    html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", markup(fact.name), markup(fact.value));
  return html + "</tbody></table>\n";
}

std::string unit_html(const BlockColumn& column) {
  return column.unit.empty() ? "" : fmt::format("<span class=\"unit\">{}</span>", markup(column.unit));
}

/// The name of a file, percent-encoded for use in a URL.
std::string percent_encoded(std::string_view name) {
  std::string text;
  for (const char c : name) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                          std::string_view("-._~").find(c) != std::string_view::npos;
    text += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return text;
}

std::string linked_cell(const BlockColumn& column, std::size_t row) {
  const std::string cell = markup(column.cells[row]);
  if (row >= column.links.size() || column.links[row].empty()) return cell;
  return fmt::format("<a href=\"./{}\">{}</a>", percent_encoded(column.links[row]), cell);
}

/// HTML of one cell of a table. The cell has the head of its column as an attribute; narrow screens show this
/// head in front of the cell.
std::string cell_html(const BlockColumn& column, std::size_t row) {
  return fmt::format("<td{} data-head=\"{}\">{}</td>", column.numeric ? "" : " class=\"text wrap\"",
                     markup(column.head + (column.unit.empty() ? "" : " (" + column.unit + ")")),
                     linked_cell(column, row));
}

/// HTML of the columns as one table.
std::string columns_html(std::span<const BlockColumn* const> columns) {
  std::string html = "<table><thead><tr>";
  for (const BlockColumn* const column : columns)
    html += fmt::format("<th{}>{}{}</th>", column->numeric ? "" : " class=\"text\"", markup(column->head),
                        unit_html(*column));
  html += "</tr></thead><tbody>\n";
  for (std::size_t row = 0; row < columns.front()->cells.size(); ++row) {
    html += "<tr>";
    for (const BlockColumn* const column : columns) html += cell_html(*column, row);
    html += "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

/// The columns of a table with a single row as facts, one below the other.
std::vector<Fact> facts_of_row(const TableBlock& table) {
  std::vector<Fact> facts;
  for (const BlockColumn& column : table.columns)
    facts.push_back({column.head, column.cells.front() + (column.unit.empty() ? "" : " " + column.unit)});
  return facts;
}

/// The HTML of a table. A table with more than max_columns becomes several, each beginning with the first
/// column; if it has a single row, it becomes a list of facts.
std::string table_html(const TableBlock& table) {
  std::string html = table.title.empty() ? "" : fmt::format("<h3>{}</h3>\n", prose_markup(table.title));
  if (table.columns.empty()) return html;
  std::vector<const BlockColumn*> all;
  for (const BlockColumn& column : table.columns) all.push_back(&column);
  if (all.size() <= max_columns) return html + columns_html(all);
  if (all.front()->cells.size() == 1) return html + facts_html(facts_of_row(table));
  const std::size_t parts = (all.size() - 2) / (max_columns - 1) + 1;
  const std::size_t in_part = (all.size() - 2) / parts + 1;
  for (std::size_t from = 1; from < all.size(); from += in_part) {
    std::vector<const BlockColumn*> part{all.front()};
    part.insert(part.end(), all.begin() + static_cast<std::ptrdiff_t>(from),
                all.begin() + static_cast<std::ptrdiff_t>(std::min(from + in_part, all.size())));
    html += columns_html(part);
  }
  return html;
}

/// Visitor that returns the HTML of each kind of block.
struct BlockHtml {
  std::string operator()(const HeadlineBlock& block) const {
    return fmt::format("<div class=\"verdict\"><p class=\"headline\">{}</p></div>\n",
                       prose_markup(block.sentence));
  }
  std::string operator()(const SentenceBlock& block) const {
    return fmt::format("<p class=\"lines\">{}</p>\n", prose_markup(block.sentence));
  }
  std::string operator()(const FactsBlock& block) const { return facts_html(block.facts); }
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

std::string html(const Block& block) {
  return std::visit(BlockHtml{}, block);
}

std::string html(const Answer& answer) {
  std::string text;
  for (const Block& block : blocks(answer)) text += html(block);
  return text;
}

}  // namespace zerocount::document
