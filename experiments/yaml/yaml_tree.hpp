#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/yaml/problems.hpp"

namespace zerocount::yaml {

struct YamlNode;
using YamlPointer = std::shared_ptr<const YamlNode>;

struct YamlEntry {
  std::string key;
  Place place;  ///< place of the key in the document
  YamlPointer value;
};

/// A node of a YAML document with its original text; scalars are converted later. An alias shares the node of
/// its anchor.
struct YamlNode {
  enum class Kind { null, scalar, list, map };
  Kind kind{Kind::null};
  Place place;
  std::string text;                ///< text of a scalar
  bool plain{true};                ///< the scalar is written without quotes
  std::vector<YamlPointer> items;  ///< items of a list
  std::vector<YamlEntry> entries;  ///< entries of a map, in the document's order; each key once
};

/// Limits that protect against malicious files.
constexpr std::size_t max_manifest_size = 1 << 20;  ///< Maximum size of a manifest's text, bytes.
constexpr std::size_t max_nesting = 24;             ///< Maximum depth of nested lists and maps.
/// Maximum number of nodes after all aliases are expanded.
constexpr std::size_t max_expanded_nodes = 2'000'000;

/// Parses the document in `text`. Returns null if that is not possible; all errors are added to `problems`.
/// Refused are several documents, tags, keys that are not scalars, anchors that contain themselves, and
/// documents beyond the limits above. A duplicate key in a map is an error; its first value is kept. `source`
/// must outlive the tree. With `one_line`, places contain only the source.
YamlPointer parse_yaml(const std::string& text, std::string_view source, bool one_line, Problems& problems);

/// The node as YAML text in flow style on one line, for labels.
std::string flow_text(const YamlNode& node);

/// The entry of a map that has this key, or null.
const YamlEntry* find_entry(const YamlNode& map, std::string_view key);

}  // namespace zerocount::yaml
