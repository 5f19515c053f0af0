#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace zerocount::report {

/// A column of an HTML table. All texts are plain text.
struct HtmlColumn {
  std::string head;  ///< header
  std::string unit;  ///< empty: no unit
  bool text{false};  ///< left-aligned, with line breaks
  std::vector<std::string> cells;
  std::vector<std::string> links{};  ///< [row] relative addresses of the cells; empty: none
};

/// Adds a cell to each column.
void add_row(std::vector<HtmlColumn>& columns, std::vector<std::string> cells);

/// The columns as a table; on a phone each row is a card.
std::string html_table(const std::vector<HtmlColumn>& columns);

/// A row of a table of names and values.
struct HtmlFact {
  std::string name;
  std::string value;
};
std::string html_facts(const std::vector<HtmlFact>& facts);

/// HTML below the line `head`, which shows and hides it. It is not printed.
std::string html_folded(const std::string& head, const std::string& html);

/// For the content of <script type="application/json">: escapes every '<', so that the content cannot end the
/// script or open a comment. Replaces bytes that are not UTF-8 by U+FFFD; NaN and infinity become null.
std::string script_json(const nlohmann::ordered_json& json);

/// JavaScript for the content of <script>: escapes "</script" and "<!--" in its literals.
std::string script_source(std::string_view source);

}  // namespace zerocount::report
