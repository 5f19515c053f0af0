#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "analysis/document/content.hpp"
#include "analysis/document/description.hpp"
#include "analysis/document/item.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::document {

/// A kind of answers: its name, its version and its items.
struct AnswerType {
  std::string name;     ///< "answer" in JSON: the command
  std::string meaning;  ///< a phrase without a full stop
  int version{1};       ///< in JSON: counts changes that a reader of the JSON notices
  /// Key of the table that CSV has; empty: CSV has one line, the
  /// values of the answer and the members of its objects. "points.rates" are the
  /// tables `rates` of all rows of `points`: a line begins with the values of the row of `points`, without
  /// its lists, objects and tables.
  std::string csv_table{};
  std::vector<Item> items{};
};

/// An answer: the contents of the items of its type. Every format is rendered from it.
struct Answer {
  AnswerType type;
  Members contents;  ///< of type.items
  ExitCode exit_code{ExitCode::success};
};

/// A type of answers, and how each item is found in a `Subject`.
template <class Subject>
struct AnswerDescription {
  AnswerType type;  ///< without items
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

/// For people: the headline, sentences a line each, values in two columns, tables below their titles. UTF-8;
/// text::fitted fits it to a terminal. Columns without any content are left out, and so are tables without
/// rows.
std::string text(const Answer& answer);

/// The answer for people as GitHub-flavoured Markdown.
std::string markdown(const Answer& answer);

/// The answer for people as a fragment of HTML, without figures.
std::string html(const Answer& answer);

/// The figures of the answer, in their order.
std::vector<Figure> figures(const Answer& answer);

/// Gives the text of {"answer": name, "version": …, "headline": …, …}, ending with a line break, to `take` in
/// pieces: values, objects and lists by their keys, a table as a list of objects. Unknown numbers and items
/// without content are null; every number reads back to the same double. Bytes that are not UTF-8 are
/// replaced.
/// @param indent blanks of a level; text::one_line: no line breaks
void write_json(const Answer& answer, int indent, const std::function<void(std::string_view)>& take);

/// The JSON of the answer as one text.
std::string json_text(const Answer& answer, int indent = 2);

/// The JSON of the answer as a tree. A large answer takes much memory as a tree: see json_text().
nlohmann::ordered_json json(const Answer& answer);

/// The object of these items, as in json() of an answer.
nlohmann::ordered_json json(const std::vector<Item>& items, const Members& contents);

/// The rows of the type's csv_table: RFC 4180 with \n, a line with the names of the columns first. A member
/// of an object has the name "<object>_<member>", unless its item has a column; a column of an outer table
/// that is named like an inner one is "<table>_<name>"; an unknown number is `nan`, a list is written as in
/// JSON; a text that is a formula of spreadsheets begins with an apostrophe (text::csv_field).
std::string csv(const Answer& answer);

/// Name in CSV and cell of each column of an item.
std::vector<std::pair<std::string, std::string>> csv_cells(const Item& item, const Content& content);

/// The schema of json() of all answers of the type.
nlohmann::ordered_json json_schema(const AnswerType& type);

/// The JSON Schema (draft 2020-12) of all these answers: "$defs" has one for each name.
nlohmann::ordered_json json_schema(const std::vector<AnswerType>& types);

}  // namespace zerocount::document
