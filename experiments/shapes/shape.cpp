#include "experiments/shapes/shape.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/text/text.hpp"
#include "experiments/parameters/unknown_key.hpp"

namespace zerocount::shapes {
namespace {

using Form = Shape::Form;
using Kind = yaml::YamlNode::Kind;

/// Reads values by their shapes. Reports faults to `problems` and stores values in `draft` (null: stores
/// none).
struct Reader {
  yaml::Problems& problems;
  StudyDraft* draft;

  bool value(const yaml::Field& field, const Shape& shape);
  bool value_of_form(const yaml::Field& field, const Shape& shape);
  bool list(const yaml::Field& field, const Shape& shape);
  bool order(const yaml::Field& field, const Shape& shape);
  bool map(const yaml::Field& field, const Shape& shape);
  bool keys(const yaml::Field& map, std::span<const Shape> keys);
  bool entries(const yaml::Field& field, const Shape& shape);
  bool one_of(const yaml::Field& field, const Shape& shape);
  bool line(const yaml::Field& field, const Shape& shape);
  void set_none(const Shape& shape);

  bool refuse(const yaml::Field& field, const std::string& what, std::string_view expected) {
    problems.add(field, what, expected);
    return false;
  }
};

Kind kind_of(const Shape& shape) {
  switch (shape.form) {
    case Form::list:
    case Form::tuple:
      return Kind::list;
    case Form::map:
    case Form::entries:
      return Kind::map;
    default:
      return Kind::scalar;
  }
}

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

void Reader::set_none(const Shape& shape) {
  if (draft != nullptr && shape.set) shape.set(*draft, shape, nullptr);
  for (const Shape& part : shape.parts) set_none(part);
}

bool Reader::value(const yaml::Field& field, const Shape& shape) {
  const auto is_word = [&](std::string_view word) {
    return field.node->kind == Kind::scalar && field.node->text == word;
  };
  if (!shape.none.empty() && is_word(shape.none)) {
    set_none(shape);
    return true;
  }
  const auto preset = std::ranges::find_if(shape.presets, is_word, [](const auto& one) { return one.first; });
  if (preset != shape.presets.end()) {
    if (draft != nullptr) preset->second(*draft);
    return true;
  }
  if (!value_of_form(field, shape)) return false;
  if (draft != nullptr && shape.set) shape.set(*draft, shape, &field);
  return true;
}

bool Reader::value_of_form(const yaml::Field& field, const Shape& shape) {
  switch (shape.form) {
    case Form::own:
      return true;
    case Form::text:
      return yaml::read_text(field, problems).has_value();
    case Form::line:
    case Form::word:
      return line(field, shape);
    case Form::seed:
      return yaml::read_seed(field, problems).has_value();
    case Form::boolean:
      return yaml::read_bool(field, problems).has_value();
    case Form::label:
      return yaml::read_label(field, shape.labels, problems).has_value();
    case Form::whole_number:
      return yaml::read_whole(field, static_cast<std::int64_t>(shape.range.low),
                              static_cast<std::int64_t>(shape.range.high), problems, shape.none)
          .has_value();
    case Form::real:
      return yaml::read_real(field, shape.range, problems, shape.none).has_value();
    case Form::list:
    case Form::tuple:
      return list(field, shape);
    case Form::map:
      return map(field, shape);
    case Form::entries:
      return entries(field, shape);
    case Form::one_of:
      return one_of(field, shape);
  }
  return false;
}

bool Reader::line(const yaml::Field& field, const Shape& shape) {
  const auto text = yaml::read_line(field, problems);
  if (!text) return false;
  if (is_blank(*text))
    return refuse(field, "the text is empty", shape.expected.empty() ? "a text on one line" : shape.expected);
  if (shape.form == Form::line || text->find(' ') == std::string::npos) return true;
  return refuse(field, fmt::format("{} is not one word", yaml::in_quotes(*text)), shape.expected);
}

bool Reader::list(const yaml::Field& field, const Shape& shape) {
  if (!yaml::check_list(field, shape.expected, problems)) return false;
  const std::size_t count = field.node->items.size();
  const bool tuple = shape.form == Form::tuple;
  if (tuple ? count != shape.parts.size() : count < shape.min_count || count > shape.max_count)
    return refuse(field, count == 0 ? "the list is empty" : fmt::format("found a list of {}", count),
                  shape.expected);
  bool sound = true;
  for (std::size_t i = 0; i < count; ++i) {
    sound = value(yaml::item_of(field, i), shape.parts[tuple ? i : 0]) && sound;
    if (!sound && shape.order == Shape::Order::rising) return false;  // a table: one fault may be in all rows
  }
  return sound && order(field, shape);
}

/// Whether the items of the list have the required order (distinct or rising). Reports the first item that
/// breaks the order.
bool Reader::order(const yaml::Field& field, const Shape& shape) {
  if (shape.order == Shape::Order::any) return true;
  const bool rising = shape.order == Shape::Order::rising;
  std::set<double> seen;
  for (const yaml::Field& item : items_of(field)) {
    const yaml::Field key = item.node->kind == Kind::list ? yaml::item_of(item, 0) : item;
    const double number = number_of(key);
    if (rising && !seen.empty() && !(number > *seen.rbegin()))
      return refuse(key, fmt::format("{} is not above {}, the one before it", number, *seen.rbegin()),
                    shape.expected);
    if (!seen.insert(number).second)
      return refuse(key, fmt::format("duplicate: {} stands twice", number), shape.expected);
  }
  return true;
}

bool Reader::map(const yaml::Field& field, const Shape& shape) {
  if (!yaml::check_map(field, shape.expected, problems)) return false;
  std::vector<std::string> known;
  for (const Shape& part : shape.parts) known.emplace_back(part.name);
  const std::size_t before = problems.size();
  parameters::check_keys(field, known, problems);
  return keys(field, shape.parts) && problems.size() == before;
}

bool Reader::keys(const yaml::Field& map, std::span<const Shape> keys) {
  bool sound = true;
  for (const Shape& key : keys) {
    if (const auto field = yaml::find_field(map, key.name)) {
      sound = value(*field, key) && sound;
    } else if (key.required() && !yaml::find_field(map, key.in_its_place)) {
      sound = false;
      problems.add_missing(
          map.node->place,
          map.path.empty() ? std::string(key.name) : fmt::format("{}.{}", map.path, key.name),
          key.if_missing);
    }
  }
  return sound;
}

bool Reader::entries(const yaml::Field& field, const Shape& shape) {
  if (!yaml::check_map(field, shape.expected, problems)) return false;
  const std::size_t count = field.node->entries.size();
  if (count < shape.min_count || count > shape.max_count)
    return refuse(field, fmt::format("found {} {}", count == 0 ? "no" : std::to_string(count), shape.entry),
                  shape.expected);
  bool sound = true;
  for (const yaml::YamlEntry& entry : field.node->entries) {
    const yaml::Field value_of_entry = yaml::entry_of(field, entry);
    if (shape.named && (is_blank(entry.key) || entry.key.find('\n') != std::string::npos)) {
      problems.add(entry.place, value_of_entry.path,
                   fmt::format("the name of the {} is empty, or has two lines", shape.entry), "a name");
      sound = false;
    }
    if (draft != nullptr && shape.add) shape.add(*draft, entry.key);
    sound = value(value_of_entry, shape.parts.front()) && sound;
  }
  return sound;
}

bool Reader::one_of(const yaml::Field& field, const Shape& shape) {
  const Kind kind = field.node->kind;
  const auto chosen = std::ranges::find(shape.parts, kind, kind_of);
  if (chosen != shape.parts.end()) return value(field, *chosen);
  // One of these fails, and says what was found instead.
  return kind == Kind::map ? yaml::check_list(field, shape.expected, problems)
                           : yaml::check_map(field, shape.expected, problems);
}

}  // namespace

Shape of(Form form, Shape key, std::string expected, std::vector<Shape> parts) {
  key.form = form;
  key.expected = std::move(expected);
  key.parts = std::move(parts);
  return key;
}

Shape whole(std::int64_t low, std::int64_t high, Shape key) {
  key.range = numerics::closed(static_cast<double>(low), static_cast<double>(high));
  return of(Form::whole_number, std::move(key));
}

Shape real(const numerics::Interval& range, Shape key) {
  key.range = range;
  return of(Form::real, std::move(key));
}

void limit_items(Shape& map, std::string_view list, std::int64_t highest) {
  Shape& key = *std::ranges::find(map.parts, list, &Shape::name);
  key.parts.front().range.high = static_cast<double>(std::max<std::int64_t>(highest, 0));
}

bool read(const yaml::Field& field, const Shape& shape, yaml::Problems& problems, StudyDraft* draft) {
  return Reader{problems, draft}.value(field, shape);
}

void read_keys(const yaml::Field& map, std::span<const Shape> keys, yaml::Problems& problems,
               StudyDraft* draft) {
  Reader{problems, draft}.keys(map, keys);
}

double number_of(const yaml::Field& field) {
  return text::parse_number<double>(field.node->text).value_or(std::numeric_limits<double>::quiet_NaN());
}

std::vector<yaml::Field> items_of(const yaml::Field& list) {
  std::vector<yaml::Field> items;
  for (std::size_t i = 0; i < list.node->items.size(); ++i) items.push_back(yaml::item_of(list, i));
  return items;
}

}  // namespace zerocount::shapes
