#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/basis/document/answer.hpp"

namespace zerocount::document {

/// Plain text escaped for an element or a quoted attribute of HTML. Escapes & < > " '. Replaces control
/// characters other than tab and line feed, and bytes that are not UTF-8, by U+FFFD.
std::string markup(std::string_view text);

/// Text escaped as by markup(), in which no line can break before a percent sign.
std::string prose_markup(std::string_view text);

/// A named value, as people are shown it outside of tables.
struct Fact {
  std::string name;
  std::string value;  ///< Text of the value with its unit.
};

/// A column of a table. Row i of the table consists of cell i of each column.
struct BlockColumn {
  std::string head;
  std::string unit;  ///< Unit of the cells; empty if they have none.
  bool numeric;      ///< True: the cells are aligned to the right.
  std::vector<std::string> cells{};
  /// [row] Path of the file to which the cell links, in HTML only; empty: no link.
  std::vector<std::string> links{};
};

struct FactsBlock {
  std::vector<Fact> facts;
};
struct TableBlock {
  std::string title;  ///< Title of the table; may be empty.
  std::vector<BlockColumn> columns;

  void add_row(std::vector<std::string> cells) {
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].cells.push_back(std::move(cells[i]));
  }
};
struct HeadlineBlock {
  std::string sentence;
};
struct SentenceBlock {
  std::string sentence;  ///< Sentences, one per line.
};
struct SectionBlock {
  std::string title;
};
/// Lines shown verbatim, such as a part of a manifest.
struct VerbatimBlock {
  std::string title;  ///< Title above the lines; may be empty.
  std::string lines;
};

/// One part of an answer as people see it, in plain text. A section block is a title; the blocks of the
/// section follow it.
using Block = std::variant<HeadlineBlock, SentenceBlock, FactsBlock, TableBlock, SectionBlock, VerbatimBlock>;

/// The parts of an answer as people see it, in their order. Figures, empty parts, columns without any
/// content, and items that only data formats show are left out.
std::vector<Block> blocks(const Answer& answer);

/// The block as a fragment of HTML.
std::string html(const Block& block);

/// The answer for people as plain text, fitted to a terminal.
/// @param width columns of the terminal, at least 20; empty: no limit
std::string text(const Answer& answer, std::optional<std::size_t> width);

/// Text of a value for people, without its unit; "–" if the value is unknown.
std::string shown_value(const Item& item, const Content& content);

}  // namespace zerocount::document
