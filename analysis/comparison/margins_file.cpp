#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/comparison/gate_rules.hpp"
#include "core/numerics/interval.hpp"
#include "experiments/parameters/unknown_key.hpp"
#include "experiments/study/point_label.hpp"
#include "experiments/yaml/nearest_name.hpp"
#include "experiments/yaml/scalars.hpp"
#include "experiments/yaml/text_file.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::comparison {
namespace {

const std::vector<std::string> top_keys{
    "confidence", "false_discovery_rate", "fail_on", "measures", "margins", "require", "points"};
const std::vector<std::string> margin_keys{"absolute", "relative", "fail_on"};

template <class List>
std::vector<std::string> names_of(const List& all) {
  std::vector<std::string> names;
  std::transform(all.begin(), all.end(), std::back_inserter(names),
                 [](const auto& one) { return std::string(one.name); });
  return names;
}

/// `worse` or `changed`: whether a change for the better fails too.
bool read_changed_fails(const yaml::Field& field, yaml::Problems& problems) {
  const std::optional<std::string> word = yaml::read_text(field, problems);
  if (!word) return false;
  if (*word != "worse" && *word != "changed") {
    problems.add(field.node->place, field.path,
                 fmt::format("{} is not a kind of failure", yaml::in_quotes(*word)), "worse or changed");
  }
  return *word == "changed";
}

/// A number by itself is the absolute margin.
std::optional<GateMargin> read_margin(const yaml::Field& field, yaml::Problems& problems) {
  GateMargin margin;
  if (field.node->kind == yaml::YamlNode::Kind::scalar) {
    const std::optional<double> absolute = yaml::read_real(field, numerics::at_least(0.0), problems);
    if (absolute) margin.absolute = *absolute;
    return absolute ? std::optional(margin) : std::nullopt;
  }
  if (!yaml::check_map(field, "a number, or a map with absolute, relative, fail_on", problems))
    return std::nullopt;
  bool sized = false;
  for (const yaml::YamlEntry& entry : field.node->entries) {
    const yaml::Field value = yaml::entry_of(field, entry);
    if (entry.key == "absolute") {
      margin.absolute = yaml::read_real(value, numerics::at_least(0.0), problems).value_or(0.0);
      sized = true;
    } else if (entry.key == "relative") {
      margin.relative = yaml::read_real(value, numerics::at_least(0.0), problems).value_or(0.0);
      sized = true;
    } else if (entry.key == "fail_on") {
      margin.changed_fails = read_changed_fails(value, problems);
    } else if (entry.key == "both_ways") {  // what files called it before there was fail_on
      margin.changed_fails = yaml::read_bool(value, problems).value_or(false);
    } else {
      parameters::add_unknown_key(field, entry, margin_keys, problems);
    }
  }
  if (!sized)
    problems.add(field.node->place, field.path, "the margin has no size", "absolute or relative, or both");
  return margin;
}

void read_margin_of(const yaml::Field& map, const yaml::YamlEntry& entry,
                    std::map<std::string, GateMargin>& margins, yaml::Problems& problems) {
  const std::optional<GateMeasure> measure = find_gate_measure(entry.key);
  if (!measure) {
    parameters::add_unknown_key(map, entry, names_of(all_gate_measures()), problems);
    return;
  }
  const yaml::Field field = yaml::entry_of(map, entry);
  const std::optional<GateMargin> margin = read_margin(field, problems);
  if (!margin) return;
  if (measure->proportion() && (margin->absolute >= 1.0 || margin->relative >= 1.0)) {
    problems.add(field.node->place, field.path, "no proportion of trials can be worse by so much",
                 "less than 1, such as 0.02 for two percent points");
    return;
  }
  margins[entry.key] = *margin;
}

void read_margins(const yaml::Field& field, std::map<std::string, GateMargin>& margins,
                  yaml::Problems& problems) {
  if (!yaml::check_map(field, "a map from measures to margins", problems)) return;
  for (const yaml::YamlEntry& entry : field.node->entries) read_margin_of(field, entry, margins, problems);
}

const char* const requirement_form = "a text such as 'success_rate ≥ 0.995' (or >=, ≤, <=), or goal";

/// The parts of a text such as "success_rate ≥ 0.995".
struct RequirementParts {
  std::string name, relation, number;
};

std::optional<RequirementParts> parts_of(std::string_view text) {
  constexpr std::string_view blanks = " \t\n\v\f\r";
  const auto take = [&](std::size_t end) {
    const std::string_view taken = text.substr(0, end);
    text.remove_prefix(taken.size());
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    return std::string(taken);
  };
  take(0);
  RequirementParts parts;
  parts.name = take(text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_.0123456789[]+-"));
  for (const std::string_view relation : {"≥", ">=", "≤", "<="}) {
    if (parts.relation.empty() && text.starts_with(relation)) parts.relation = take(relation.size());
  }
  parts.number = take(text.find_first_of(blanks));
  const bool limited = !parts.relation.empty() && !parts.number.empty();
  const bool complete = !parts.name.empty() && (limited || parts.name == "goal");
  return complete && text.empty() ? std::optional(parts) : std::nullopt;
}

std::optional<Requirement> read_requirement(const yaml::Field& field, yaml::Problems& problems) {
  const std::optional<std::string> text = yaml::read_text(field, problems);
  if (!text) return std::nullopt;
  constexpr std::size_t max_length = 200;  // bytes; no requirement is so long
  const std::optional<RequirementParts> parts = text->size() <= max_length ? parts_of(*text) : std::nullopt;
  Requirement requirement{*text, {}, true, 0.0};
  const auto refuse = [&](const std::string& what, const std::string& expected) {
    problems.add(field.node->place, field.path, what, expected);
    return std::nullopt;
  };
  if (!parts) return refuse(fmt::format("{} cannot be understood", yaml::in_quotes(*text)), requirement_form);
  const std::optional<RequirableQuantity> quantity = find_requirable(parts->name);
  if (quantity) requirement.quantity = *quantity;
  if (quantity && quantity->kind == RequirementKind::goal) {
    if (!parts->relation.empty())
      return refuse("a goal with a limit", "goal by itself: its limits stand in the manifest");
    return requirement;
  }
  requirement.at_least = parts->relation == "≥" || parts->relation == ">=";
  const std::string& number = parts->number;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), requirement.limit);
  if (!quantity) {
    return refuse(fmt::format("{} cannot be required", yaml::in_quotes(parts->name)),
                  fmt::format("one of {}", fmt::join(names_of(requirable_quantities()), ", ")));
  }
  if (error != std::errc{} || end != number.data() + number.size() || !std::isfinite(requirement.limit)) {
    return refuse(fmt::format("{} is not a number", yaml::in_quotes(number)), requirement_form);
  }
  const bool proportion = quantity->kind == RequirementKind::proportion;
  if (proportion && (requirement.limit < 0.0 || requirement.limit > 1.0)) {
    return refuse(fmt::format("{} is not a proportion", number), "a number from 0 to 1");
  }
  if (!proportion && requirement.at_least) {
    return refuse(fmt::format("a least {} is asked for", quantity->name), "≤ and a limit");
  }
  return requirement;
}

/// One requirement, or a list of them.
void read_requirements(const yaml::Field& field, std::vector<Requirement>& requirements,
                       yaml::Problems& problems) {
  const auto add = [&](const yaml::Field& one) {
    if (auto requirement = read_requirement(one, problems)) requirements.push_back(*std::move(requirement));
  };
  if (field.node->kind != yaml::YamlNode::Kind::list) return add(field);
  for (std::size_t i = 0; i < field.node->items.size(); ++i) add(yaml::item_of(field, i));
}

void read_points(const yaml::Field& field, std::span<const std::string> labels, GateRules& rules,
                 yaml::Problems& problems) {
  if (!yaml::check_map(field, "a map from labels of design points to margins and requirements", problems))
    return;
  for (const yaml::YamlEntry& entry : field.node->entries) {
    const yaml::Field point = yaml::entry_of(field, entry);
    const auto named = study::point_named(entry.key, labels);
    if (!named) {
      problems.add(
          entry.place, point.path, "no design point of the files has this label",
          fmt::format("one of theirs, such as {}", yaml::in_quotes(yaml::nearest_name(entry.key, labels))));
      continue;
    }
    const std::string& label = labels[static_cast<std::size_t>(*named)];
    if (!yaml::check_map(point, "a map from measures to margins, and require", problems)) continue;
    for (const yaml::YamlEntry& own : point.node->entries) {
      if (own.key == "require") {
        read_requirements(yaml::entry_of(point, own), rules.requirements_at[label], problems);
      } else {
        read_margin_of(point, own, rules.margins_at[label], problems);
      }
    }
  }
}

void read_measures(const yaml::Field& field, std::vector<std::string>& measures, yaml::Problems& problems) {
  const std::vector<std::string> known = names_of(all_gate_measures());
  const std::string expected = fmt::format("a list of some of {}", fmt::join(known, ", "));
  if (!yaml::check_list(field, expected, problems)) return;
  if (field.node->items.empty()) problems.add(field.node->place, field.path, "the list is empty", expected);
  for (std::size_t i = 0; i < field.node->items.size(); ++i) {
    const yaml::Field item = yaml::item_of(field, i);
    const std::optional<std::string> name = yaml::read_text(item, problems);
    if (!name) continue;
    if (!find_gate_measure(*name)) {
      problems.add(item.node->place, item.path,
                   fmt::format("unknown measure {}, nearest known: {}", yaml::in_quotes(*name),
                               yaml::nearest_name(*name, known)),
                   expected);
    }
    measures.push_back(*name);
  }
}

GateRules read_rules(const yaml::Field& top, std::span<const std::string> labels, yaml::Problems& problems) {
  GateRules rules;
  if (!yaml::check_map(top, fmt::format("a map with some of {}", fmt::join(top_keys, ", ")), problems))
    return rules;
  for (const yaml::YamlEntry& entry : top.node->entries) {
    const yaml::Field field = yaml::entry_of(top, entry);
    if (entry.key == "confidence") {
      rules.confidence =
          yaml::read_real(field, numerics::closed(0.5, 0.999999), problems).value_or(rules.confidence);
    } else if (entry.key == "false_discovery_rate") {
      rules.false_discovery_rate =
          yaml::read_real(field, numerics::closed(1e-6, 0.5), problems).value_or(rules.false_discovery_rate);
    } else if (entry.key == "fail_on") {
      rules.changed_fails = read_changed_fails(field, problems);
    } else if (entry.key == "measures") {
      read_measures(field, rules.measures, problems);
    } else if (entry.key == "margins") {
      read_margins(field, rules.margins, problems);
    } else if (entry.key == "require") {
      read_requirements(field, rules.requirements, problems);
    } else if (entry.key == "points") {
      read_points(field, labels, rules, problems);
    } else {
      parameters::add_unknown_key(top, entry, top_keys, problems);
    }
  }
  return rules;
}

}  // namespace

GateRules parse_gate_rules(const std::string& text, std::string_view source,
                           std::span<const std::string> labels) {
  yaml::Problems problems;
  if (text.size() > yaml::max_manifest_size) {
    problems.add({source, 1, 1}, "margins", "the file is too large",
                 fmt::format("at most {} bytes", yaml::max_manifest_size));
    problems.raise_if_any();
  }
  const yaml::YamlPointer root = yaml::parse_yaml(text, source, false, problems);
  if (!root && problems.empty()) {
    problems.add({source, 1, 1}, "margins", "the file is empty",
                 fmt::format("a map with some of {}", fmt::join(top_keys, ", ")));
  }
  GateRules rules;
  if (root) rules = read_rules({root.get(), ""}, labels, problems);
  problems.raise_if_any();
  return rules;
}

GateRules read_gate_rules(const std::filesystem::path& path, std::span<const std::string> labels) {
  return parse_gate_rules(yaml::read_text(path, yaml::max_manifest_size, "margins in YAML"),
                          yaml::name_of_text(path), labels);
}

}  // namespace zerocount::comparison
