#include "analysis/comparison/gate_rules.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/format.h>

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

/// The quantities of the bands of the table.
void add_band_quantities(std::vector<RequirableQuantity>& quantities, const layout::MeasureTable& measures) {
  for (const layout::Measure& measure : measures) {
    if (!measure.band) continue;
    const layout::Column& column = measure.field.column;
    add_quantities(quantities, column.name, {&measure, column.name, column.unit, {}});
  }
}

/// The band in "band_settling_time[5].p95"; nothing for other names.
std::optional<std::int64_t> band_in(std::string_view name) {
  const std::size_t open = name.find('[');
  const std::size_t close = name.find(']');
  if (!name.starts_with("band_") || open >= close || close == std::string_view::npos) return std::nullopt;
  std::int64_t band = 0;
  const auto [end, error] = std::from_chars(name.data() + open + 1, name.data() + close, band);
  return error == std::errc{} && end == name.data() + close && band >= 0 ? std::optional(band) : std::nullopt;
}

bool is_named(const GateRules& rules, std::string_view name) {
  return std::find(rules.measures.begin(), rules.measures.end(), name) != rules.measures.end();
}

/// Whether the rules give the measure a margin, at every point or at some.
bool has_margin(const GateRules& rules, const std::string& name) {
  return rules.margins.contains(name) || std::ranges::any_of(rules.margins_at, [&](const auto& point) {
           return point.second.contains(name);
         });
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

std::optional<GateMeasure> find_gate_measure(std::string_view name) {
  const std::vector<GateMeasure> all = all_gate_measures();
  const auto found = find_named(all, name);
  return found == all.end() ? std::nullopt : std::optional(*found);
}

std::vector<RequirableQuantity> requirable_quantities() {
  std::vector<RequirableQuantity> quantities;
  for (const GateMeasure& measure : gate_measures())
    add_quantities(quantities, std::string(measure.name), measure);
  add_band_quantities(quantities, layout::measure_table());
  quantities.push_back({.name = "goal", .unit = "1", .kind = RequirementKind::goal});
  return quantities;
}

std::optional<RequirableQuantity> find_requirable(std::string_view name) {
  std::vector<RequirableQuantity> quantities = requirable_quantities();
  if (const std::optional<std::int64_t> band = band_in(name))
    add_band_quantities(quantities, layout::measure_table({.bands = {.limits = {*band}, .count = 1}}));
  const auto found = find_named(quantities, name);
  return found == quantities.end() ? std::nullopt : std::optional(*found);
}

bool requires_goal(const GateRules& rules) {
  return std::ranges::any_of(all_requirements(rules), [](const Requirement* one) {
    return one->quantity.kind == RequirementKind::goal;
  });
}

std::vector<GateMeasure> measures_of_bands(const GateRules& rules) {
  std::vector<GateMeasure> measures;
  for (const Requirement* one : all_requirements(rules)) {
    const GateMeasure& measure = one->quantity.measure;
    if (measure.measure != nullptr && measure.measure->band &&
        find_named(measures, measure.name) == measures.end())
      measures.push_back(measure);
  }
  return measures;
}

std::vector<GateMeasure> judged_measures(const GateRules& rules, const layout::MeasureTable& table,
                                         JudgedGoal goal) {
  std::vector<GateMeasure> judged = goal_measures();
  std::erase_if(judged, [&](const GateMeasure& measure) {
    return goal == JudgedGoal::none ||
           (measure.statistic == GateStatistic::machines && goal != JudgedGoal::of_machines);
  });
  const std::vector<GateMeasure> others = gate_measures(table);
  judged.insert(judged.end(), others.begin(), others.end());
  std::erase_if(judged, [&](const GateMeasure& measure) {
    if (!rules.measures.empty()) return !is_named(rules, measure.name);
    return goal != JudgedGoal::none && !measure.of_goal() && !has_margin(rules, std::string(measure.name));
  });
  return judged;
}

bool names_goal_measure(const GateRules& rules) {
  return std::ranges::any_of(goal_measures(), [&](const GateMeasure& measure) {
    return is_named(rules, measure.name) || has_margin(rules, std::string(measure.name));
  });
}

bool judges_by_goal(const GateRules& rules) {
  return rules.measures.empty() || names_goal_measure(rules);
}

GateMargin margin_of(const GateRules& rules, const std::string& label, const GateMeasure& measure) {
  const std::string name(measure.name);
  if (const auto point = rules.margins_at.find(label); point != rules.margins_at.end()) {
    if (const auto own = point->second.find(name); own != point->second.end()) return own->second;
  }
  const auto general = rules.margins.find(name);
  return general == rules.margins.end() ? measure.margin : general->second;
}

std::vector<Requirement> requirements_of(const GateRules& rules, const std::string& label) {
  std::vector<Requirement> all = rules.requirements;
  if (const auto own = rules.requirements_at.find(label); own != rules.requirements_at.end()) {
    all.insert(all.end(), own->second.begin(), own->second.end());
  }
  return all;
}

}  // namespace zerocount::comparison
