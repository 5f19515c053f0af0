#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/document/answer.hpp"

namespace zerocount::document {
namespace {

/// A cell of CSV (RFC 4180).
std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += c;
    quoted += c;
  }
  return quoted + '"';
}

std::string csv_number(double value) {
  return std::isnan(value) ? "nan" : fmt::format("{}", value);
}

/// Names and cells of the columns of one item.
class CsvRow {
 public:
  CsvRow(const std::vector<Item>& items, const Members* members, const std::string& prefix = "") {
    add(items, members, prefix);
  }

  std::string names() const { return line(names_); }
  std::string cells() const { return line(cells_); }

 private:
  static std::string line(const std::vector<std::string>& texts) {
    std::string line;
    for (std::size_t i = 0; i < texts.size(); ++i) line += (i == 0 ? "" : ",") + csv_cell(texts[i]);
    return line + '\n';
  }

  /// @param members nothing: only the names matter
  void add(const std::vector<Item>& items, const Members* members, const std::string& prefix) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (items[i].shown == Shown::to_people) continue;
      add(items[i], members == nullptr ? Content{} : members->contents[i], prefix + items[i].key);
    }
  }

  void add(const Item& item, const Content& content, const std::string& name) {
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
    const AnswerType alone{.name = {}, .meaning = {}, .version = 1, .csv_table = {}, .items = {item}};
    return json({alone, {{content}}, {}})[item.key].dump();
  }

  std::vector<std::string> names_;
  std::vector<std::string> cells_;
};

}  // namespace

std::string csv(const Answer& answer) {
  std::string csv;
  for (std::size_t i = 0; i < answer.type.items.size(); ++i) {
    const Item& item = answer.type.items[i];
    if (item.key != answer.type.csv_table || item.kind != Kind::table) continue;
    csv += CsvRow(item.members, nullptr).names();
    for (const Members& row : std::get<Rows>(answer.contents.contents[i].value).rows)
      csv += CsvRow(item.members, &row).cells();
  }
  return csv;
}

}  // namespace zerocount::document
