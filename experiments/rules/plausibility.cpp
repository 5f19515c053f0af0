#include <numbers>
#include <utility>

#include "experiments/parameters/handles.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/point_limits.hpp"

namespace zerocount::rules {

ValueRule plausible(std::vector<parameter::Handle> parameters,
                    std::function<std::vector<ValueFault>(const Ranges& of)> find_faults) {
  ValueRule rule = warning(between(std::move(parameters), std::move(find_faults)));
  rule.once = true;
  return rule;
}

parameter::Handle fine_encoder(const study::StudyPlan& plan) {
  const bool linear = plan.units.axis == parameters::AxisKind::linear;
  const bool of_load = study::holds_somewhere(plan, study::two_encoders, [](const Ranges& of) {
    return study::has_two_encoders(of) && study::closes_at_load(of);
  });
  if (of_load)
    return linear ? parameter::encoder::load::resolution : parameter::encoder::load::counts_per_revolution;
  return linear ? parameter::encoder::resolution : parameter::encoder::fine;
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
