#include "analysis/basis/document/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/document/figure.hpp"
#include "analysis/basis/text/text.hpp"

namespace zerocount::document {
namespace {

constexpr const char* unknown_text = "–";

bool is_for_people(const Item& item) {
  return is_shown(item.shown, Audience::people);
}

Kind shown_kind(const Item& item) {
  return item.kind_for_people.value_or(item.kind);
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

/// Visitor of Content::value: returns the text of a value for people.
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
      const Content& content = shown_in(members.contents[i]);
      if (!is_for_people(member) || content.is_empty()) continue;
      values.push_back(fmt::format("{} {}", member.heading, shown_value(member, content)));
    }
    return fmt::format("{}", fmt::join(values, ", "));
  }
  std::string operator()(const Rows&) const { return unknown_text; }
  std::string operator()(const std::shared_ptr<const Figure>&) const { return unknown_text; }
  std::string operator()(const std::shared_ptr<const Twofold>& twofold) const {
    return shown_value(item, twofold->shown);
  }
};

/// The unit that is shown beside the item; empty for dimensionless numbers, per cent and text.
std::string shown_unit(const Item& item) {
  const bool is_text = item.kind_for_people == Kind::text && !item.numeric;
  return item.unit == "1" || is_percent(item.notation) || is_text ? "" : item.unit;
}

bool is_numeric(const Item& item) {
  const Kind kind = shown_kind(item);
  return kind == Kind::whole || kind == Kind::number || item.numeric;
}

/// Whether people see the item as a column of the table to whose rows it belongs. True also for an object
/// whose members are columns there.
bool is_column(const Item& item) {
  const Kind kind = shown_kind(item);
  return is_for_people(item) && item.own_table.empty() && !item.names_row && kind != Kind::sentence &&
         kind != Kind::table;
}

/// Whether the item is an object without a heading, whose members are shown as if they were items of its own
/// level.
bool is_flat(const Item& item) {
  return shown_kind(item) == Kind::object && item.heading.empty();
}

/// Appends a column of a table for each item, except for items without any known value.
/// @param rows [row] contents of the items; null if the row has none
void add_columns(std::vector<BlockColumn>& columns, const std::vector<Item>& items,
                 const std::vector<const Members*>& rows) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Item& item = items[i];
    if (!is_column(item)) continue;
    if (is_flat(item)) {
      std::vector<const Members*> inner;
      for (const Members* const row : rows)
        inner.push_back(row == nullptr ? nullptr : std::get_if<Members>(&shown_in(row->contents[i]).value));
      add_columns(columns, item.members, inner);
      continue;
    }
    BlockColumn shown{item.heading, shown_unit(item), is_numeric(item)};
    bool is_known = false;
    for (const Members* const row : rows) {
      const Content& content = row == nullptr ? Content{} : shown_in(row->contents[i]);
      shown.cells.push_back(content.is_empty() && !is_numeric(item) ? "" : shown_value(item, content));
      is_known = is_known || (!shown.cells.back().empty() && shown.cells.back() != unknown_text);
    }
    if (is_known) columns.push_back(std::move(shown));
  }
}

TableBlock table_block(const Item& item, const Rows& rows) {
  TableBlock table{item.heading, {}};
  std::vector<const Members*> lines;
  for (const Members& row : rows.rows) lines.push_back(&row);
  add_columns(table.columns, item.members, lines);
  return table;
}

/// Index of the item whose text names the rows in separate tables (Item::own_table): the one with
/// Item::names_row, otherwise the first column. Equals items.size() if there is none.
std::size_t naming_item(const std::vector<Item>& items) {
  const auto named = std::ranges::find(items, true, &Item::names_row);
  const auto found = named != items.end() ? named : std::ranges::find_if(items, is_column);
  return static_cast<std::size_t>(found - items.begin());
}

/// The item that describes a table, together with the rows of the table.
struct ItemWithRows {
  Item item;
  Rows rows;
};

/// The separate table with this title (Item::own_table), built from those members of the rows of `outer` that
/// have the title. If `outer` has several rows, the first column names the row of `outer`.
ItemWithRows own_table(const Item& outer, const Rows& rows, const std::string& title) {
  ItemWithRows own{{.heading = title, .kind = Kind::table}, {}};
  const std::size_t naming = naming_item(outer.members);
  const bool is_named = rows.rows.size() > 1 && naming < outer.members.size();
  if (is_named) {
    own.item.members = {outer.members[naming]};
    own.item.members.front().names_row = false;
  }
  std::vector<std::size_t> members;
  bool has_rows = false;
  for (std::size_t i = 0; i < outer.members.size(); ++i) {
    Item member = outer.members[i];
    if (member.own_table != title || !is_for_people(member)) continue;
    members.push_back(i);
    has_rows = has_rows || member.kind == Kind::table;
    member.own_table.clear();
    if (!member.note.empty()) own.item.note += (own.item.note.empty() ? "" : "\n") + member.note;
    if (member.kind == Kind::table) {
      own.item.members.insert(own.item.members.end(), member.members.begin(), member.members.end());
    } else {
      if (member.kind == Kind::object) member.heading.clear();  // its members stand beside the others
      own.item.members.push_back(std::move(member));
    }
  }
  for (const Members& row : rows.rows) {
    Members first;
    if (is_named) first.contents.push_back(row.contents[naming]);
    if (has_rows) {
      const auto* const inner = std::get_if<Rows>(&shown_in(row.contents[members.front()]).value);
      if (inner == nullptr) continue;
      for (const Members& one : inner->rows) {
        Members line = first;
        line.contents.insert(line.contents.end(), one.contents.begin(), one.contents.end());
        own.rows.rows.push_back(std::move(line));
      }
      continue;
    }
    const auto is_empty = [&](std::size_t i) { return shown_in(row.contents[i]).is_empty(); };
    if (std::ranges::all_of(members, is_empty)) continue;
    for (const std::size_t i : members) first.contents.push_back(row.contents[i]);
    own.rows.rows.push_back(std::move(first));
  }
  return own;
}

/// The texts of the sentence items of a row, including those of its flat objects (is_flat()).
std::vector<std::string> sentences_of(const std::vector<Item>& items, const Members& row) {
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Content& content = shown_in(row.contents[i]);
    if (items[i].kind == Kind::sentence && !content.is_empty())
      sentences.push_back(std::get<std::string>(content.value));
    const auto* const members = std::get_if<Members>(&content.value);
    if (members == nullptr || !is_flat(items[i]) || !is_for_people(items[i])) continue;
    for (std::string& one : sentences_of(items[i].members, *members)) sentences.push_back(std::move(one));
  }
  return sentences;
}

/// The sentences of all rows of an own_table(), one per line.
/// @param is_named whether the first column names the row; each sentence then begins with this name
std::string sentences_below(const ItemWithRows& own, bool is_named) {
  std::string text;
  for (const Members& row : own.rows.rows) {
    const std::string name =
        is_named ? shown_value(own.item.members.front(), shown_in(row.contents.front())) + ": " : "";
    for (const std::string& one : sentences_of(own.item.members, row)) text += name + one + "\n";
  }
  return text;
}

class BlockList {
 public:
  void add(const std::vector<Item>& items, const Members& members) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      const Content& content = shown_in(members.contents[i]);
      if (is_for_people(items[i]) && !content.is_empty()) add(items[i], content);
    }
  }

  std::vector<Block> take() && { return std::move(blocks_); }

 private:
  void add(const Item& item, const Content& content) {
    switch (shown_kind(item)) {
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
        if (!item.heading.empty()) blocks_.emplace_back(SectionBlock{item.heading});
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
    if (!item.note.empty()) blocks_.emplace_back(SentenceBlock{item.note});
    add_own_tables(item, rows);
  }

  void add_own_tables(const Item& item, const Rows& rows) {
    std::vector<std::string> titles;
    for (const Item& member : item.members) {
      if (!member.own_table.empty() && std::ranges::find(titles, member.own_table) == titles.end())
        titles.push_back(member.own_table);
    }
    for (const std::string& title : titles) {
      const ItemWithRows own = own_table(item, rows, title);
      if (own.rows.rows.empty()) continue;
      const bool is_named = rows.rows.size() > 1;
      TableBlock table = table_block(own.item, own.rows);
      std::string text = sentences_below(own, is_named);
      if (table.columns.size() > (is_named ? 1U : 0U)) {
        blocks_.emplace_back(std::move(table));
      } else if (!text.empty()) {
        blocks_.emplace_back(SectionBlock{title});
      } else {
        continue;
      }
      text += own.item.note;
      if (!text.empty()) blocks_.emplace_back(SentenceBlock{std::move(text)});
      add_own_tables(own.item, own.rows);
    }
  }

  /// Moves columns whose cells are all equal out of the table into facts below its title. A table with a
  /// single row loses all its columns.
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

std::optional<std::string> range_text(const Range& range, const std::string& unit) {
  if (range.empty()) return {};
  const std::string high = range.low == range.high ? "" : fmt::format(" … {:.3g}", range.high);
  return fmt::format("{:.3g}{}{}{}", range.low, high, unit.empty() ? "" : " ", unit);
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
