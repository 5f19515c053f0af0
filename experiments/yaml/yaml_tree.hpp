#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/yaml/problems.hpp"

namespace zerocount {

struct YamlNode;
using YamlPointer = std::shared_ptr<const YamlNode>;

struct YamlEntry {
  std::string key;
  Place place;  ///< of the key
  YamlPointer value;
};

/// A node of a YAML document, as it was written: what a number or a truth value is, is for the reader to say.
/// An alias shares the node of its anchor.
struct YamlNode {
  enum class Kind { null, scalar, list, map };
  Kind kind{Kind::null};
  Place place;
  std::string text;                ///< of a scalar
  bool plain{true};                ///< a scalar without quotes
  std::vector<YamlPointer> items;  ///< of a list
  std::vector<YamlEntry> entries;  ///< of a map, in the order of the document; no key twice
};

/// Limits on what is accepted, so that a hostile file costs neither time nor memory.
constexpr std::size_t max_manifest_size = 1 << 20;     ///< bytes
constexpr std::size_t deepest_nesting = 24;            ///< lists and maps inside one another
constexpr std::size_t max_expanded_nodes = 2'000'000;  ///< nodes once every alias is written out

/// The document in `text`, or null where it is none; everything found wrong goes to `problems`. Refused: more
/// than one document, tags, keys that are not scalars, anchors that contain themselves, and what exceeds the
/// limits above. A key that stands twice in a map is a problem, and its first value is kept. `source` must
/// outlive the tree. With `one_line`, places name the source alone.
YamlPointer parse_yaml(const std::string& text, std::string_view source, bool one_line, Problems& problems);

/// The node in flow style on one line, for labels.
std::string flow_text(const YamlNode& node);

/// The value of `key` in a map, or null.
const YamlEntry* find_entry(const YamlNode& map, std::string_view key);

}  // namespace zerocount
