#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Answers as data. An answer is a tree of items: named values, lists, tables, sentences and figures. Its
/// description states each item once, with name, unit and meaning; text, JSON, CSV, Markdown, HTML and the
/// JSON Schema follow from it.
namespace zerocount::document {

enum class Kind {
  flag,      ///< true or false
  whole,     ///< a whole number
  number,    ///< a floating-point number; unknown where it is not finite
  text,      ///< a word or a name
  scalar,    ///< a floating-point number, or a text
  list,      ///< values of members[0]
  map,       ///< values by name, of members[0]
  object,    ///< members
  table,     ///< rows, of which the members are the columns
  sections,  ///< rows, of which each is a section for people
  headline,  ///< the answer in one sentence; "headline" in JSON
  title,     ///< of a section, for people only
  sentence,  ///< for people only
  figure     ///< for people only
};

/// Where an item is shown. What has no key is shown to people only; a value without a heading is not shown to
/// people.
enum class Shown {
  everywhere,
  in_data,      ///< in JSON and CSV only
  in_json,      ///< in JSON only
  in_csv,       ///< in CSV only: a column of what the JSON has in another form
  not_in_json,  ///< in CSV and to people, likewise
  not_in_csv,   ///< in JSON and to people: rows of a row
  to_people     ///< in text, Markdown and HTML only
};

/// For whom an answer is made: what others are shown is not computed.
enum class Audience { all, people, json, csv };

/// Whether the audience is shown an item with this `shown`.
constexpr bool is_shown(Shown shown, Audience audience) {
  const bool people = shown != Shown::in_data && shown != Shown::in_json && shown != Shown::in_csv;
  const bool json = shown != Shown::in_csv && shown != Shown::not_in_json && shown != Shown::to_people;
  const bool csv = shown != Shown::in_json && shown != Shown::not_in_csv && shown != Shown::to_people;
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

/// How a number is written for people. In JSON and CSV every number reads back to the same double.
enum class Notation {
  four_digits,    ///< 1.234e-05
  three_digits,   ///< 1.23e-05
  two_digits,     ///< 1.2e-05
  exact,          ///< the shortest text that reads back to the same number
  percent,        ///< of a proportion, with as many digits as tell it from 0 and 1 (text::percent_near)
  given_percent,  ///< of a proportion that somebody chose: 95 % (text::percent)
  change          ///< with its sign and one decimal: +0.4
};

/// The description of one item of an answer.
struct Item {
  std::string key{};      ///< in JSON, CSV and Python; no two of a level are equal; empty for sentences
  std::string heading{};  ///< for people: the name of a value, the head of a column, the title of a table
  std::string meaning{};  ///< in the schema and in legends: a phrase without a full stop
  std::string unit{};     ///< "1" where it is dimensionless; empty where there is none
  Notation notation{Notation::four_digits};
  Shown shown{Shown::everywhere};
  bool numeric{false};               ///< a text that stands in tables as numbers do: "> 1 s"
  std::vector<std::string> words{};  ///< that a text can be; empty: any
  std::string column{};              ///< name in CSV; empty: "<object>_<key>", without an object the key
  bool optional{false};              ///< JSON has no such member where there is no content; else null
  bool verbatim{false};              ///< a text whose lines are shown as they are, below the heading
  bool free_keys{false};             ///< of an object: its members are alike, and a study gives their keys
  bool common_above{false};          ///< of a table: what all its rows say alike is said once, above it

  /// For a member of a row: people see it in a table with this title, which stands below the table of the
  /// rows. Members with the same title share the table. There an object gives its members as columns, and a
  /// table gives its rows; their sentences follow, each behind the name of its row. Empty: the member stays
  /// in the table of the rows, where an object without heading gives its members as columns.
  std::string own_table{};
  std::string note{};     ///< for people: sentences below its table
  bool names_row{false};  ///< of a member of a row: it is the first column of those tables, and of no other

  // Description sets the members below.

  Kind kind{Kind::sentence};
  std::optional<Kind> kind_for_people{};  ///< where it is shown as something else (Description::shown_as)
  bool bounded{false};                    ///< a number with bounds, "<key>_low" and "<key>_high"
  bool nullable{false};                   ///< may be without content
  std::vector<Item> members{};  ///< of an object, a table, sections or their rows; [0] of a list and a map
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
  return {.heading = std::move(heading), .shown = Shown::to_people};
}

/// An item that is shown in JSON and CSV only.
inline Item in_data(std::string key, std::string meaning, std::string unit = {}) {
  return {
      .key = std::move(key), .meaning = std::move(meaning), .unit = std::move(unit), .shown = Shown::in_data};
}

/// An item that is text, of which these are all words.
inline Item with_words(Item item, std::vector<std::string> words) {
  item.words = std::move(words);
  return item;
}

}  // namespace zerocount::document
