#pragma once

#include <string>
#include <vector>

namespace zerocount {

/// A column of a table of the page.
struct HtmlColumn {
  std::string head;  ///< plain text, as all of this
  std::string unit;  ///< empty where there is none to say
  bool text{false};  ///< aligned to the left; its lines may be broken
  std::vector<std::string> cells;
  std::vector<std::string> below{};  ///< a smaller second line of each cell, or empty
};

/// The columns as a table that scrolls where it is too wide.
std::string html_table(const std::vector<HtmlColumn>& columns);

/// A table of names and values.
struct HtmlFact {
  std::string name;
  std::string value;
};
std::string html_facts(const std::vector<HtmlFact>& facts);

/// Text of fixed width behind a line that opens it.
std::string html_folded(const std::string& head, const std::string& text);

}  // namespace zerocount
