#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Answers as data. An answer is a tree of items: named values, lists, tables, sentences and figures. A
/// description states each item once, with name, unit and meaning. Text, JSON, CSV, Markdown, HTML and the
/// JSON Schema are generated from the description.
namespace zerocount::document {

enum class Kind {
  flag,      ///< true or false
  whole,     ///< a whole number
  number,    ///< a floating-point number; unknown if not finite
  text,      ///< a word or a name
  scalar,    ///< a floating-point number, or a text
  list,      ///< values, each described by members[0]
  map,       ///< values by name, each described by members[0]
  object,    ///< members, described by Item::members
  table,     ///< rows; Item::members describes the columns
  sections,  ///< rows, each shown to people as a section
  headline,  ///< the answer in one sentence; "headline" in JSON
  title,     ///< title of a section, for people only
  sentence,  ///< sentences, for people only
  figure     ///< figures, for people only
};

/// The formats that show an item. People read text, Markdown and HTML; data are JSON and CSV. An item without
/// a key is shown to people only. A value without a heading is not shown to people.
enum class Visibility {
  everywhere,
  in_data,      ///< JSON and CSV only
  in_json,      ///< JSON only
  in_csv,       ///< CSV only: a column that JSON has in another form
  not_in_json,  ///< CSV and people: a column that JSON has in another form
  not_in_csv,   ///< JSON and people: rows inside a row
  to_people     ///< text, Markdown and HTML only
};

/// The readers for whom an answer is made. Items that only others are shown are not computed.
enum class Audience { all, people, json, csv };

/// Whether the audience is shown an item with this `shown`.
constexpr bool is_shown(Visibility shown, Audience audience) {
  const bool people =
      shown != Visibility::in_data && shown != Visibility::in_json && shown != Visibility::in_csv;
  const bool json =
      shown != Visibility::in_csv && shown != Visibility::not_in_json && shown != Visibility::to_people;
  const bool csv =
      shown != Visibility::in_json && shown != Visibility::not_in_csv && shown != Visibility::to_people;
  switch (audience) {
    case Audience::people:
      return people;
    case Audience::json:
      return json;
    case Audience::csv:
      return csv;
    case Audience::all:
      break;
  }
  return true;
}

/// Format of a number for people. In JSON and CSV every number reads back to the same double.
enum class Notation {
  four_digits,   ///< 1.234e-05
  three_digits,  ///< 1.23e-05
  two_digits,    ///< 1.2e-05
  exact,         ///< the shortest text that reads back to the same number
  percent,       ///< a proportion in per cent, with enough digits to differ from 0 and 1 (text::percent_near)
  given_percent,  ///< a proportion that somebody chose, in per cent: 95 % (text::percent)
  change          ///< a signed number with one decimal: +0.4
};

/// The description of one item of an answer.
struct Item {
  std::string key{};      ///< Name in JSON, CSV and Python, unique in its level; empty for sentences.
  std::string heading{};  ///< Name for people: of a value, a column or a table.
  std::string meaning{};  ///< Description for the schema and for legends, a phrase without a full stop.
  std::string unit{};     ///< "1" for dimensionless numbers; empty if a unit makes no sense
  Notation notation{Notation::four_digits};
  Visibility shown{Visibility::everywhere};
  bool numeric{false};               ///< The text is aligned in tables like a number: "> 1 s".
  std::vector<std::string> words{};  ///< All values that the text can have; empty: any text.
  std::string column{};              ///< Name in CSV; empty: "<object>_<key>", or the key outside an object.
  bool optional{false};              ///< Without content JSON omits the member; otherwise it is null.
  bool verbatim{false};              ///< The lines of the text are shown verbatim below the heading.
  bool free_keys{false};     ///< An object whose members are alike and whose keys depend on the study.
  bool common_above{false};  ///< A table whose constant columns are shown once, above it.

  /// For a member of a row: title of a separate table for people, below the table of the rows. Members with
  /// the same title share the table. In it, the members of an object are columns and the rows of a table are
  /// rows; sentences follow below, each after the name of its row. Empty: the member stays in the table of
  /// the rows, and the members of an object without heading are columns there.
  std::string own_table{};
  std::string note{};     ///< Sentences for people below the separate table (own_table).
  bool names_row{false};  ///< The member is the first column of the separate tables, and of no other table.

  // Description sets the members below.

  Kind kind{Kind::sentence};
  std::optional<Kind> kind_for_people{};  ///< Kind shown to people if it differs (Description::shown_as).
  bool bounded{false};                    ///< a number with bounds, "<key>_low" and "<key>_high"
  bool nullable{false};                   ///< may be without content
  /// Members of an object, or columns of the rows of a table or sections. For a list and a map [0] describes
  /// each element.
  std::vector<Item> members{};
};

/// An item that is shown in all formats.
inline Item everywhere(std::string key, std::string heading, std::string meaning, std::string unit = {}) {
  return {.key = std::move(key),
          .heading = std::move(heading),
          .meaning = std::move(meaning),
          .unit = std::move(unit)};
}

/// An item that is shown in text, Markdown and HTML only.
inline Item to_people(std::string heading) {
  return {.heading = std::move(heading), .shown = Visibility::to_people};
}

/// An item that is shown in JSON and CSV only.
inline Item in_data(std::string key, std::string meaning, std::string unit = {}) {
  return {.key = std::move(key),
          .meaning = std::move(meaning),
          .unit = std::move(unit),
          .shown = Visibility::in_data};
}

/// The item with Item::words set. @param words all values that the text can have
inline Item with_words(Item item, std::vector<std::string> words) {
  item.words = std::move(words);
  return item;
}

}  // namespace zerocount::document
