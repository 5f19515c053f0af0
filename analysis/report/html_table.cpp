#include "analysis/report/html_table.hpp"

#include <cstddef>

#include <fmt/format.h>

#include "analysis/report/escaping.hpp"

namespace zerocount::report {

void add_row(std::vector<HtmlColumn>& columns, std::vector<std::string> cells) {
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i].cells.push_back(std::move(cells[i]));
}

std::string html_table(const std::vector<HtmlColumn>& columns) {
  std::string text = "<div class=\"scroll\"><table><thead><tr>";
  for (const HtmlColumn& column : columns) {
    text += fmt::format(
        "<th{}>{}{}</th>", column.text ? " class=\"text\"" : "", html_text(column.head),
        column.unit.empty() ? "" : fmt::format("<span class=\"unit\">{}</span>", html_text(column.unit)));
  }
  text += "</tr></thead><tbody>\n";
  for (std::size_t row = 0; !columns.empty() && row < columns.front().cells.size(); ++row) {
    text += "<tr>";
    for (const HtmlColumn& column : columns) {
      text +=
          fmt::format("<td{}>{}", column.text ? " class=\"text wrap\"" : "", html_text(column.cells[row]));
      if (!column.below.empty())
        text += fmt::format("<span class=\"unit\">{}</span>", html_text(column.below[row]));
      text += "</td>";
    }
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string html_facts(const std::vector<HtmlFact>& facts) {
  std::string text = "<div class=\"scroll\"><table class=\"facts\"><tbody>\n";
  for (const HtmlFact& fact : facts)
    text += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", html_text(fact.name), html_text(fact.value));
  return text + "</tbody></table></div>\n";
}

std::string html_folded(const std::string& head, const std::string& text) {
  return fmt::format("<details><summary>{}</summary><pre>{}</pre></details>\n", html_text(head),
                     html_text(text));
}

}  // namespace zerocount::report
