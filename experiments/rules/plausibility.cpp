#include <numbers>
#include <utility>

#include "experiments/rules/value_rules.hpp"
#include "experiments/study/point_limits.hpp"

namespace zerocount::rules {

ValueRule plausibility_rule(
    std::vector<std::string_view> between,
    std::function<std::vector<ValueFault>(std::span<const study::ParameterRange>)> find_faults) {
  ValueRule rule{std::move(between), false, {}};
  rule.find_faults = [find = std::move(find_faults)](std::span<const study::ParameterRange> parameters,
                                                     std::span<const study::ParameterRange>) {
    return find(parameters);
  };
  rule.warn_only = true;
  rule.once = true;
  return rule;
}

std::string_view fine_encoder_name(const study::StudyPlan& plan) {
  const bool linear = plan.units.axis == parameters::AxisKind::linear;
  const bool of_load =
      study::holds_somewhere(plan, study::two_encoders, [](std::span<const study::ParameterRange> ranges) {
        return study::has_two_encoders(ranges) && study::closes_at_load(ranges);
      });
  if (of_load) return linear ? "encoder.load.resolution" : "encoder.load.counts_per_revolution";
  return linear ? "encoder.resolution" : "encoder.fine";
}

double typical_count(const study::StudyPlan& plan, double encoder) {
  switch (plan.units.axis) {
    case parameters::AxisKind::rotary:
      break;
    case parameters::AxisKind::linear:
      return encoder;
  }
  return 2.0 * std::numbers::pi / encoder;
}

std::vector<ValueRule> plausibility_rules(const study::StudyPlan& plan) {
  std::vector<ValueRule> rules;
  for (const auto& tests : {plausible_dynamics, plausible_contact, plausible_delay, plausible_gains}) {
    const std::vector<ValueRule> more = tests(plan);
    rules.insert(rules.end(), more.begin(), more.end());
  }
  return rules;
}

}  // namespace zerocount::rules
