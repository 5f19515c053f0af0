#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "analysis/basis/document/content.hpp"
#include "analysis/basis/document/description.hpp"
#include "analysis/basis/document/item.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::document {

/// A type of answers, one for each command: its name, its version and its items.
struct AnswerType {
  std::string name;     ///< Name of the command that gives the answer; value of "answer" in JSON.
  std::string meaning;  ///< Meaning of the answer, a phrase without a full stop.
  int version{1};       ///< Value of "version" in JSON; grows with each change that readers of JSON notice.
  /// Key of the table that the CSV holds. Empty: the CSV has one line with the values of the answer and the
  /// members of its objects. "points.rates": the tables `rates` of all rows of `points`; each line begins
  /// with the values of its row of `points`, without lists, objects and tables.
  std::string csv_table{};
  std::vector<Item> items{};
};

/// An answer: the contents of the items of its type. Every format is rendered from an Answer.
struct Answer {
  AnswerType type;
  Members contents;  ///< Contents of the items of the type: one for each of type.items, in their order.
  ExitCode exit_code{ExitCode::success};
};

/// A type of answers, with the functions that read the content of each item from a `Subject`, the result of
/// the command.
template <class Subject>
struct AnswerDescription {
  /// Type of the answer, whose list of items is left empty; complete_type() returns the type with its items.
  AnswerType type;
  Description<Subject> items;

  AnswerType complete_type() const {
    AnswerType complete = type;
    complete.items = items.items();
    return complete;
  }
  Answer of(const Subject& subject, ExitCode exit_code = ExitCode::success,
            Audience audience = Audience::all) const {
    return {complete_type(), items.members_of(subject, audience), exit_code};
  }
};

/// The answer for people as plain text in UTF-8: the headline, sentences on a line each, values in two
/// columns, tables below their titles. Columns without any content and tables without rows are left out.
/// text::fitted fits the text to a terminal.
std::string text(const Answer& answer);

/// The answer for people as GitHub-flavoured Markdown.
std::string markdown(const Answer& answer);

/// The answer for people as a fragment of HTML, without figures.
std::string html(const Answer& answer);

/// The figures of the answer in the order of its items.
std::vector<Figure> figures(const Answer& answer);

/// Passes the JSON text {"answer": name, "version": …, "headline": …, …}, ending with a line break, to `take`
/// in pieces. Values, objects and lists have their keys; a table is a list of objects. Unknown numbers and
/// items without content are null. Every number reads back to the same double. Bytes that are not UTF-8 are
/// replaced.
/// @param indent number of blanks per level; text::one_line: no line breaks
void write_json(const Answer& answer, int indent, const std::function<void(std::string_view)>& take);

/// The JSON text of the answer, as write_json() passes it, in one piece.
/// @param indent number of blanks per level; text::one_line: no line breaks
std::string json_text(const Answer& answer, int indent = 2);

/// The answer as a tree of JSON values. The tree of a large answer takes much memory; json_text() takes less.
nlohmann::ordered_json json(const Answer& answer);

/// A JSON object with these items, in the form that json() gives an object of an answer.
nlohmann::ordered_json json(const std::vector<Item>& items, const Members& contents);

/// The answer as CSV: the rows of the table AnswerType::csv_table. Format of RFC 4180 with \n as line end;
/// the first line has the names of the columns. A member of an object is named "<object>_<member>", unless
/// Item::column names it. A column of an outer table with the name of an inner column becomes
/// "<table>_<name>". An unknown number is `nan`; a list is written as in JSON. A text that spreadsheets would
/// read as a formula gets an apostrophe in front (text::csv_field).
std::string csv(const Answer& answer);

/// The columns that an item has in CSV, each as {name of the column, text of the cell}.
std::vector<std::pair<std::string, std::string>> csv_cells(const Item& item, const Content& content);

/// JSON Schema that describes the JSON of the answers of this type.
nlohmann::ordered_json json_schema(const AnswerType& type);

/// JSON Schema (draft 2020-12) of the answers of all these types: "$defs" holds one schema for each name.
nlohmann::ordered_json json_schema(const std::vector<AnswerType>& types);

}  // namespace zerocount::document
