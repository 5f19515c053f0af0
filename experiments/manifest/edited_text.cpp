#include "experiments/manifest/edited_text.hpp"

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/yaml/problems.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::manifest {
namespace {

std::size_t offset_of(const std::string& text, const yaml::Place& place) {
  std::size_t offset = 0;
  for (int line = 1; line < place.line; ++line) offset = text.find('\n', offset) + 1;
  return offset + static_cast<std::size_t>(place.column - 1);
}

/// "controller: {ki: 5}" for the keys controller.ki.
std::string entry_text(std::string_view path, std::string_view value) {
  const auto dot = path.find('.');
  if (dot == std::string_view::npos) return fmt::format("{}: {}", path, value);
  return fmt::format("{}: {{{}}}", path.substr(0, dot), entry_text(path.substr(dot + 1), value));
}

[[noreturn]] void refuse(std::string_view path, std::string_view what) {
  throw Failure(ExitCode::bad_input,
                fmt::format("manifest: {}: {}; expected a key that takes one number", path, what));
}

/// The text with the entry added to the map.
std::string with_entry(std::string text, const yaml::YamlNode& map, bool root, const std::string& entry) {
  const std::size_t at = offset_of(text, map.place);
  if (at < text.size() && text[at] == '{')
    return text.insert(at + 1, entry + (map.entries.empty() ? "" : ", "));
  if (root) return text + (text.ends_with('\n') ? "" : "\n") + entry + "\n";
  const yaml::Place& first = map.entries.front().place;
  const std::string indent(static_cast<std::size_t>(first.column - 1), ' ');
  return text.insert(offset_of(text, first), entry + "\n" + indent);
}

}  // namespace

std::string with_scalar(const std::string& text, std::string_view path, std::string_view value) {
  yaml::Problems problems;
  yaml::YamlPointer node = yaml::parse_yaml(text, "manifest", false, problems);
  problems.raise_if_any();
  bool root = true;
  for (std::string_view left = path;;) {
    if (!node || node->kind != yaml::YamlNode::Kind::map) refuse(path, "leads through a value");
    const auto dot = left.find('.');
    const yaml::YamlEntry* entry = yaml::find_entry(*node, left.substr(0, dot));
    if (entry == nullptr) return with_entry(text, *node, root, entry_text(left, value));
    node = entry->value;
    root = false;
    if (dot == std::string_view::npos) break;
    left.remove_prefix(dot + 1);
  }
  const std::size_t at = offset_of(text, node->place);
  if (node->kind != yaml::YamlNode::Kind::scalar || !text.substr(at).starts_with(node->text))
    refuse(path, "is not a plain value");
  return std::string(text).replace(at, node->text.size(), value);
}

}  // namespace zerocount::manifest
