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
  list,      ///< a list of values; members[0] describes each of them
  map,       ///< values by name; members[0] describes each of them
  object,    ///< an object; Item::members describes its members
  table,     ///< rows; Item::members describes the columns
  sections,  ///< a list of objects, each shown to people as a section; Item::members describes them
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
  in_csv,       ///< CSV only, for a column whose data JSON has in another form
  not_in_json,  ///< CSV and people, for a column whose data JSON has in another form
  not_in_csv,   ///< JSON and people, not CSV: for rows inside a row
  to_people     ///< text, Markdown and HTML only
};

/// The readers for whom an answer is made, which decides the items that are computed: all items, those for
/// people, for JSON, or for CSV.
enum class Audience { all, people, json, csv };

/// Whether an item with the visibility `shown` appears in an answer for this audience.
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

/// Format in which people are shown a number. In JSON and CSV every number reads back to the same double.
enum class Notation {
  four_digits,   ///< four significant digits: 1.234e-05
  three_digits,  ///< three significant digits: 1.23e-05
  two_digits,    ///< two significant digits: 1.2e-05
  exact,         ///< the shortest text that reads back to the same number
  percent,       ///< a proportion in per cent, with enough digits to differ from 0 and 1 (text::percent_near)
  given_percent,  ///< a proportion that somebody chose, in per cent: 95 % (text::percent)
  change          ///< a signed number with one decimal: +0.4
};

/// The description of one item of an answer.
struct Item {
  std::string key{};      ///< Name in JSON, CSV and Python, unique in its level; empty for sentences.
  std::string heading{};  ///< Name that people are shown for the value, the column or the table.
  std::string meaning{};  ///< Description for the schema and for legends, a phrase without a full stop.
  std::string unit{};  ///< Unit of the value; "1" for dimensionless numbers, empty if a unit makes no sense.
  Notation notation{Notation::four_digits};
  Visibility shown{Visibility::everywhere};
  bool numeric{false};  ///< The value is a text, but is aligned in tables like a number: "> 1 s".
  std::vector<std::string> words{};  ///< All values that the text can have; empty: any text.
  /// Name of the column in CSV; empty: "<object>_<key>" for a member of an object, otherwise the key.
  std::string column{};
  bool optional{false};  ///< Whether JSON omits the item if it has no content (true), or writes null (false).
  bool verbatim{false};  ///< True: the lines of the text are shown verbatim, below the heading.
  /// An object whose members all have the same form and whose keys depend on the study.
  bool free_keys{false};
  /// A table whose columns with equal cells in all rows are shown once, above the table.
  bool common_above{false};

  /// For a member of a row: title of a separate table for people, below the table of the rows. Members with
  /// the same title share the table. In it, the members of an object are columns and the rows of a table are
  /// rows; sentences follow below, each after the name of its row. Empty: the member stays in the table of
  /// the rows, and the members of an object without heading are columns there.
  std::string own_table{};
  std::string note{};  ///< Sentences for people below the separate table (own_table).
  /// True: the member is the first column of the separate tables (own_table), where it names the rows, and is
  /// in no other table.
  bool names_row{false};

  // Description sets the members below.

  Kind kind{Kind::sentence};
  /// Kind of the content that people are shown, if it differs from `kind` (Description::shown_as); otherwise
  /// null.
  std::optional<Kind> kind_for_people{};
  bool bounded{false};   ///< A number with bounds, which data formats show as "<key>_low" and "<key>_high".
  bool nullable{false};  ///< The item may be without content, so that JSON may have null.
  /// Items of the members of an object, or of the columns of a table or sections. For a list and a map,
  /// members[0] describes each element.
  std::vector<Item> members{};
};

/// Creates an item that is shown in all formats.
inline Item everywhere(std::string key, std::string heading, std::string meaning, std::string unit = {}) {
  return {.key = std::move(key),
          .heading = std::move(heading),
          .meaning = std::move(meaning),
          .unit = std::move(unit)};
}

/// Creates an item that is shown in text, Markdown and HTML only.
inline Item to_people(std::string heading) {
  return {.heading = std::move(heading), .shown = Visibility::to_people};
}

/// Creates an item that is shown in JSON and CSV only.
inline Item in_data(std::string key, std::string meaning, std::string unit = {}) {
  return {.key = std::move(key),
          .meaning = std::move(meaning),
          .unit = std::move(unit),
          .shown = Visibility::in_data};
}

/// The item, restricted to certain texts (Item::words).
/// @param words all values that the text can have
inline Item with_words(Item item, std::vector<std::string> words) {
  item.words = std::move(words);
  return item;
}

}  // namespace zerocount::document
