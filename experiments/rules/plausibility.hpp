#pragma once

#include <vector>

#include "experiments/rules/value_rules.hpp"

namespace zerocount::rules {

// Values that are allowed but absurd, such as an inertia in g m² that stands where kg m² are expected. Each
// test compares a dimensionless number of the typical values of a design point (medians of distributions,
// means of profiles) with a bound that no real axis comes near. All are warnings, reported once.

/// Natural frequency on the spring of the friction: from some Hz to half the sample rate.
std::vector<ValueRule> plausible_dynamics(const study::StudyPlan& plan);

/// Pre-sliding: the spring softens before it slides, and yields by more than a few counts.
std::vector<ValueRule> plausible_contact(const study::StudyPlan& plan);

/// The delay of the loop is not one in seconds, or in microseconds.
std::vector<ValueRule> plausible_delay(const study::StudyPlan& plan);

/// Gains: one count of error is within the range of the converter.
std::vector<ValueRule> plausible_gains(const study::StudyPlan& plan);

/// All of them.
std::vector<ValueRule> plausibility_rules(const study::StudyPlan& plan);

/// A rule that warns once, at the first of `between` that the manifest gives.
ValueRule plausibility_rule(
    std::vector<std::string_view> between,
    std::function<std::vector<ValueFault>(std::span<const study::ValueLimits> parameters)> find_faults);

/// As plausibility_rule, with the limits as arguments of `find_faults`, see rules::between().
template <std::size_t count, class FindFaults>
ValueRule plausible(const std::string_view (&names)[count], FindFaults find_faults) {
  ValueRule rule = warning(between(names, find_faults));
  rule.once = true;
  return rule;
}

/// The parameter with the resolution of the fine encoder.
std::string_view fine_encoder_name(const study::StudyPlan& plan);

/// Δx, rad or m. @param encoder typical value of fine_encoder_name()
double typical_count(const study::StudyPlan& plan, double encoder);

}  // namespace zerocount::rules
