#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/document/answer.hpp"

namespace zerocount::document {

/// Plain text for the text of an element or a quoted attribute of HTML: escapes & < > " '; replaces control
/// characters other than tab and line feed, and bytes that are not UTF-8, by U+FFFD.
std::string markup(std::string_view text);

/// As markup, without line breaks before percent signs.
std::string prose_markup(std::string_view text);

/// A value with its name.
struct Fact {
  std::string name;
  std::string value;  ///< with its unit
};

/// A column of a table; a row is a cell of each column.
struct BlockColumn {
  std::string head;
  std::string unit;  ///< empty: none
  bool numeric;      ///< aligned to the right
  std::vector<std::string> cells{};
  std::vector<std::string> links{};  ///< in HTML: [row] the file that the cell leads to; empty: none
};

struct FactsBlock {
  std::vector<Fact> facts;
};
struct TableBlock {
  std::string title;  ///< may be empty
  std::vector<BlockColumn> columns;

  void add_row(std::vector<std::string> cells) {
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].cells.push_back(std::move(cells[i]));
  }
};
struct HeadlineBlock {
  std::string sentence;
};
struct SentenceBlock {
  std::string sentence;  ///< may have several lines
};
struct SectionBlock {
  std::string title;
};
/// Lines that are shown as they are, such as a part of a manifest.
struct VerbatimBlock {
  std::string title;  ///< may be empty
  std::string lines;
};

/// A part of an answer for people, in plain text. A section is followed by its blocks.
using Block = std::variant<HeadlineBlock, SentenceBlock, FactsBlock, TableBlock, SectionBlock, VerbatimBlock>;

/// The parts of an answer for people, in their order, without figures: empty ones, columns without any
/// content and what is shown in data only are left out.
std::vector<Block> blocks(const Answer& answer);

/// The block as a fragment of HTML.
std::string html(const Block& block);

/// text() of an answer, fitted to a terminal. @param width its columns, at least 20; nothing: no limit
std::string text(const Answer& answer, std::optional<std::size_t> width);

/// A value as people read it, without its unit; "–" where it is unknown.
std::string shown_value(const Item& item, const Content& content);

}  // namespace zerocount::document
