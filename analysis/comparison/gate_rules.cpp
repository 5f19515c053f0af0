#include "analysis/comparison/gate_rules.hpp"

#include <algorithm>
#include <utility>

namespace zerocount::comparison {
namespace {

template <class List>
auto find_named(const List& all, std::string_view name) {
  return std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
}

std::vector<RequirableQuantity> all_requirable() {
  std::vector<RequirableQuantity> quantities;
  for (const GateMeasure& measure : gate_measures()) {
    const std::string name(measure.name);
    if (measure.proportion()) {
      quantities.push_back({name, measure.unit, RequirementKind::proportion, measure});
    } else if (measure.measure->of_trial == layout::OfTrial::sum) {
      quantities.push_back({name, measure.unit, RequirementKind::mean, measure});
    } else {
      for (const auto& [quantile, probability] :
           {std::pair(".median", 0.5), std::pair(".p95", 0.95), std::pair(".p99", 0.99)})
        quantities.push_back(
            {name + quantile, measure.unit, RequirementKind::quantile, measure, probability});
    }
  }
  return quantities;
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
                       {measure.gate->absolute, measure.gate->relative, false}});
    }
  }
  return gated;
}

std::optional<GateMeasure> find_gate_measure(std::string_view name) {
  const std::vector<GateMeasure> all = gate_measures();
  const auto found = find_named(all, name);
  return found == all.end() ? std::nullopt : std::optional(*found);
}

std::span<const RequirableQuantity> requirable_quantities() {
  static const std::vector<RequirableQuantity> quantities = all_requirable();
  return quantities;
}

const RequirableQuantity* find_requirable(std::string_view name) {
  const auto found = find_named(requirable_quantities(), name);
  return found == requirable_quantities().end() ? nullptr : &*found;
}

bool is_judged(const GateRules& rules, const GateMeasure& measure) {
  return rules.measures.empty() ||
         std::find(rules.measures.begin(), rules.measures.end(), measure.name) != rules.measures.end();
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
