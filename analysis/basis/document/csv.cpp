#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/basis/document/answer.hpp"
#include "core/text/text.hpp"

namespace zerocount::document {
namespace {

std::string csv_number(double value) {
  return std::isnan(value) ? "nan" : fmt::format("{}", value);
}

/// The names and cells of the columns of one line of CSV.
class CsvLine {
 public:
  /// Adds the columns of all items that CSV shows.
  /// @param members contents of the items; null: only the names of the columns matter
  /// @param prefix beginning of the names of the columns
  void add(const std::vector<Item>& items, const Members* members, const std::string& prefix = "") {
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (!is_data(items[i])) continue;
      add(items[i], members == nullptr ? Content{} : members->contents[i],
          items[i].column.empty() ? prefix + items[i].key : items[i].column);
    }
  }

  /// Adds the columns of an outer table, whose row holds the table of this line. Only items with a single
  /// value are added.
  /// @param members contents of the outer row; null: only the names of the columns matter
  /// @param table key of the outer table
  void add_values(const std::vector<Item>& items, const Members* members, const std::string& table) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (is_data(items[i]) && is_one_value(items[i].kind))
        add(items[i], members == nullptr ? Content{} : members->contents[i], items[i].key);
    }
    outer_tables_.resize(names_.size(), table);
  }

  /// Adds the columns of an answer without csv_table: its values, and the members of its objects.
  void add_answer(const Answer& answer) {
    for (std::size_t i = 0; i < answer.type.items.size(); ++i) {
      const Item& item = answer.type.items[i];
      if (is_data(item) && (is_one_value(item.kind) || item.kind == Kind::object))
        add(item, answer.contents.contents[i], item.key);
    }
  }

  /// The line with the names of the columns. A column of an outer table that has the name of a later column
  /// is named "<table>_<name>".
  std::string names() const {
    std::vector<std::string> names = names_;
    for (std::size_t i = 0; i < outer_tables_.size(); ++i) {
      const auto later = names_.begin() + static_cast<std::ptrdiff_t>(i) + 1;
      if (std::find(later, names_.end(), names_[i]) != names_.end())
        names[i] = outer_tables_[i] + "_" + names_[i];
    }
    return line(names);
  }
  std::string cells() const { return line(cells_); }
  std::vector<std::pair<std::string, std::string>> named_cells() const {
    std::vector<std::pair<std::string, std::string>> named;
    for (std::size_t i = 0; i < names_.size(); ++i) named.emplace_back(names_[i], cells_[i]);
    return named;
  }

 private:
  static bool is_data(const Item& item) { return is_shown(item.shown, Audience::csv); }

  static bool is_one_value(Kind kind) {
    return kind == Kind::flag || kind == Kind::whole || kind == Kind::number || kind == Kind::text ||
           kind == Kind::scalar;
  }

  static std::string line(const std::vector<std::string>& texts) {
    std::string line;
    for (std::size_t i = 0; i < texts.size(); ++i) line += (i == 0 ? "" : ",") + text::csv_field(texts[i]);
    return line + '\n';
  }

  void add(const Item& item, const Content& given, const std::string& name) {
    const Content& content = data_in(given);
    if (item.kind == Kind::object) return add(item.members, std::get_if<Members>(&content.value), name + "_");
    const auto* const bounded = std::get_if<Bounded>(&content.value);
    names_.push_back(name);
    cells_.push_back(cell(item, content));
    if (!item.bounded) return;
    for (const char* const side : {"_low", "_high"}) {
      names_.push_back(name + side);
      cells_.push_back(bounded == nullptr
                           ? "nan"
                           : csv_number(side == std::string("_low") ? bounded->low : bounded->high));
    }
  }

  static std::string cell(const Item& item, const Content& content) {
    if (const auto* const number = std::get_if<double>(&content.value)) return csv_number(*number);
    if (const auto* const number = std::get_if<Bounded>(&content.value)) return csv_number(number->value);
    if (const auto* const text = std::get_if<std::string>(&content.value)) return *text;
    if (content.is_empty()) return item.kind == Kind::number || item.kind == Kind::whole ? "nan" : "";
    if (const auto* const number = std::get_if<std::int64_t>(&content.value)) return std::to_string(*number);
    Item alone = item;
    alone.shown = Visibility::in_json;
    return json(std::vector{std::move(alone)}, {{content}})[item.key].dump();
  }

  std::vector<std::string> names_;
  std::vector<std::string> cells_;
  /// [column] Key of the outer table to which the column belongs. Only the first columns belong to outer
  /// tables.
  std::vector<std::string> outer_tables_;
};

/// Appends the lines of a table.
/// @param path keys of nested tables, separated by dots, the outermost first
/// @param members contents of the items; null: append only the line of names
/// @param line columns with which each line begins
void add_lines(std::string& csv, const std::vector<Item>& items, const Members* members,
               std::string_view path, const CsvLine& line = {}) {
  const std::size_t dot = path.find('.');
  const auto item = std::ranges::find(items, path.substr(0, dot), &Item::key);
  if (item == items.end()) return;
  const auto add_row = [&](const Members* row) {
    CsvLine longer = line;
    if (dot != std::string_view::npos) {
      longer.add_values(item->members, row, item->key);
      return add_lines(csv, item->members, row, path.substr(dot + 1), longer);
    }
    longer.add(item->members, row);
    csv += row == nullptr ? longer.names() : longer.cells();
  };
  if (members == nullptr) return add_row(nullptr);
  const Content& content = data_in(members->contents[static_cast<std::size_t>(item - items.begin())]);
  for (const Members& row : std::get<Rows>(content.value).rows) add_row(&row);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> csv_cells(const Item& item, const Content& content) {
  const Members row{{content}};
  CsvLine line;
  line.add({item}, &row);
  return line.named_cells();
}

std::string csv(const Answer& answer) {
  std::string csv;
  if (answer.type.csv_table.empty()) {
    CsvLine line;
    line.add_answer(answer);
    return line.names() + line.cells();
  }
  add_lines(csv, answer.type.items, nullptr, answer.type.csv_table);
  add_lines(csv, answer.type.items, &answer.contents, answer.type.csv_table);
  return csv;
}

}  // namespace zerocount::document
