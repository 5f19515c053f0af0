#pragma once

#include <string>
#include <vector>

namespace zerocount::report {

/// A column of an HTML table. All texts are plain text.
struct HtmlColumn {
  std::string head;  ///< header
  std::string unit;  ///< empty: no unit
  bool text{false};  ///< left-aligned, with line breaks
  std::vector<std::string> cells;
  std::vector<std::string> below{};  ///< [row] smaller second line of the cell; may be empty
};

/// Adds a cell to each column.
void add_row(std::vector<HtmlColumn>& columns, std::vector<std::string> cells);

/// The columns as a table that scrolls if it is too wide.
std::string html_table(const std::vector<HtmlColumn>& columns);

/// A row of a table of names and values.
struct HtmlFact {
  std::string name;
  std::string value;
};
std::string html_facts(const std::vector<HtmlFact>& facts);

/// Preformatted text, hidden until the line `head` is opened.
std::string html_folded(const std::string& head, const std::string& text);

}  // namespace zerocount::report
