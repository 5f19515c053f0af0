#include <algorithm>
#include <deque>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/yaml/problems.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::manifest_text {
namespace {

std::size_t offset_of(const std::string& text, const yaml::Place& place) {
  std::size_t offset = 0;
  for (int line = 1; line < place.line; ++line) offset = text.find('\n', offset) + 1;
  return offset + static_cast<std::size_t>(place.column - 1);
}

/// Text of a manifest entry that gives `path` the value, "controller: {ki: 5}" for the path controller.ki.
std::string entry_text(std::string_view path, std::string_view value) {
  const auto dot = path.find('.');
  if (dot == std::string_view::npos) return fmt::format("{}: {}", path, value);
  return fmt::format("{}: {{{}}}", path.substr(0, dot), entry_text(path.substr(dot + 1), value));
}

/// The manifest `text` with a new entry added to the given map.
/// @param root the map is the whole manifest
std::string with_entry(std::string text, const yaml::YamlNode& map, bool root, const std::string& entry) {
  const std::size_t at = offset_of(text, map.place);
  if (at < text.size() && text[at] == '{')
    return text.insert(at + 1, entry + (map.entries.empty() ? "" : ", "));
  if (root) return text + (text.ends_with('\n') ? "" : "\n") + entry + "\n";
  const yaml::Place& first = map.entries.front().place;
  const std::string indent(static_cast<std::size_t>(first.column - 1), ' ');
  return text.insert(offset_of(text, first), entry + "\n" + indent);
}

/// Offset of the end of a list or map in flow style ([…] or {…}) that begins at offset `at`.
std::size_t end_of_flow(const std::string& text, std::size_t at) {
  int depth = 0;
  char quote = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '{' || c == '[') {
      ++depth;
    } else if ((c == '}' || c == ']') && --depth == 0) {
      return at + 1;
    }
  }
  return text.size();
}

/// Offset of the end of a value in YAML block style that begins at offset `at`: the end of its last line that
/// is indented more than its key.
std::size_t end_of_block(const std::string& text, std::size_t at, int key_column) {
  std::size_t end = std::min(text.find('\n', at), text.size());
  for (std::size_t start = end + 1; start < text.size();) {
    const std::size_t next = std::min(text.find('\n', start), text.size());
    const std::size_t word = text.find_first_not_of(' ', start);
    if (word < next && text[word] != '#') {
      if (static_cast<int>(word - start) < key_column) break;
      end = next;
    }
    start = next + 1;
  }
  return end;
}

/// The manifest `text` with another value of the entry.
std::string with_new_value(std::string text, const yaml::YamlEntry& entry, std::string_view value) {
  const yaml::YamlNode& node = *entry.value;
  const std::size_t at = offset_of(text, node.place);
  const char first = at < text.size() ? text[at] : '\0';
  if (first == '{' || first == '[') return text.replace(at, end_of_flow(text, at) - at, value);
  if (first == '"' || first == '\'') return text.replace(at, text.find(first, at + 1) + 1 - at, value);
  if (node.kind == yaml::YamlNode::Kind::scalar) return text.replace(at, node.text.size(), value);
  const std::size_t colon = text.find(':', offset_of(text, entry.place));
  const std::size_t end = end_of_block(text, at, entry.place.column);
  return text.replace(colon + 1, end - colon - 1, " " + std::string(value));
}

/// Whether two YAML trees have the same values, whatever the order of their keys.
bool same_tree(const yaml::YamlNode& a, const yaml::YamlNode& b) {
  if (a.kind != b.kind || a.text != b.text || a.items.size() != b.items.size() ||
      a.entries.size() != b.entries.size())
    return false;
  for (std::size_t i = 0; i < a.items.size(); ++i) {
    if (!same_tree(*a.items[i], *b.items[i])) return false;
  }
  return std::ranges::all_of(a.entries, [&b](const yaml::YamlEntry& one) {
    const yaml::YamlEntry* other = yaml::find_entry(b, one.key);
    return other != nullptr && same_tree(*one.value, *other->value);
  });
}

std::string edited(const std::string& text, const yaml::YamlNode& tree, std::string_view path,
                   std::string_view value) {
  const yaml::YamlNode* node = &tree;
  for (std::string_view left = path;;) {
    const auto dot = left.find('.');
    const yaml::YamlEntry* entry = yaml::find_entry(*node, left.substr(0, dot));
    if (entry == nullptr) return with_entry(text, *node, node == &tree, entry_text(left, value));
    if (dot == std::string_view::npos) return with_new_value(text, *entry, value);
    if (entry->value->kind != yaml::YamlNode::Kind::map) return text;
    node = entry->value.get();
    left.remove_prefix(dot + 1);
  }
}

}  // namespace

std::optional<std::string> with_override(const std::string& text, std::string_view path,
                                         std::string_view value) {
  yaml::Problems problems;
  std::deque<std::string> sources;
  const yaml::YamlPointer before = yaml::parse_yaml(text, "manifest", false, problems);
  if (!before || before->kind != yaml::YamlNode::Kind::map) return std::nullopt;
  const std::string changed = edited(text, *before, path, value);
  // The edit knows only the usual ways to write YAML; the meaning of its result decides.
  const yaml::YamlPointer after = yaml::parse_yaml(changed, "manifest", false, problems);
  const yaml::YamlPointer wanted =
      apply_overrides(before, {fmt::format("{}={}", path, value)}, sources, problems);
  if (!problems.empty() || !after || !wanted || !same_tree(*after, *wanted)) return std::nullopt;
  return changed;
}

}  // namespace zerocount::manifest_text
