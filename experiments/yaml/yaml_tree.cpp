#include "experiments/yaml/yaml_tree.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include "experiments/yaml/faults.hpp"

namespace zerocount::yaml {
namespace {

// Thrown through yaml-cpp's parser to stop it.
struct Refusal {
  Place place;
  std::string path;
  std::string what;
  std::string expected;
};

class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::string_view source, bool one_line, Problems& problems)
      : source_(source), one_line_(one_line), problems_(problems) {}

  YamlPointer root() const { return root_; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (root_) refuse(place(mark), "a second document starts here", "one document in a manifest");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    YamlNode node;
    node.place = place(mark);
    finish(std::move(node), 1, anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchored_.find(anchor);
    if (found == anchored_.end()) {
      refuse(place(mark), "the alias lies inside its own anchor", "a document without cycles");
    }
    accept(found->second.node, found->second.size, place(mark));
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_tag(mark, tag);
    if (const auto character = unprintable_character(value))
      refuse(place(mark), fmt::format("control character {} in a text", *character), "a printable text");
    YamlNode node;
    node.kind = YamlNode::Kind::scalar;
    node.place = place(mark);
    node.text = value;
    node.plain = tag == "?";
    finish(std::move(node), 1, anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, YamlNode::Kind::list);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, YamlNode::Kind::map);
  }
  void OnMapEnd() override { close(); }

  [[noreturn]] void refuse(const Place& where, std::string what, std::string expected) const {
    throw Refusal{where, path(), std::move(what), std::move(expected)};
  }

  // Start of the innermost open list or map; otherwise the mark.
  Place open_place(const YAML::Mark& mark) const {
    return open_.empty() ? place(mark) : open_.back().node.place;
  }

  Place place(const YAML::Mark& mark) const {
    return one_line_ ? Place{source_} : Place{source_, mark.line + 1, mark.column + 1};
  }

 private:
  struct Open {
    YamlNode node;
    YAML::anchor_t anchor;
    std::size_t size{1};           // number of nodes with expanded aliases
    bool has_key{false};           // a key was read, but not yet its value
    std::set<std::string> keys{};  // of a map
  };
  struct Anchored {
    YamlPointer node;
    std::size_t size;
  };

  std::string path() const {
    std::string dotted;
    for (const Open& open : open_) {
      std::string step;
      if (open.node.kind == YamlNode::Kind::list) {
        step = fmt::format("{}", open.node.items.size());
      } else if (open.has_key) {
        step = open.node.entries.back().key;
      } else {
        continue;
      }
      dotted += (dotted.empty() ? "" : ".") + step;
    }
    return dotted.empty() ? "manifest" : dotted;
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (!tag.empty() && tag != "?" && tag != "!") {
      refuse(place(mark), fmt::format("unsupported tag {}", in_quotes(tag)), "a value without a tag");
    }
  }

  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YamlNode::Kind kind) {
    refuse_tag(mark, tag);
    refuse_as_key(place(mark));
    if (open_.size() >= max_nesting) {
      refuse(place(mark), "the nesting is too deep", fmt::format("at most {} levels", max_nesting));
    }
    Open opened{.node = {}, .anchor = anchor};
    opened.node.kind = kind;
    opened.node.place = place(mark);
    open_.push_back(std::move(opened));
  }

  void close() {
    Open closed = std::move(open_.back());
    open_.pop_back();
    finish(std::move(closed.node), closed.size, closed.anchor);
  }

  // Adds a finished node, which an alias may repeat.
  void finish(YamlNode finished, std::size_t size, YAML::anchor_t anchor) {
    const auto node = std::make_shared<const YamlNode>(std::move(finished));
    if (anchor != YAML::NullAnchor) anchored_[anchor] = {node, size};
    accept(node, size, node->place);
  }

  void refuse_as_key(const Place& where) const {
    if (!open_.empty() && open_.back().node.kind == YamlNode::Kind::map && !open_.back().has_key) {
      refuse(where, "a list or a map cannot be a key", "a name as the key");
    }
  }

  // Adds a finished node to the open list or map.
  void accept(const YamlPointer& node, std::size_t size, const Place& where) {
    if (open_.empty()) {
      root_ = node;
      return;
    }
    Open& parent = open_.back();
    parent.size += size;
    if (parent.size > max_expanded_nodes) {
      refuse(where, "the aliases expand to too many values",
             fmt::format("at most {} values after expansion", max_expanded_nodes));
    }
    if (parent.node.kind == YamlNode::Kind::list) {
      parent.node.items.push_back(node);
    } else if (!parent.has_key) {
      accept_key(parent, *node, where);
    } else {
      parent.node.entries.back().value = node;
      parent.has_key = false;
      const std::string& key = parent.node.entries.back().key;
      if (!parent.keys.insert(key).second) parent.node.entries.pop_back();
    }
  }

  void accept_key(Open& parent, const YamlNode& key, const Place& where) {
    if (key.kind == YamlNode::Kind::list || key.kind == YamlNode::Kind::map) refuse_as_key(where);
    if (key.kind == YamlNode::Kind::null) refuse(where, "the key is empty", "a name as the key");
    if (key.text.find_first_of("\t\r\n") != std::string::npos)
      refuse(where, "a line break or a tab in a key", "a name on one line");
    if (key.text == "<<") refuse(where, "merge keys are not supported", "the keys themselves");
    parent.node.entries.push_back({key.text, where, nullptr});
    parent.has_key = true;
    if (parent.keys.count(key.text) > 0) {
      problems_.add(where, path(), "duplicate key", "each key once");
    }
  }

  std::string_view source_;
  bool one_line_;
  Problems& problems_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Anchored> anchored_;
  YamlPointer root_;
};

}  // namespace

YamlPointer parse_yaml(const std::string& text, std::string_view source, bool one_line, Problems& problems) {
  constexpr std::string_view whole = "manifest";
  Place bad = first_bad_byte(text, source);
  if (bad.line > 0) {
    if (one_line) bad = {source};
    problems.add(bad, whole, "invalid UTF-8 or control character",
                 "a manifest in UTF-8 without control characters");
    return nullptr;
  }
  if (const auto fault = first_lexical_fault(text)) {
    problems.add(one_line ? Place{source} : place_of(text, fault->offset, source), whole, fault->what,
                 fault->expected);
    return nullptr;
  }
  TreeBuilder builder(source, one_line, problems);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const Refusal& refusal) {
    problems.add(refusal.place, refusal.path, refusal.what, refusal.expected);
    return nullptr;
  } catch (const YAML::Exception& error) {
    const bool cut_off = error.msg.rfind("end of ", 0) == 0 && error.mark.pos <= 0;  // its mark is invalid
    problems.add(cut_off ? builder.open_place(error.mark) : builder.place(error.mark), whole,
                 syntax_fault(error.msg), "valid YAML");
    return nullptr;
  }
  return builder.root();
}

std::string flow_text(const YamlNode& node) {
  std::vector<std::string> parts;
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "~";
    case YamlNode::Kind::scalar:
      return node.text;
    case YamlNode::Kind::list:
      for (const YamlPointer& item : node.items) parts.push_back(flow_text(*item));
      return fmt::format("[{}]", fmt::join(parts, ", "));
    case YamlNode::Kind::map:
      for (const YamlEntry& entry : node.entries) parts.push_back(entry.key + ": " + flow_text(*entry.value));
      return fmt::format("{{{}}}", fmt::join(parts, ", "));
  }
  return {};
}

const YamlEntry* find_entry(const YamlNode& map, std::string_view key) {
  const auto found =
      std::find_if(map.entries.begin(), map.entries.end(), [&](const YamlEntry& e) { return e.key == key; });
  return found == map.entries.end() ? nullptr : &*found;
}

}  // namespace zerocount::yaml
