#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/parameters/element_lists.hpp"

namespace zerocount::manifest_text {
namespace {

struct Override {
  std::string_view path;  // of the whole key
  yaml::YamlPointer value;
  yaml::Place place;
};

// Length of the next key in `rest`, for the map at the path `walked`. Keys may contain dots: those of the
// sweep, the names of its cases, those that a condition overrides, and the labels under `observed`.
std::size_t next_key_length(const yaml::YamlNode& map, std::string_view walked, std::string_view rest) {
  std::size_t longest = 0;
  for (const yaml::YamlEntry& entry : map.entries) {
    const std::size_t size = entry.key.size();
    const bool fits = rest.substr(0, size) == entry.key && (rest.size() == size || rest[size] == '.');
    if (fits) longest = std::max(longest, size);
  }
  if (longest > 0) return longest;
  const bool in_case = walked.starts_with("sweep.cases.") || walked.starts_with("conditions.");
  if (walked == "sweep.grid" || walked == "observed" || in_case) return rest.size();
  return std::min(rest.find('.'), rest.size());
}

std::optional<std::size_t> list_index(std::string_view text, std::size_t size) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{} || end != text.data() + text.size() || index >= size) return std::nullopt;
  return index;
}

// The map of an element's keys, which its name leaves out: {notch: {frequency: 120}} has the value
// controller.filters.0.frequency. Null if `map`, at the path `walked`, is not an element, or `key` is its
// form.
yaml::YamlPointer* keys_of_element(yaml::YamlNode& map, std::string_view walked, std::string_view key) {
  const std::string pattern = parameters::without_indices(walked);
  if (!pattern.ends_with(".#") || !parameters::find_element_list(pattern.substr(0, pattern.size() - 2)))
    return nullptr;
  return map.entries.size() == 1 && map.entries[0].key != key ? &map.entries[0].value : nullptr;
}

// A copy of `node` in which the value at the path `rest` is replaced by the override's. Null, after a report,
// if there is no such path.
yaml::YamlPointer replaced(const yaml::YamlPointer& node, const Override& change, std::string_view rest,
                           yaml::Problems& problems) {
  if (rest.empty()) return change.value;
  const std::string_view walked =
      change.path.substr(0, change.path.size() - rest.size() - (rest == change.path ? 0 : 1));
  auto copy = node ? std::make_shared<yaml::YamlNode>(*node) : std::make_shared<yaml::YamlNode>();
  if (!node) {
    copy->kind = yaml::YamlNode::Kind::map;
    copy->place = change.place;
  }
  std::size_t length = std::min(rest.find('.'), rest.size());
  yaml::YamlPointer* child = nullptr;
  if (copy->kind == yaml::YamlNode::Kind::list) {
    const auto index = list_index(rest.substr(0, length), copy->items.size());
    if (!index) {
      problems.add(change.place, change.path,
                   fmt::format("{} has no item {}", walked, yaml::in_quotes(rest.substr(0, length))),
                   fmt::format("an index below {}", copy->items.size()));
      return nullptr;
    }
    child = &copy->items[*index];
  } else if (yaml::YamlPointer* const keys = copy->kind == yaml::YamlNode::Kind::map
                                                 ? keys_of_element(*copy, walked, rest.substr(0, length))
                                                 : nullptr) {
    if (!*keys || (*keys)->kind != yaml::YamlNode::Kind::map) return copy;  // reported when it is read
    const std::string_view key = rest.substr(0, length);
    if (!yaml::find_entry(**keys, key)) {
      problems.add(change.place, change.path, fmt::format("{} has no {}", walked, yaml::in_quotes(key)),
                   "a key that the manifest has");
      return nullptr;
    }
    *keys = replaced(*keys, change, rest, problems);
    return *keys ? copy : nullptr;
  } else if (copy->kind == yaml::YamlNode::Kind::map) {
    length = next_key_length(*copy, walked, rest);
    const std::string_view key = rest.substr(0, length);
    auto entry =
        std::find_if(copy->entries.begin(), copy->entries.end(), [&](const auto& e) { return e.key == key; });
    if (entry == copy->entries.end()) {
      entry = copy->entries.insert(entry, {std::string(key), change.place, nullptr});
    }
    entry->place = change.place;
    child = &entry->value;
  } else {
    problems.add(change.place, change.path, fmt::format("{} is neither a map nor a list", walked),
                 "the key of a value");
    return nullptr;
  }
  const std::string_view further = length == rest.size() ? "" : rest.substr(length + 1);
  *child = replaced(*child, change, further, problems);
  return *child ? copy : nullptr;
}

/// Whether an override of the dotted path is replaced by the sweep of `swept`: the path is `swept` or lies
/// below it.
bool is_given_with(std::string_view path, std::string_view swept) {
  return path.starts_with(swept) && (path.size() == swept.size() || path[swept.size()] == '.');
}

/// The map at a path of keys in the YAML tree; null if there is none.
const yaml::YamlNode* map_at(const yaml::YamlNode& root, std::initializer_list<std::string_view> keys) {
  const yaml::YamlNode* node = &root;
  for (const std::string_view key : keys) {
    if (node->kind != yaml::YamlNode::Kind::map) return nullptr;
    const yaml::YamlEntry* const entry = yaml::find_entry(*node, key);
    if (!entry || !entry->value) return nullptr;
    node = entry->value.get();
  }
  return node->kind == yaml::YamlNode::Kind::map ? node : nullptr;
}

bool gives(const yaml::YamlNode* map, std::string_view path) {
  return map && std::any_of(map->entries.begin(), map->entries.end(),
                            [&](const yaml::YamlEntry& entry) { return is_given_with(path, entry.key); });
}

/// The part of the sweep that gives the key at every point: "sweep.grid", "sweep.cases", or empty.
std::string_view sweep_that_gives(const yaml::YamlNode& root, std::string_view key) {
  if (gives(map_at(root, {"sweep", "grid"}), key)) return "sweep.grid";
  const yaml::YamlNode* const cases = map_at(root, {"sweep", "cases"});
  if (!cases || cases->entries.empty()) return {};
  const bool all =
      std::all_of(cases->entries.begin(), cases->entries.end(), [&](const yaml::YamlEntry& entry) {
        const bool map = entry.value && entry.value->kind == yaml::YamlNode::Kind::map;
        return map && gives(entry.value.get(), key);
      });
  return all ? "sweep.cases" : "";
}

}  // namespace

bool is_dotted_path(std::string_view text) {
  return !text.empty() && text.front() != '.' && text.back() != '.' &&
         text.find("..") == std::string_view::npos;
}

yaml::YamlPointer with_value(const yaml::YamlPointer& root, std::string_view path, yaml::YamlPointer value,
                             const yaml::Place& place, yaml::Problems& problems) {
  return replaced(root, {path, std::move(value), place}, path, problems);
}

bool has_value_at(const yaml::YamlNode& root, std::string_view path) {
  if (root.kind != yaml::YamlNode::Kind::map) return false;
  const std::size_t dot = path.find('.');
  const yaml::YamlEntry* const entry = yaml::find_entry(root, path.substr(0, dot));
  if (!entry || !entry->value) return false;
  return dot == std::string_view::npos || has_value_at(*entry->value, path.substr(dot + 1));
}

const yaml::YamlNode* node_at(const yaml::YamlNode& root, std::string_view path) {
  const yaml::YamlNode* node = &root;
  while (node != nullptr) {
    const auto dot = path.find('.');
    const yaml::YamlEntry* const entry =
        node->kind == yaml::YamlNode::Kind::map ? yaml::find_entry(*node, path.substr(0, dot)) : nullptr;
    node = entry == nullptr ? nullptr : entry->value.get();
    if (dot == std::string_view::npos) break;
    path.remove_prefix(dot + 1);
  }
  return node;
}

yaml::YamlPointer aging_like(const yaml::YamlNode* before, const yaml::YamlPointer& value) {
  using yaml::YamlNode;
  const bool is_map = value->kind == YamlNode::Kind::map;
  if (!is_map && value->kind != YamlNode::Kind::scalar) return value;
  const yaml::YamlEntry* const aging =
      before != nullptr && before->kind == YamlNode::Kind::map ? yaml::find_entry(*before, "aging") : nullptr;
  if (aging == nullptr || (is_map && yaml::find_entry(*value, "aging") != nullptr)) return value;
  auto map = is_map ? std::make_shared<YamlNode>(*value) : std::make_shared<YamlNode>();
  if (!is_map) {
    map->kind = YamlNode::Kind::map;
    map->place = value->place;
    map->entries.push_back({"value", value->place, value});
  }
  map->entries.push_back(*aging);
  return map;
}

yaml::YamlPointer apply_overrides(yaml::YamlPointer root, const std::vector<std::string>& overrides,
                                  std::deque<std::string>& sources, yaml::Problems& problems) {
  for (const std::string& text : overrides) {
    const std::string& source = sources.emplace_back("--set " + text.substr(0, 200));
    const std::size_t equals = text.find('=');
    const std::string key = text.substr(0, equals);
    if (equals == std::string::npos || !is_dotted_path(key) || text.size() > yaml::max_manifest_size) {
      problems.add({source}, "manifest", "invalid override", "--set key=value with the key's dotted path");
      continue;
    }
    if (key == "zerocount") {
      problems.add({source}, key, "the manifest's version cannot be overridden", "any other key");
      continue;
    }
    const std::size_t before = problems.size();
    yaml::YamlPointer value = yaml::parse_yaml(text.substr(equals + 1), source, true, problems);
    if (!value && problems.size() == before) {
      auto null = std::make_shared<yaml::YamlNode>();
      null->place = {source};
      value = null;
    }
    if (!value) continue;
    value = aging_like(node_at(*root, key), value);
    if (const yaml::YamlPointer changed = with_value(root, key, value, {source}, problems)) root = changed;
  }
  return root;
}

void report_swept_overrides(const yaml::YamlNode& root, const std::vector<std::string>& overrides,
                            std::deque<std::string>& sources, yaml::Problems& problems) {
  for (const std::string& text : overrides) {
    const std::string key = text.substr(0, text.find('='));
    const std::string_view sweep = sweep_that_gives(root, key);
    if (sweep.empty()) continue;
    const bool grid = sweep == "sweep.grid";
    problems.add(
        {sources.emplace_back("--set " + text.substr(0, 200))}, key,
        fmt::format("it has no effect: {} gives the value at every point", sweep),
        grid ? fmt::format("sweep.grid.{}=[...]", key) : fmt::format("sweep.cases.NAME.{}=...", key));
  }
}

}  // namespace zerocount::manifest_text
