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

/// Plain text escaped for an element or a quoted attribute of HTML. Escapes & < > " '. Replaces control
/// characters other than tab and line feed, and bytes that are not UTF-8, by U+FFFD.
std::string markup(std::string_view text);

/// markup() of the text, without line breaks before percent signs.
std::string prose_markup(std::string_view text);

/// A named value for people.
struct Fact {
  std::string name;
  std::string value;  ///< text of the value with its unit
};

/// A column of a table. Row i of the table consists of cell i of each column.
struct BlockColumn {
  std::string head;
  std::string unit;  ///< empty: none
  bool numeric;      ///< aligned to the right
  std::vector<std::string> cells{};
  std::vector<std::string> links{};  ///< [row] file that the cell links to, in HTML only; empty: no link
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
/// Lines shown verbatim, such as a part of a manifest.
struct VerbatimBlock {
  std::string title;  ///< may be empty
  std::string lines;
};

/// A part of an answer for people, in plain text. A section is followed by its blocks.
using Block = std::variant<HeadlineBlock, SentenceBlock, FactsBlock, TableBlock, SectionBlock, VerbatimBlock>;

/// The parts of an answer for people, in their order. Left out are figures, empty parts, columns without any
/// content, and items that are shown in data only.
std::vector<Block> blocks(const Answer& answer);

/// The block as a fragment of HTML.
std::string html(const Block& block);

/// The answer for people as plain text, fitted to a terminal. @param width columns of the terminal, at least
/// 20; empty: no limit
std::string text(const Answer& answer, std::optional<std::size_t> width);

/// Text of a value for people, without its unit; "–" if the value is unknown.
std::string shown_value(const Item& item, const Content& content);

}  // namespace zerocount::document
