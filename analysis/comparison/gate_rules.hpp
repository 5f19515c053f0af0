#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What a comparison judges, and by how much a measure may change.
namespace zerocount {

/// How much worse a measure may be: the larger of `absolute` and `relative` times the baseline's value.
struct GateMargin {
  double absolute{0.0};   ///< in the measure's unit
  double relative{0.0};   ///< proportion of the baseline's value
  bool both_ways{false};  ///< a change for the better beyond the margin is a failure too
};

enum class GateQuantity { success, arrival, stability, settling_time, jerk_count };

/// One measure that a comparison judges. Of a proportion of trials, less is worse; of a mean, more is.
struct GateMeasure {
  GateQuantity quantity;
  std::string_view name;
  std::string_view unit;
  std::string_view long_name;
  bool proportion;  ///< of trials; otherwise a mean over trials
  GateMargin margin;
};

/// All of them, with their default margins, in the order of the report.
std::span<const GateMeasure> gate_measures();

/// Null where there is none of this name.
const GateMeasure* find_gate_measure(std::string_view name);

enum class RequirementKind {
  proportion,  ///< of trials with the quality of a gate measure
  quantile,    ///< of the settling time
  mean         ///< of the jerks per trial
};

/// What can be required of a file whatever the baseline says.
struct RequirableQuantity {
  std::string_view name;
  std::string_view unit;
  RequirementKind kind;
  GateQuantity quantity;
  double probability;  ///< of a quantile
};

std::span<const RequirableQuantity> requirable_quantities();
const RequirableQuantity* find_requirable(std::string_view name);

/// "success_rate ≥ 0.995".
struct Requirement {
  std::string text;
  const RequirableQuantity* quantity{nullptr};
  bool at_least{true};
  double limit{0.0};
};

struct GateRules {
  double confidence{0.95};            ///< of every bound, one-sided
  double false_discovery_rate{0.05};  ///< over all measures at all points
  std::vector<std::string> measures;  ///< that are judged; empty: all
  std::map<std::string, GateMargin> margins;
  std::vector<Requirement> requirements;                                ///< at every point
  std::map<std::string, std::map<std::string, GateMargin>> margins_at;  ///< [label][measure]
  std::map<std::string, std::vector<Requirement>> requirements_at;  ///< [label], beside those of every point
};

bool is_judged(const GateRules& rules, const GateMeasure& measure);

/// The margin of a measure at a point: the point's own, or that of all points, or the default.
GateMargin margin_of(const GateRules& rules, const std::string& label, const GateMeasure& measure);

/// What holds at a point: the requirements of every point and its own.
std::vector<Requirement> requirements_of(const GateRules& rules, const std::string& label);

}  // namespace zerocount
