#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/failure/failure.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"
#include "experiments/study/study_table.hpp"
#include "experiments/yaml/problems.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::manifest_text {
namespace {

using yaml::YamlNode;
using yaml::YamlPointer;

bool is_bare(std::string_view text) {
  constexpr std::string_view safe = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.+-/";
  return !text.empty() && text.find_first_not_of(safe) == std::string_view::npos;
}

std::string scalar_text(const std::string& text, bool plain) {
  return plain && is_bare(text) ? text : nlohmann::json(text).dump();
}

std::string yaml_text(const YamlNode& node) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "~";
    case YamlNode::Kind::scalar:
      return scalar_text(node.text, node.plain);
    case YamlNode::Kind::list:
      for (const YamlPointer& item : node.items) add(yaml_text(*item));
      return "[" + text + "]";
    case YamlNode::Kind::map:
      for (const yaml::YamlEntry& entry : node.entries)
        add(scalar_text(entry.key, true) + ": " + yaml_text(*entry.value));
      return "{" + text + "}";
  }
  return text;
}

YamlPointer number_node(double number) {
  auto node = std::make_shared<YamlNode>();
  node->kind = YamlNode::Kind::scalar;
  const bool whole = number == std::trunc(number) && std::abs(number) < 1e15;
  node->text = whole ? fmt::format("{:.0f}", number) : fmt::format("{}", number);
  return node;
}

const YamlNode* child(const YamlNode& map, std::string_view key) {
  const yaml::YamlEntry* entry = yaml::find_entry(map, key);
  return entry == nullptr ? nullptr : entry->value.get();
}

/// The YAML tree without the entry at the path, "key" or "section.key".
YamlPointer without(const YamlPointer& root, std::string_view path) {
  const auto dot = path.find('.');
  auto copy = std::make_shared<YamlNode>(*root);
  const auto entry = std::ranges::find(copy->entries, path.substr(0, dot), &yaml::YamlEntry::key);
  if (entry == copy->entries.end()) return root;
  if (dot == std::string_view::npos) {
    copy->entries.erase(entry);
  } else {
    entry->value = without(entry->value, path.substr(dot + 1));
  }
  return copy;
}

/// The path at which the manifest has the number of a parameter. For the rate "friction.k1.aging" this is the
/// key of the law, if `aging` is a map.
std::string number_path(const YamlNode& root, std::string_view path) {
  const YamlNode* const aging = path.ends_with(study::suffix_of_rate) ? node_at(root, path) : nullptr;
  if (aging == nullptr || aging->kind != YamlNode::Kind::map) return std::string(path);
  const auto law =
      std::ranges::find_if(aging->entries, [](const yaml::YamlEntry& entry) { return entry.key != "scale"; });
  return law == aging->entries.end() ? std::string(path) : fmt::format("{}.{}", path, law->key);
}

/// The tree of a manifest, which can be changed key by key.
class ManifestTree {
 public:
  explicit ManifestTree(const study::Study& study) : study_(study) {
    root_ = yaml::parse_yaml(study.manifest.text, study.name, false, problems_);
    if (root_) root_ = apply_overrides(root_, study.manifest.overrides, sources_, problems_);
    problems_.raise_if_any();
  }

  /// Writes the values that the sweep has at the design point into the sections of the manifest.
  void settle(std::int64_t design_point) {
    const YamlNode* sweep = child(*root_, "sweep");
    if (sweep == nullptr) return;
    const YamlPointer kept = root_;  // of which the sweep is a part
    const study::StudyPlan& plan = *study_.plan;
    const std::size_t point = study::plan_point(plan, design_point);
    std::size_t axis = 0;
    if (const YamlNode* cases = child(*sweep, "cases"); cases != nullptr) {
      const YamlPointer& one = cases->entries[study::option_at(plan, axis++, point)].value;
      for (const yaml::YamlEntry& entry : one->entries) settle_value(entry.key, entry.value);
    }
    const YamlNode* grid = child(*sweep, "grid");
    for (std::size_t i = 0; grid != nullptr && i < grid->entries.size(); ++i, ++axis) {
      const yaml::YamlEntry& swept = grid->entries[i];
      const std::size_t option = study::option_at(plan, axis, point);
      const study::PlanAxis& values = plan.axes[axis];
      settle_value(swept.key, swept.value->kind == YamlNode::Kind::list
                                  ? swept.value->items[option]
                                  : number_node(values.assignments[values.first[option]].value.number));
    }
  }

  /// Writes the overrides of the condition into the sections of the manifest, and removes `conditions`.
  void settle_condition(std::string_view condition) {
    const YamlPointer kept = root_;
    const YamlNode& overrides = *child(*child(*root_, "conditions"), condition);
    for (const yaml::YamlEntry& entry : overrides.entries) settle_value(entry.key, entry.value);
    remove("conditions");
  }

  void settle_value(std::string_view path, const YamlPointer& value) {
    put(number_path(*root_, path), aging_like(node_at(*root_, path), value));
  }

  void remove(std::string_view path) { root_ = without(root_, path); }

  /// The overrides (dotted path: value) of a condition, as YAML text.
  std::string overrides_of(std::string_view condition) const {
    return yaml_text(*child(*child(*root_, "conditions"), condition));
  }

  void put(std::string_view path, const YamlPointer& value) {
    root_ = with_value(root_, path, value, {study_.name}, problems_);
    problems_.raise_if_any();
  }

  /// Sets a parameter to a number. If the manifest gives the parameter by its short name, the key of the
  /// section is replaced.
  void put_number(const std::string& name, double number) {
    const auto slot = study::find_slots(name, study_.plan->table);
    const std::string_view short_name =
        slot ? study_.plan->table.rows[slot->first].short_name : std::string_view();
    const bool is_short = !short_name.empty() && !has_value_at(*root_, name);
    put(is_short ? std::string(short_name) : number_path(*root_, name), number_node(number));
  }

  void put_text(const std::string& key, const std::string& text) {
    root_ = apply_overrides(root_, {fmt::format("{}={}", key, text)}, sources_, problems_);
    problems_.raise_if_any();
  }

  /// Makes the file names independent of the folder of the manifest, by resolving them from `folder`.
  /// @throws Failure (bad_input) if `folder` is empty and the manifest names a file
  void name_files_from(const std::filesystem::path& folder) {
    for (const char* path : {"controller.plugin", "samples", "samples.file"}) {
      const YamlNode* node = root_.get();
      for (std::string_view left = path; node != nullptr;) {
        const auto dot = left.find('.');
        node = node->kind == YamlNode::Kind::map ? child(*node, left.substr(0, dot)) : nullptr;
        if (dot == std::string_view::npos) break;
        left.remove_prefix(dot + 1);
      }
      if (node == nullptr || node->kind != YamlNode::Kind::scalar) continue;
      if (folder.empty())
        throw Failure(ExitCode::bad_input, fmt::format("{}: the place of {} is not known", path, node->text));
      auto named = std::make_shared<YamlNode>(*node);
      named->text = (folder / node->text).lexically_normal().string();
      put(path, named);
    }
  }

  std::string text() const {
    std::string text;
    for (const yaml::YamlEntry& entry : root_->entries)
      text += fmt::format("{}: {}\n", scalar_text(entry.key, true), yaml_text(*entry.value));
    return text;
  }

 private:
  const study::Study& study_;
  yaml::Problems problems_;
  std::deque<std::string> sources_;
  YamlPointer root_;
};

}  // namespace

std::string manifest_of_point(const study::Study& study, std::int64_t point, const PointChanges& changes) {
  ManifestTree tree(study);
  tree.settle(point);
  for (const char* of_the_sweep : {"sweep", "observed", "independent_points"}) tree.remove(of_the_sweep);
  if (!changes.condition.empty()) tree.settle_condition(changes.condition);
  for (const std::string& key : changes.removed) tree.remove(key);
  for (const auto& [name, value] : changes.values) tree.put_number(name, value);
  for (const auto& [key, text] : changes.keys) tree.put_text(key, text);
  tree.name_files_from(changes.folder);
  return tree.text();
}

std::string only_condition(const study::Study& study, const std::string& condition) {
  return fmt::format("conditions={{{}: {}}}", nlohmann::json(condition).dump(),
                     ManifestTree(study).overrides_of(condition));
}

}  // namespace zerocount::manifest_text
