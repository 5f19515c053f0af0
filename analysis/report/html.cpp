#include "analysis/report/html.hpp"

#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/document/markup.hpp"

namespace zerocount::report {
namespace {

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// The name of a file as a part of an address.
std::string percent_encoded(std::string_view name) {
  std::string text;
  for (const char c : name) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                          std::string_view("-._~").find(c) != std::string_view::npos;
    text += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return text;
}

}  // namespace

void add_row(std::vector<HtmlColumn>& columns, std::vector<std::string> cells) {
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i].cells.push_back(std::move(cells[i]));
}

namespace {

std::string linked_cell(const HtmlColumn& column, std::size_t row) {
  std::string cell = document::markup(column.cells[row]);
  if (row >= column.links.size() || column.links[row].empty()) return cell;
  return fmt::format("<a href=\"./{}\">{}</a>", document::markup(percent_encoded(column.links[row])), cell);
}

}  // namespace

std::string html_table(const std::vector<HtmlColumn>& columns) {
  std::string text = "<table><thead><tr>";
  for (const HtmlColumn& column : columns) {
    text += fmt::format(
        "<th{}>{}{}</th>", column.text ? " class=\"text\"" : "", document::markup(column.head),
        column.unit.empty() ? ""
                            : fmt::format("<span class=\"unit\">{}</span>", document::markup(column.unit)));
  }
  text += "</tr></thead><tbody>\n";
  for (std::size_t row = 0; !columns.empty() && row < columns.front().cells.size(); ++row) {
    text += "<tr>";
    for (const HtmlColumn& column : columns)
      text += fmt::format("<td{} data-head=\"{}\">{}</td>", column.text ? " class=\"text wrap\"" : "",
                          document::markup(column.head), linked_cell(column, row));
    text += "</tr>\n";
  }
  return text + "</tbody></table>\n";
}

std::string html_facts(const std::vector<HtmlFact>& facts) {
  std::string text = "<table class=\"facts\"><tbody>\n";
  for (const HtmlFact& fact : facts)
    text += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", document::markup(fact.name),
                        document::markup(fact.value));
  return text + "</tbody></table>\n";
}

std::string html_folded(const std::string& head, const std::string& html) {
  return fmt::format("<details><summary>{}</summary>{}</details>\n", document::markup(head), html);
}

std::string script_json(const nlohmann::ordered_json& json) {
  const std::string text = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return replaced(text, "<", "\\u003c");
}

std::string script_source(std::string_view source) {
  return replaced(replaced(std::string(source), "</script", "<\\/script"), "<!--", "<\\!--");
}

}  // namespace zerocount::report
