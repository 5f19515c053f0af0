#include "analysis/comparison/gate_rules.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/failure/failure.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::comparison {
namespace {

template <class List>
auto find_named(const List& all, std::string_view name) {
  return std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
}

/// The quantities of a measure. @param stem its name, before that of a quantile
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

/// The quantities of the error bands and tolerances of the table.
void add_limit_quantities(std::vector<RequirableQuantity>& quantities, const layout::MeasureTable& measures) {
  for (const layout::Measure& measure : measures) {
    if (!measure.band && !measure.tolerance) continue;
    const layout::Column& column = measure.field.column;
    add_quantities(quantities, column.name, {&measure, column.name, column.unit, {}});
  }
}

/// The number in "band_settling_time[5].p95"; nothing where there is none.
template <class Number>
std::optional<Number> number_in(std::string_view name) {
  const std::size_t open = name.find('[');
  const std::size_t close = name.find(']');
  if (open >= close || close == std::string_view::npos) return std::nullopt;
  Number number{};
  const auto [end, error] = std::from_chars(name.data() + open + 1, name.data() + close, number);
  return error == std::errc{} && end == name.data() + close && number >= Number{} ? std::optional(number)
                                                                                  : std::nullopt;
}

/// The features of a study that has the error band, or the tolerance, in "band_settling_time[5].p95" or
/// "tolerance_settling_time[1e-8].p95"; nothing for other names.
std::optional<study::StudyFeatures> features_with_limit(std::string_view name) {
  study::StudyFeatures features;
  if (const auto band = number_in<std::int64_t>(name); band && name.starts_with("band_")) {
    features.bands = {.limits = {*band}, .count = 1};
    return features;
  }
  const auto tolerance = number_in<double>(name);
  if (!tolerance || !std::isfinite(*tolerance) || *tolerance == 0.0 || !name.starts_with("tolerance_"))
    return std::nullopt;
  features.tolerances = {.limits = {*tolerance}, .count = 1};
  return features;
}

/// The name as files have it: a tolerance can be written in several ways.
std::string name_in_files(std::string_view name) {
  const auto tolerance = number_in<double>(name);
  if (!tolerance || !name.starts_with("tolerance_")) return std::string(name);
  return layout::name_of_tolerance(name.substr(0, name.find('[')), *tolerance) +
         std::string(name.substr(name.find(']') + 1));
}

/// The names that the rules may call a measure by, the most special one first.
std::vector<std::string> names_in_rules(const std::string& measure) {
  std::vector<std::string> names{measure};
  if (const std::string_view whole = without_goal(measure); whole != measure) names.emplace_back(whole);
  return names;
}

/// The names of all measures that the rules name, in the list of measures or with a margin.
std::vector<std::string> named_measures(const GateRules& rules) {
  std::vector<std::string> names = rules.measures;
  const auto add = [&](const std::map<std::string, GateMargin>& margins) {
    for (const auto& [name, margin] : margins) names.push_back(name);
  };
  add(rules.margins);
  for (const auto& [label, margins] : rules.margins_at) add(margins);
  return names;
}

/// Whether the rules list the measure, by one of its names.
bool is_listed(const GateRules& rules, const std::string& measure) {
  return std::ranges::any_of(names_in_rules(measure), [&](const std::string& name) {
    return std::ranges::find(rules.measures, name) != rules.measures.end();
  });
}

/// Whether the rules give the measure a margin, at every point or at some.
bool has_margin(const GateRules& rules, const std::string& name) {
  return rules.margins.contains(name) || std::ranges::any_of(rules.margins_at, [&](const auto& point) {
           return point.second.contains(name);
         });
}

const GateMargin* margin_in(const std::map<std::string, GateMargin>& margins, const std::string& measure) {
  for (const std::string& name : names_in_rules(measure)) {
    if (const auto found = margins.find(name); found != margins.end()) return &found->second;
  }
  return nullptr;
}

/// The requirement `goal` as one for each goal.
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

std::vector<const Requirement*> all_requirements(const GateRules& rules) {
  std::vector<const Requirement*> all;
  for (const Requirement& one : rules.requirements) all.push_back(&one);
  for (const auto& [label, own] : rules.requirements_at) {
    for (const Requirement& one : own) all.push_back(&one);
  }
  return all;
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
                                         const std::vector<JudgedGoal>& goals) {
  std::vector<GateMeasure> judged;
  for (std::size_t goal = 0; goal < goals.size(); ++goal) {
    for (GateMeasure& measure : goal_measures()) {
      if (measure.statistic == GateStatistic::machines && !goals[goal].of_machines) continue;
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
  if (const auto point = rules.margins_at.find(label); point != rules.margins_at.end()) {
    if (const GateMargin* own = margin_in(point->second, measure.name)) return *own;
  }
  const GateMargin* const general = margin_in(rules.margins, measure.name);
  return general == nullptr ? measure.margin : *general;
}

GateRules expanded(GateRules rules, const std::multimap<std::string, std::string>& others,
                   std::span<const std::string> goals) {
  rules.requirements = for_each_goal(rules.requirements, goals);
  for (auto& [label, own] : rules.requirements_at) own = for_each_goal(own, goals);
  for (const auto& [label, other] : others) {
    if (label == other) continue;
    if (const auto own = rules.margins_at.find(label); own != rules.margins_at.end())
      rules.margins_at[other] = own->second;
    if (const auto own = rules.requirements_at.find(label); own != rules.requirements_at.end())
      rules.requirements_at[other] = own->second;
  }
  return rules;
}

std::vector<Requirement> requirements_of(const GateRules& rules, const std::string& label) {
  std::vector<Requirement> all = rules.requirements;
  if (const auto own = rules.requirements_at.find(label); own != rules.requirements_at.end()) {
    all.insert(all.end(), own->second.begin(), own->second.end());
  }
  return all;
}

}  // namespace zerocount::comparison
