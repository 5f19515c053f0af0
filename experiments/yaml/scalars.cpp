#include "experiments/yaml/scalars.hpp"

#include <algorithm>
#include <charconv>

#include <boost/algorithm/string/case_conv.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace zerocount::yaml {
namespace {

bool is_one_of(std::string_view text, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), text) != names.end();
}

bool is_yaml11_truth(const std::string& text) {
  return is_one_of(boost::algorithm::to_lower_copy(text),
                   {"yes", "no", "on", "off", "true", "false", "y", "n"});
}

bool is_nonfinite(const std::string& text) {
  std::string word = boost::algorithm::to_lower_copy(text);
  if (!word.empty() && (word.front() == '-' || word.front() == '+')) word.erase(0, 1);
  return is_one_of(word, {".inf", ".nan", "inf", "nan", "infinity"});
}

constexpr std::string_view decimal_digits = "0123456789";

std::string_view without_sign(std::string_view text) {
  return text.substr(text.starts_with('-') || text.starts_with('+') ? 1 : 0);
}

bool consists_of(std::string_view text, std::string_view characters) {
  return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

// The following describe texts without their sign.

bool has_leading_zero(std::string_view text) {
  return text.starts_with('0') && text.find_first_of(decimal_digits, 1) == 1;
}

bool has_other_base(std::string_view text) {
  return is_one_of(text.substr(0, 2), {"0x", "0o", "0b"}) &&
         consists_of(text.substr(2), "0123456789ABCDEFabcdef_");
}

bool has_underscores(std::string_view text) {
  return consists_of(text, "0123456789_.eE+-") && text.find_first_of(decimal_digits) == 0 &&
         text.find('_') != std::string_view::npos;
}

bool has_base_60(std::string_view text) {
  const std::size_t colon = text.find(':');
  return colon != std::string_view::npos && consists_of(text.substr(0, colon), decimal_digits) &&
         consists_of(text.substr(colon), "0123456789.:") && text.find("::") == std::string_view::npos &&
         !text.ends_with(':');
}

// The number in `text`, if the whole text is a number in YAML 1.2 (which from_chars alone does not check).
template <class Number>
std::errc parse_number(const std::string& text, Number& number) {
  if (has_leading_zero(without_sign(text)) || is_nonfinite(text)) return std::errc::invalid_argument;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (end != text.data() + text.size()) return std::errc::invalid_argument;
  return error;
}

bool reads_as_number(const std::string& text) {
  double number = 0.0;
  return parse_number(text, number) != std::errc::invalid_argument;
}

// Describes a scalar that is not the expected number or boolean.
std::string describe_scalar(const YamlNode& node) {
  const std::string shown = in_quotes(node.text);
  if (!node.plain) return fmt::format("{} is a quoted text", shown);
  const std::string text = node.text.substr(0, 100);  // long enough for all tests below
  if (text.empty()) return "the value is empty";
  if (is_yaml11_truth(text)) return fmt::format("{} is a truth value", shown);
  if (is_nonfinite(text)) return fmt::format("{} is not finite", shown);
  const std::string_view digits = without_sign(text);
  if (has_other_base(digits)) return fmt::format("{} is not decimal", shown);
  if (has_leading_zero(digits) && text.find_first_of("\n\r") == std::string::npos)
    return fmt::format("{} starts with a zero, which some programs read as octal", shown);
  if (has_underscores(digits)) return fmt::format("{} contains underscores", shown);
  if (has_base_60(digits))
    return fmt::format("{} contains a colon, which some programs read as base 60", shown);
  if (text.front() == '+') return fmt::format("{} starts with a plus sign", shown);
  return fmt::format("{} is not a number", shown);
}

std::string describe(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "the value is empty";
    case YamlNode::Kind::list:
      return "found a list";
    case YamlNode::Kind::map:
      return "found a map";
    case YamlNode::Kind::scalar:
      return describe_scalar(node);
  }
  return {};
}

bool is_plain_scalar(const YamlNode& node) {
  return node.kind == YamlNode::Kind::scalar && node.plain;
}

template <class Whole>
std::optional<Whole> read_whole_of(const Field& field, Whole low, Whole high, Problems& problems,
                                   std::string_view or_else = {}) {
  const std::string expected = fmt::format("a whole number from {} to {}{}", low, high, or_else);
  const YamlNode& node = *field.node;
  Whole number{};
  const std::errc error =
      is_plain_scalar(node) ? parse_number(node.text, number) : std::errc::invalid_argument;
  if (error == std::errc{} && number >= low && number <= high) return number;
  if (error == std::errc::invalid_argument && !(is_plain_scalar(node) && reads_as_number(node.text))) {
    add_wrong_type(field, expected, problems);
  } else if (error == std::errc::invalid_argument &&
             !consists_of(without_sign(node.text.substr(0, 100)), decimal_digits)) {
    problems.add(field, fmt::format("{} is not written as a whole number", in_quotes(node.text)), expected);
  } else {
    problems.add(field, fmt::format("{} is out of range", in_quotes(node.text)), expected);
  }
  return std::nullopt;
}

bool check_kind(const Field& field, YamlNode::Kind kind, const std::string& expected, Problems& problems) {
  const YamlNode& node = *field.node;
  if (node.kind == kind) return true;
  const std::string what = node.kind == YamlNode::Kind::scalar
                               ? fmt::format("found the single value {}", in_quotes(node.text))
                               : describe(node);
  problems.add(field, what, expected);
  return false;
}

}  // namespace

Field entry_of(const Field& map, const YamlEntry& entry) {
  return {entry.value.get(), map.path.empty() ? entry.key : map.path + "." + entry.key};
}

Field item_of(const Field& list, std::size_t index) {
  return {list.node->items[index].get(), fmt::format("{}.{}", list.path, index)};
}

std::optional<Field> find_field(const Field& map, std::string_view key) {
  const YamlEntry* entry = find_entry(*map.node, key);
  if (entry == nullptr) return std::nullopt;
  return entry_of(map, *entry);
}

void Problems::add(const Field& field, std::string_view what, std::string_view expected) {
  add(field.node->place, field.path, what, expected);
}

void add_wrong_type(const Field& field, const std::string& expected, Problems& problems) {
  problems.add(field, describe(*field.node), expected);
}

std::optional<double> read_real(const Field& field, const numerics::Interval& range, Problems& problems,
                                std::string_view or_else) {
  const YamlNode& node = *field.node;
  const std::string allowed = numerics::range_text(range);
  const std::string expected =
      fmt::format("{}{}{}", allowed.rfind("any", 0) == 0 ? "" : "a number ", allowed, or_else);
  double number = 0.0;
  const std::errc error =
      is_plain_scalar(node) ? parse_number(node.text, number) : std::errc::invalid_argument;
  if (error == std::errc::invalid_argument) {
    add_wrong_type(field, expected, problems);
  } else if (error != std::errc{}) {
    problems.add(field, fmt::format("{} is too large or too small for a double", in_quotes(node.text)),
                 expected);
  } else if (!numerics::contains(range, number)) {
    problems.add(field, fmt::format("{} is out of range", in_quotes(node.text)), expected);
  } else {
    return number;
  }
  return std::nullopt;
}

std::optional<std::int64_t> read_whole(const Field& field, std::int64_t low, std::int64_t high,
                                       Problems& problems, std::string_view or_else) {
  return read_whole_of<std::int64_t>(field, low, high, problems, or_else);
}

std::optional<std::uint64_t> read_seed(const Field& field, Problems& problems) {
  return read_whole_of<std::uint64_t>(field, 0, std::numeric_limits<std::uint64_t>::max(), problems);
}

std::optional<bool> read_bool(const Field& field, Problems& problems) {
  const YamlNode& node = *field.node;
  if (is_plain_scalar(node) && (node.text == "true" || node.text == "false")) return node.text == "true";
  const std::string what =
      !is_plain_scalar(node) ? describe(node)
      : is_yaml11_truth(node.text)
          ? fmt::format("{} is a truth value only in some versions of YAML", in_quotes(node.text))
          : fmt::format("{} is not a truth value", in_quotes(node.text));
  problems.add(field, what, "true or false");
  return std::nullopt;
}

std::optional<std::size_t> read_label(const Field& field, std::span<const std::string_view> labels,
                                      Problems& problems) {
  const YamlNode& node = *field.node;
  const auto label = std::find(labels.begin(), labels.end(), node.text);
  if (node.kind == YamlNode::Kind::scalar && label != labels.end()) {
    return static_cast<std::size_t>(label - labels.begin());
  }
  const std::string what = node.kind == YamlNode::Kind::null
                               ? describe(node)
                               : fmt::format("unknown value {}", in_quotes(flow_text(node)));
  problems.add(field, what, fmt::format("one of {}", fmt::join(labels, ", ")));
  return std::nullopt;
}

std::optional<std::string> read_text(const Field& field, Problems& problems) {
  const YamlNode& node = *field.node;
  if (node.kind != YamlNode::Kind::scalar) {
    add_wrong_type(field, "a text", problems);
    return std::nullopt;
  }
  if (node.plain && (reads_as_number(node.text) || is_yaml11_truth(node.text) || is_nonfinite(node.text))) {
    problems.add(field, fmt::format("{} would be read as a number or a truth value", in_quotes(node.text)),
                 "a text, in quotation marks if it looks like a number or a truth value");
    return std::nullopt;
  }
  return node.text;
}

std::optional<std::string> read_line(const Field& field, Problems& problems) {
  std::optional<std::string> text = read_text(field, problems);
  if (!text || text->find_first_of("\t\r\n") == std::string::npos) return text;
  problems.add(field, "a line break or a tab in a name", "a text on one line");
  return std::nullopt;
}

bool check_map(const Field& field, const std::string& expected, Problems& problems) {
  return check_kind(field, YamlNode::Kind::map, expected, problems);
}

bool check_list(const Field& field, const std::string& expected, Problems& problems) {
  return check_kind(field, YamlNode::Kind::list, expected, problems);
}

}  // namespace zerocount::yaml
