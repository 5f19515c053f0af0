#include "analysis/document/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/document/figure.hpp"
#include "analysis/text/percent.hpp"

namespace zerocount::document {
namespace {

constexpr const char* unknown_text = "–";

bool is_for_people(const Item& item) {
  return is_shown(item.shown, Audience::people);
}

bool is_percent(Notation notation) {
  return notation == Notation::percent || notation == Notation::given_percent;
}

std::string number_text(double value, Notation notation) {
  if (!std::isfinite(value)) return unknown_text;
  switch (notation) {
    case Notation::three_digits:
      return fmt::format("{:.3g}", value);
    case Notation::two_digits:
      return fmt::format("{:.2g}", value);
    case Notation::exact:
      return fmt::format("{}", value);
    case Notation::percent:
      return text::percent_near(value);
    case Notation::given_percent:
      return text::percent(value);
    case Notation::change:
      return fmt::format("{:+.1f}", value);
    case Notation::four_digits:
      break;
  }
  return fmt::format("{:.4g}", value);
}

std::string bounded_text(const Bounded& number, Notation notation) {
  if (!std::isfinite(number.value)) return unknown_text;
  if (std::isnan(number.low) && std::isnan(number.high)) return number_text(number.value, notation);
  const std::string bounds = is_percent(notation) ? text::percent_bounds(number.low, number.high)
                                                  : fmt::format("{}, {}", number_text(number.low, notation),
                                                                number_text(number.high, notation));
  return fmt::format("{} [{}]", number_text(number.value, notation), bounds);
}

/// The text of each alternative of Content that is a value.
struct ValueText {
  const Item& item;

  std::string operator()(std::monostate) const { return unknown_text; }
  std::string operator()(bool value) const { return value ? "yes" : "no"; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(std::uint64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const { return number_text(value, item.notation); }
  std::string operator()(const Bounded& value) const { return bounded_text(value, item.notation); }
  std::string operator()(const std::string& value) const { return value; }
  std::string operator()(const List& list) const {
    std::vector<std::string> values;
    for (const Content& value : list.values) values.push_back(shown_value(item.members[0], value));
    return values.empty() ? unknown_text : fmt::format("{}", fmt::join(values, ", "));
  }
  std::string operator()(const Named& named) const {
    std::vector<std::string> values;
    for (const auto& [name, value] : named.values)
      values.push_back(fmt::format("{} = {}", name, shown_value(item.members[0], value)));
    return values.empty() ? unknown_text : fmt::format("{}", fmt::join(values, ", "));
  }
  std::string operator()(const Members& members) const {
    std::vector<std::string> values;
    for (std::size_t i = 0; i < members.contents.size(); ++i) {
      const Item& member = item.members[i];
      if (!is_for_people(member) || members.contents[i].is_empty()) continue;
      values.push_back(fmt::format("{} {}", member.heading, shown_value(member, members.contents[i])));
    }
    return fmt::format("{}", fmt::join(values, ", "));
  }
  std::string operator()(const Rows&) const { return unknown_text; }
  std::string operator()(const std::shared_ptr<const Figure>&) const { return unknown_text; }
};

/// The unit as it is shown beside numbers in this notation.
std::string shown_unit(const Item& item) {
  return item.unit == "1" || is_percent(item.notation) ? "" : item.unit;
}

bool is_numeric(const Item& item) {
  return item.kind == Kind::whole || item.kind == Kind::number || item.numeric;
}

TableBlock table_block(const Item& item, const Rows& rows) {
  TableBlock table{item.heading, {}};
  for (std::size_t i = 0; i < item.members.size(); ++i) {
    const Item& column = item.members[i];
    if (!is_for_people(column)) continue;
    BlockColumn shown{column.heading, shown_unit(column), is_numeric(column)};
    for (const Members& row : rows.rows)
      shown.cells.push_back(
          row.contents[i].is_empty() && !is_numeric(column) ? "" : shown_value(column, row.contents[i]));
    const bool is_known = std::ranges::any_of(
        shown.cells, [](const std::string& cell) { return !cell.empty() && cell != unknown_text; });
    if (is_known) table.columns.push_back(std::move(shown));
  }
  return table;
}

class BlockList {
 public:
  void add(const std::vector<Item>& items, const Members& members) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (is_for_people(items[i]) && !members.contents[i].is_empty()) add(items[i], members.contents[i]);
    }
  }

  std::vector<Block> take() && { return std::move(blocks_); }

 private:
  void add(const Item& item, const Content& content) {
    switch (item.kind) {
      case Kind::headline:
        blocks_.emplace_back(HeadlineBlock{std::get<std::string>(content.value)});
        return;
      case Kind::title:
        blocks_.emplace_back(SectionBlock{std::get<std::string>(content.value)});
        return;
      case Kind::sentence:
        blocks_.emplace_back(SentenceBlock{std::get<std::string>(content.value)});
        return;
      case Kind::table:
        add_table(item, std::get<Rows>(content.value));
        return;
      case Kind::sections:
        for (const Members& row : std::get<Rows>(content.value).rows) add(item.members, row);
        return;
      case Kind::object:
        blocks_.emplace_back(SectionBlock{item.heading});
        add(item.members, std::get<Members>(content.value));
        return;
      case Kind::figure:
        return;
      case Kind::text:
        if (!item.verbatim) return add_fact(item, content);
        blocks_.emplace_back(VerbatimBlock{item.heading, std::get<std::string>(content.value)});
        return;
      case Kind::flag:
      case Kind::whole:
      case Kind::number:
      case Kind::scalar:
      case Kind::list:
      case Kind::map:
        add_fact(item, content);
    }
  }

  void add_table(const Item& item, const Rows& rows) {
    if (rows.rows.empty()) return;
    TableBlock table = table_block(item, rows);
    if (item.common_above) add_common_columns(table);
    if (!table.columns.empty()) blocks_.emplace_back(std::move(table));
  }

  /// Moves the columns whose cells are all equal, of a single row all, out of the table into facts below its
  /// title.
  void add_common_columns(TableBlock& table) {
    FactsBlock common;
    std::vector<BlockColumn> others;
    for (BlockColumn& column : table.columns) {
      const std::string& cell = column.cells.front();
      if (std::ranges::count(column.cells, cell) == std::ssize(column.cells)) {
        common.facts.push_back({column.head, column.unit.empty() ? cell : cell + " " + column.unit});
      } else {
        others.push_back(std::move(column));
      }
    }
    table.columns = std::move(others);
    if (common.facts.empty()) return;
    if (!table.title.empty()) blocks_.emplace_back(SectionBlock{std::exchange(table.title, "")});
    blocks_.emplace_back(std::move(common));
  }

  void add_fact(const Item& item, const Content& content) {
    std::string value = shown_value(item, content);
    if (value.empty() || value == unknown_text) return;
    if (blocks_.empty() || !std::holds_alternative<FactsBlock>(blocks_.back()))
      blocks_.emplace_back(FactsBlock{});
    const std::string unit = shown_unit(item);
    if (!unit.empty()) value += " " + unit;
    std::get<FactsBlock>(blocks_.back()).facts.push_back({item.heading, std::move(value)});
  }

  std::vector<Block> blocks_;
};

void collect_figures(const Content& content, std::vector<Figure>& figures) {
  if (const auto* const figure = std::get_if<std::shared_ptr<const Figure>>(&content.value))
    figures.push_back(**figure);
  if (const auto* const list = std::get_if<List>(&content.value)) {
    for (const Content& value : list->values) collect_figures(value, figures);
  }
  if (const auto* const members = std::get_if<Members>(&content.value)) {
    for (const Content& member : members->contents) collect_figures(member, figures);
  }
  if (const auto* const rows = std::get_if<Rows>(&content.value)) {
    for (const Members& row : rows->rows) collect_figures({row}, figures);
  }
}

}  // namespace

std::string shown_value(const Item& item, const Content& content) {
  return std::visit(ValueText{item}, content.value);
}

std::vector<Block> blocks(const Answer& answer) {
  BlockList list;
  list.add(answer.type.items, answer.contents);
  return std::move(list).take();
}

std::vector<Figure> figures(const Answer& answer) {
  std::vector<Figure> figures;
  collect_figures({answer.contents}, figures);
  return figures;
}

}  // namespace zerocount::document
