#include "analysis/pairs/comparison/gate_rules.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "core/failure/failure.hpp"
#include "core/numerics/interval.hpp"
#include "core/text/text.hpp"
#include "core/trial/move_measures.hpp"
#include "experiments/parameters/unknown_key.hpp"
#include "experiments/study/point_label.hpp"
#include "experiments/yaml/problems.hpp"
#include "experiments/yaml/scalars.hpp"
#include "experiments/yaml/text_file.hpp"
#include "experiments/yaml/yaml_tree.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::comparison {
namespace {

template <class List>
auto find_named(const List& all, std::string_view name) {
  return std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
}

/// Appends the quantities of a measure that a requirement can limit, such as its quantiles.
/// @param stem name of the measure, which precedes the name of a quantile
void add_quantities(std::vector<RequirableQuantity>& quantities, const std::string& stem,
                    const GateMeasure& measure) {
  if (measure.proportion()) {
    quantities.push_back({stem, measure.unit, RequirementKind::proportion, measure});
  } else if (measure.measure->reduction == layout::MoveReduction::sum) {
    quantities.push_back({stem, measure.unit, RequirementKind::mean, measure});
  } else {
    for (const auto& [quantile, probability] : quantile_names)
      quantities.push_back({fmt::format("{}.{}", stem, quantile), measure.unit, RequirementKind::quantile,
                            measure, probability});
  }
}

/// Appends the quantities that a requirement can limit for each error band and tolerance in the table.
void add_limit_quantities(std::vector<RequirableQuantity>& quantities, const layout::MeasureTable& measures) {
  for (const layout::Measure& measure : measures) {
    if (!measure.band && !measure.tolerance) continue;
    const layout::Column& column = measure.field.column;
    add_quantities(quantities, column.name, {&measure, column.name, column.unit, {}});
  }
}

/// The number in the brackets of a name: 5 in "band_settling_time[5].p95". Empty if there is no number, or if
/// it is negative.
template <class Number>
std::optional<Number> number_in(std::string_view name) {
  const std::size_t open = name.find('[');
  const std::size_t close = name.find(']');
  if (open >= close || close == std::string_view::npos) return std::nullopt;
  const auto number = text::parse_number<Number>(name.substr(open + 1, close - open - 1));
  return number && *number >= Number{} ? number : std::nullopt;
}

/// The features of a study with just the error band or tolerance in the name: "band_settling_time[5].p95",
/// "tolerance_settling_time[1e-8].p95". Empty for other names.
std::optional<study::StudyFeatures> features_with_limit(std::string_view name) {
  study::StudyFeatures features;
  if (const auto band = number_in<std::int64_t>(name); band && name.starts_with("band_")) {
    features.bands = {.limits = {*band}, .count = 1};
    return features;
  }
  const auto tolerance = number_in<double>(name);
  if (!tolerance || !std::isfinite(*tolerance) || *tolerance == 0.0 || !layout::is_of_tolerance(name))
    return std::nullopt;
  features.tolerances = {.limits = {*tolerance}, .count = 1};
  return features;
}

/// The name of a quantity as results files write it. In the input, users may write the number of a tolerance
/// in several ways, such as 1e-8 or 0.00000001.
std::string name_in_files(std::string_view name) {
  const auto tolerance = number_in<double>(name);
  if (!tolerance || !layout::is_of_tolerance(name)) return std::string(name);
  return layout::name_of_tolerance(name.substr(0, name.find('[')), *tolerance) +
         std::string(name.substr(name.find(']') + 1));
}

/// The names by which the rules may refer to a measure, the most specific one first: "goal_rate[large]", then
/// "goal_rate".
std::vector<std::string> names_in_rules(const std::string& measure) {
  std::vector<std::string> names{measure};
  if (const std::string_view whole = without_goal(measure); whole != measure) names.emplace_back(whole);
  return names;
}

/// Pointers to the rules for all points, followed by the rules for each single point.
std::vector<const PointRules*> all_rules(const GateRules& rules) {
  std::vector<const PointRules*> all{&rules};
  for (const auto& [label, own] : rules.points) all.push_back(&own);
  return all;
}

std::vector<const Requirement*> all_requirements(const GateRules& rules) {
  std::vector<const Requirement*> all;
  for (const PointRules* const one : all_rules(rules))
    for (const Requirement& requirement : one->requirements) all.push_back(&requirement);
  return all;
}

/// The names of all measures that occur in the rules: those in the list of judged measures, and those with a
/// margin.
std::vector<std::string> named_measures(const GateRules& rules) {
  std::vector<std::string> names = rules.measures;
  for (const PointRules* const one : all_rules(rules))
    for (const auto& [name, margin] : one->margins) names.push_back(name);
  return names;
}

/// Whether the measure is in the rules' list of judged measures, by one of its names.
bool is_listed(const GateRules& rules, const std::string& measure) {
  return std::ranges::any_of(names_in_rules(measure), [&](const std::string& name) {
    return std::ranges::find(rules.measures, name) != rules.measures.end();
  });
}

/// Whether the rules give the measure a margin, for all points or for a single one.
bool has_margin(const GateRules& rules, const std::string& name) {
  return std::ranges::any_of(all_rules(rules),
                             [&](const PointRules* one) { return one->margins.contains(name); });
}

const GateMargin* margin_in(const std::map<std::string, GateMargin>& margins, const std::string& measure) {
  for (const std::string& name : names_in_rules(measure)) {
    if (const auto found = margins.find(name); found != margins.end()) return &found->second;
  }
  return nullptr;
}

/// Copy of the requirements, in which the requirement `goal` is replaced by one requirement for each goal.
/// @param goals names of the goals
std::vector<Requirement> for_each_goal(const std::vector<Requirement>& requirements,
                                       std::span<const std::string> goals) {
  std::vector<Requirement> all;
  for (const Requirement& one : requirements) {
    const bool of_goal = one.quantity.kind == RequirementKind::goal;
    for (std::size_t goal = 0; goal < (of_goal ? goals.size() : 1); ++goal) {
      all.push_back(one);
      if (!of_goal) continue;
      all.back().goal = goal;
      all.back().quantity.name = name_of_goal_measure(one.quantity.name, goals[goal]);
      all.back().text = name_of_goal_measure(one.text, goals[goal]);
    }
  }
  return all;
}

template <class List>
std::vector<std::string> names_of(const List& all) {
  std::vector<std::string> names;
  std::transform(all.begin(), all.end(), std::back_inserter(names),
                 [](const auto& one) { return std::string(one.name); });
  return names;
}

/// A key that a map of the YAML file may have, with the function that reads its value.
struct Key {
  std::string name;
  std::function<void(const yaml::Field&)> read;
};

void read_keys(const yaml::Field& map, const std::vector<Key>& keys, yaml::Problems& problems) {
  for (const yaml::YamlEntry& entry : map.node->entries) {
    const auto key = find_named(keys, entry.key);
    if (key == keys.end())
      parameters::add_unknown_key(map, entry, names_of(keys), problems);
    else
      key->read(yaml::entry_of(map, entry));
  }
}

/// Reads the key that says which change fails the gate: `worse` or `changed`. True for `changed`: a change
/// for the better fails too.
bool read_changed_fails(const yaml::Field& field, yaml::Problems& problems) {
  const std::optional<std::string> word = yaml::read_text(field, problems);
  if (!word) return false;
  if (*word != "worse" && *word != "changed") {
    problems.add(field.node->place, field.path,
                 fmt::format("{} is not a kind of failure", yaml::in_quotes(*word)), "worse or changed");
  }
  return *word == "changed";
}

/// Reads a margin from YAML: a map, or a number, which is the absolute margin. Null if it is invalid; the
/// problem is then added to `problems`.
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
  const auto size_of = [&](double& part) {
    return [&](const yaml::Field& value) {
      part = yaml::read_real(value, numerics::at_least(0.0), problems).value_or(0.0);
      sized = true;
    };
  };
  read_keys(field,
            {{"absolute", size_of(margin.absolute)},
             {"relative", size_of(margin.relative)},
             {"fail_on",
              [&](const yaml::Field& value) { margin.changed_fails = read_changed_fails(value, problems); }}},
            problems);
  if (!sized)
    problems.add(field.node->place, field.path, "the margin has no size", "absolute or relative, or both");
  return margin;
}

void read_margin_of(const yaml::Field& map, const yaml::YamlEntry& entry,
                    std::map<std::string, GateMargin>& margins, yaml::Problems& problems) {
  const std::optional<GateMeasure> measure = find_gate_measure(entry.key);
  const yaml::Field field = yaml::entry_of(map, entry);
  if (const std::string_view meanings = trial::meanings_of_settling_time(entry.key); !meanings.empty())
    return problems.add(entry.place, field.path, "settling_time may mean two measures", meanings);
  if (!measure) return parameters::add_unknown_key(map, entry, names_of(all_gate_measures()), problems);
  const std::optional<GateMargin> margin = read_margin(field, problems);
  if (!margin) return;
  if (measure->proportion() && (margin->absolute >= 1.0 || margin->relative >= 1.0))
    return problems.add(field.node->place, field.path, "no proportion of trials can be worse by so much",
                        "less than 1, such as 0.02 for two percent points");
  margins[entry.key] = *margin;
}

const char* const requirement_form = "a text such as 'success_rate ≥ 0.995' (or >=, ≤, <=), or goal";

/// The parts (name, sign, limit) of a requirement such as "success_rate ≥ 0.995"; for "goal" only the name.
/// Empty if the text is neither.
std::optional<text::Comparison> parts_of(std::string_view text) {
  const std::string_view name = text::trimmed(text);
  if (name == "goal") return text::Comparison{name, {}, {}, {}};
  const std::optional<text::Comparison> parts = text::parse_comparison(text);
  constexpr std::string_view characters = "abcdefghijklmnopqrstuvwxyz_.0123456789[]+-";
  const bool complete =
      parts && !parts->name.empty() && !parts->limit.empty() &&
      parts->name.find_first_not_of(characters) == std::string_view::npos &&
      parts->limit.find_first_of(" \t\n\v\f\r") == std::string_view::npos &&
      (parts->relation == text::Relation::at_least || parts->relation == text::Relation::at_most);
  return complete ? parts : std::nullopt;
}

std::optional<Requirement> read_requirement(const yaml::Field& field, yaml::Problems& problems) {
  const std::optional<std::string> text = yaml::read_text(field, problems);
  if (!text) return std::nullopt;
  constexpr std::size_t max_length = 200;  // bytes; no requirement is so long
  const std::optional<text::Comparison> parts = text->size() <= max_length ? parts_of(*text) : std::nullopt;
  Requirement requirement{.text = *text};
  const auto refuse = [&](const std::string& what, const std::string& expected) {
    problems.add(field.node->place, field.path, what, expected);
    return std::nullopt;
  };
  if (!parts) return refuse(fmt::format("{} cannot be understood", yaml::in_quotes(*text)), requirement_form);
  const std::optional<RequirableQuantity> quantity = find_requirable(parts->name);
  if (quantity) requirement.quantity = *quantity;
  if (quantity && quantity->kind == RequirementKind::goal) {
    if (!parts->written.empty())
      return refuse("a goal with a limit", "goal by itself: its limits stand in the manifest");
    return requirement;
  }
  const std::optional<text::Limit> limit = text::limit_of(*parts);
  if (const std::string_view meanings = trial::meanings_of_settling_time(parts->name); !meanings.empty())
    return refuse(fmt::format("{} may mean two measures", yaml::in_quotes(parts->name)),
                  std::string(meanings));
  if (!quantity) {
    return refuse(fmt::format("{} cannot be required", yaml::in_quotes(parts->name)),
                  fmt::format("one of {}", fmt::join(names_of(requirable_quantities()), ", ")));
  }
  if (!limit)
    return refuse(fmt::format("{} is not a number", yaml::in_quotes(parts->limit)), requirement_form);
  requirement.limit = *limit;
  const bool proportion = quantity->kind == RequirementKind::proportion;
  if (proportion && (limit->value < 0.0 || limit->value > 1.0)) {
    return refuse(fmt::format("{} is not a proportion", parts->limit), "a number from 0 to 1");
  }
  if (!proportion && text::is_lower_limit(limit->relation)) {
    return refuse(fmt::format("{} cannot have a lower limit", quantity->name), "≤ and a limit");
  }
  return requirement;
}

/// Reads one requirement, or a list of requirements, and appends them. Mistakes are added to `problems`.
void read_requirements(const yaml::Field& field, std::vector<Requirement>& requirements,
                       yaml::Problems& problems) {
  const auto add = [&](const yaml::Field& one) {
    if (auto requirement = read_requirement(one, problems)) requirements.push_back(*std::move(requirement));
  };
  if (field.node->kind != yaml::YamlNode::Kind::list) return add(field);
  for (std::size_t i = 0; i < field.node->items.size(); ++i) add(yaml::item_of(field, i));
}

/// Reads a map {name of a measure: margin} into `rules`.
/// @param is_own whether the map is for a single design point; it may then contain `require`
void read_point(const yaml::Field& field, bool is_own, PointRules& rules, yaml::Problems& problems) {
  const char* const expected =
      is_own ? "a map from measures to margins, and require" : "a map from measures to margins";
  if (!yaml::check_map(field, expected, problems)) return;
  for (const yaml::YamlEntry& entry : field.node->entries) {
    if (is_own && entry.key == "require")
      read_requirements(yaml::entry_of(field, entry), rules.requirements, problems);
    else
      read_margin_of(field, entry, rules.margins, problems);
  }
}

void read_points(const yaml::Field& field, std::span<const std::string> labels, GateRules& rules,
                 yaml::Problems& problems) {
  if (!yaml::check_map(field, "a map from labels of design points to margins and requirements", problems))
    return;
  for (const yaml::YamlEntry& entry : field.node->entries) {
    const yaml::Field point = yaml::entry_of(field, entry);
    if (const auto named = study::point_named(entry.key, labels)) {
      read_point(point, true, rules.points[labels[static_cast<std::size_t>(*named)]], problems);
      continue;
    }
    const std::string nearest = yaml::in_quotes(yaml::nearest_name(entry.key, labels));
    problems.add(entry.place, point.path, "no design point of the files has this label",
                 fmt::format("one of theirs, such as {}", nearest));
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
    const std::string_view meanings = trial::meanings_of_settling_time(*name);
    if (!meanings.empty()) {
      problems.add(item.node->place, item.path, "settling_time may mean two measures", meanings);
    } else if (!find_gate_measure(*name)) {
      problems.add(item.node->place, item.path,
                   fmt::format("unknown measure {}, nearest known: {}", yaml::in_quotes(*name),
                               yaml::nearest_name(*name, known)),
                   expected);
    }
    measures.push_back(*name);
  }
}

/// The top-level keys of the file of margins and requirements.
/// @param labels labels of the compared design points, which the file may name
std::vector<Key> keys_of(GateRules& rules, std::span<const std::string> labels, yaml::Problems& problems) {
  using yaml::Field;
  const auto number = [&](double& to, double low, double high) {
    return [&, low, high](const Field& field) {
      to = yaml::read_real(field, numerics::closed(low, high), problems).value_or(to);
    };
  };
  return {{"confidence", number(rules.confidence, 0.5, 0.999999)},
          {"false_discovery_rate", number(rules.false_discovery_rate, 1e-6, 0.5)},
          {"fail_on", [&](const Field& field) { rules.changed_fails = read_changed_fails(field, problems); }},
          {"measures", [&](const Field& field) { read_measures(field, rules.measures, problems); }},
          {"margins", [&](const Field& field) { read_point(field, false, rules, problems); }},
          {"require", [&](const Field& field) { read_requirements(field, rules.requirements, problems); }},
          {"points", [&, labels](const Field& field) { read_points(field, labels, rules, problems); }}};
}

}  // namespace

std::vector<GateMeasure> gate_measures(const layout::MeasureTable& measures) {
  std::vector<GateMeasure> gated;
  for (const bool proportion : {true, false}) {
    for (const layout::Measure& measure : measures) {
      if (!measure.gate || layout::is_quality(measure) != proportion) continue;
      gated.push_back({&measure,
                       measure.gate->name,
                       measure.field.column.unit,
                       {measure.gate->absolute, measure.gate->relative, false},
                       proportion ? GateStatistic::trials : GateStatistic::mean,
                       measure.gate->worse});
    }
  }
  return gated;
}

std::vector<GateMeasure> goal_measures() {
  using enum GateStatistic;
  constexpr double few_points = 0.01;  // of a proportion
  return {{nullptr, "goal_rate", "1", {.absolute = few_points}, moves, layout::Worse::less},
          {nullptr, "goal_machines", "1", {.absolute = few_points}, machines, layout::Worse::less},
          {nullptr, "goal_settling_time", "s", {.absolute = 1e-5, .relative = 0.05}, quantile}};
}

std::vector<GateMeasure> all_gate_measures() {
  std::vector<GateMeasure> all = goal_measures();
  const std::vector<GateMeasure> others = gate_measures();
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

std::string name_of_goal_measure(std::string_view measure, std::string_view goal) {
  return goal.empty() ? std::string(measure) : fmt::format("{}[{}]", measure, goal);
}

std::string_view without_goal(std::string_view measure) {
  return measure.starts_with("goal_") && measure.ends_with(']') ? measure.substr(0, measure.find('['))
                                                                : measure;
}

std::optional<GateMeasure> find_gate_measure(std::string_view name) {
  const std::vector<GateMeasure> all = all_gate_measures();
  const auto found = find_named(all, without_goal(name));
  return found == all.end() ? std::nullopt : std::optional(*found);
}

std::vector<RequirableQuantity> requirable_quantities() {
  std::vector<RequirableQuantity> quantities;
  for (const GateMeasure& measure : gate_measures())
    add_quantities(quantities, std::string(measure.name), measure);
  add_limit_quantities(quantities, layout::measure_table());
  quantities.push_back({.name = "goal", .unit = "1", .kind = RequirementKind::goal});
  return quantities;
}

std::optional<RequirableQuantity> find_requirable(std::string_view name) {
  std::vector<RequirableQuantity> quantities = requirable_quantities();
  if (const std::optional<study::StudyFeatures> features = features_with_limit(name))
    add_limit_quantities(quantities, layout::measure_table(*features));
  const auto found = find_named(quantities, name_in_files(name));
  return found == quantities.end() ? std::nullopt : std::optional(*found);
}

bool requires_goal(const GateRules& rules) {
  return std::ranges::any_of(all_requirements(rules), [](const Requirement* one) {
    return one->quantity.kind == RequirementKind::goal;
  });
}

std::vector<GateMeasure> measures_of_limits(const GateRules& rules) {
  std::vector<GateMeasure> measures;
  for (const Requirement* one : all_requirements(rules)) {
    const GateMeasure& measure = one->quantity.measure;
    if (measure.measure != nullptr && (measure.measure->band || measure.measure->tolerance) &&
        find_named(measures, measure.name) == measures.end())
      measures.push_back(measure);
  }
  return measures;
}

std::vector<GateMeasure> judged_measures(const GateRules& rules, const layout::MeasureTable& table,
                                         const std::vector<study::Goal>& goals) {
  std::vector<GateMeasure> judged;
  for (std::size_t goal = 0; goal < goals.size(); ++goal) {
    for (GateMeasure& measure : goal_measures()) {
      if (measure.statistic == GateStatistic::machines && !goals[goal].machines) continue;
      measure.name = name_of_goal_measure(measure.name, goals[goal].name);
      measure.goal = goal;
      judged.push_back(std::move(measure));
    }
  }
  const std::vector<GateMeasure> others = gate_measures(table);
  judged.insert(judged.end(), others.begin(), others.end());
  std::erase_if(judged, [&](const GateMeasure& measure) {
    if (!rules.measures.empty()) return !is_listed(rules, measure.name);
    return !goals.empty() && !measure.of_goal() && !has_margin(rules, measure.name);
  });
  return judged;
}

bool names_goal_measure(const GateRules& rules) {
  return std::ranges::any_of(named_measures(rules), [](const std::string& name) {
    const std::optional<GateMeasure> measure = find_gate_measure(name);
    return measure && measure->of_goal();
  });
}

void require_named_goals(const GateRules& rules, std::span<const std::string> goals, std::string_view path) {
  for (const std::string& measure : named_measures(rules)) {
    if (without_goal(measure) == measure) continue;
    const bool is_judged = std::ranges::any_of(goals, [&](const std::string& goal) {
      return name_of_goal_measure(without_goal(measure), goal) == measure;
    });
    if (is_judged) continue;
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: it has no goal for the margin of '{}'; expected one of its goals: {}",
                              path, measure, fmt::join(goals, ", ")));
  }
}

bool judges_by_goal(const GateRules& rules) {
  return rules.measures.empty() || names_goal_measure(rules);
}

GateMargin margin_of(const GateRules& rules, const std::string& label, const GateMeasure& measure) {
  if (const auto point = rules.points.find(label); point != rules.points.end()) {
    if (const GateMargin* own = margin_in(point->second.margins, measure.name)) return *own;
  }
  const GateMargin* const general = margin_in(rules.margins, measure.name);
  return general == nullptr ? measure.margin : *general;
}

GateRules expanded(GateRules rules, const std::multimap<std::string, std::string>& others,
                   std::span<const std::string> goals) {
  rules.requirements = for_each_goal(rules.requirements, goals);
  for (auto& [label, own] : rules.points) own.requirements = for_each_goal(own.requirements, goals);
  for (const auto& [label, other] : others) {
    if (const auto own = rules.points.find(label); own != rules.points.end() && label != other)
      rules.points[other] = own->second;
  }
  return rules;
}

std::vector<Requirement> requirements_of(const GateRules& rules, const std::string& label) {
  std::vector<Requirement> all = rules.requirements;
  if (const auto own = rules.points.find(label); own != rules.points.end())
    all.insert(all.end(), own->second.requirements.begin(), own->second.requirements.end());
  return all;
}

GateRules parse_gate_rules(const std::string& text, std::string_view source,
                           std::span<const std::string> labels) {
  yaml::Problems problems;
  GateRules rules;
  const std::vector<Key> keys = keys_of(rules, labels, problems);
  const std::string expected = fmt::format("a map with some of {}", fmt::join(names_of(keys), ", "));
  if (text.size() > yaml::max_manifest_size) {
    problems.add({source, 1, 1}, "margins", "the file is too large",
                 fmt::format("at most {} bytes", yaml::max_manifest_size));
    problems.raise_if_any();
  }
  const yaml::YamlPointer root = yaml::parse_yaml(text, source, false, problems);
  if (!root && problems.empty()) problems.add({source, 1, 1}, "margins", "the file is empty", expected);
  const yaml::Field top{root.get(), ""};
  if (root && yaml::check_map(top, expected, problems)) read_keys(top, keys, problems);
  problems.raise_if_any();
  return rules;
}

GateRules read_gate_rules(const std::filesystem::path& path, std::span<const std::string> labels) {
  return parse_gate_rules(yaml::read_text(path, yaml::max_manifest_size, "margins in YAML"),
                          yaml::name_of_text(path), labels);
}

}  // namespace zerocount::comparison
