#include "analysis/comparison/gate_rules.hpp"

#include <algorithm>
#include <array>

namespace zerocount {
namespace {

template <class Named>
const Named* find_named(std::span<const Named> all, std::string_view name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

std::span<const GateMeasure> gate_measures() {
  static constexpr std::array<GateMeasure, 5> measures{{
      {GateQuantity::success,
       "success_rate",
       "1",
       "proportion of trials all of whose moves ended in zero counts",
       true,
       {0.02, 0.0, false}},
      {GateQuantity::arrival,
       "arrival_rate",
       "1",
       "proportion of trials all of whose moves arrived",
       true,
       {0.02, 0.0, false}},
      {GateQuantity::stability,
       "stable_rate",
       "1",
       "proportion of trials all of whose moves were stable",
       true,
       {0.02, 0.0, false}},
      {GateQuantity::settling_time,
       "settling_time",
       "s",
       "mean settling time of a trial: of the moves that arrived, where trials are paired in both files",
       false,
       {0.0005, 0.05, false}},
      {GateQuantity::jerk_count,
       "jerk_count",
       "1",
       "mean number of jerks of a trial, over all its moves",
       false,
       {0.05, 0.1, false}},
  }};
  return measures;
}

const GateMeasure* find_gate_measure(std::string_view name) {
  return find_named(gate_measures(), name);
}

std::span<const RequirableQuantity> requirable_quantities() {
  static constexpr std::array<RequirableQuantity, 7> quantities{{
      {"success_rate", "1", RequirementKind::proportion, GateQuantity::success, 0.0},
      {"arrival_rate", "1", RequirementKind::proportion, GateQuantity::arrival, 0.0},
      {"stable_rate", "1", RequirementKind::proportion, GateQuantity::stability, 0.0},
      {"settling_time.median", "s", RequirementKind::quantile, GateQuantity::settling_time, 0.5},
      {"settling_time.p95", "s", RequirementKind::quantile, GateQuantity::settling_time, 0.95},
      {"settling_time.p99", "s", RequirementKind::quantile, GateQuantity::settling_time, 0.99},
      {"jerk_count", "1", RequirementKind::mean, GateQuantity::jerk_count, 0.0},
  }};
  return quantities;
}

const RequirableQuantity* find_requirable(std::string_view name) {
  return find_named(requirable_quantities(), name);
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

}  // namespace zerocount
