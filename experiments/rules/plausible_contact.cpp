#include <algorithm>

#include <fmt/format.h>

#include "core/friction/law.hpp"
#include "core/friction/presliding/spring.hpp"
#include "experiments/rules/plausibility.hpp"

namespace zerocount::rules {
namespace {

using Limits = std::span<const study::ValueLimits>;
using Faults = std::vector<ValueFault>;

// The spring softens over a travel of 1/β.
constexpr double min_softening = 0.1;
constexpr double min_counts = 5.0;

bool has_spring(const study::ValueLimits& model) {
  return friction::has_spring(static_cast<friction::FrictionModel>(static_cast<int>(model.low)));
}

/// Of typical values, rad or m.
double range_of(const study::ValueLimits& k1, const study::ValueLimits& k2, const study::ValueLimits& beta,
                const study::ValueLimits& breakaway) {
  friction::FrictionParameters contact;
  contact.k1 = k1.typical;
  contact.k2 = k2.typical;
  contact.beta = beta.typical;
  contact.breakaway = breakaway.typical;
  return friction::presliding_range(contact);
}

/// Of the spring by what one measures.
constexpr double max_initial_ratio = 1e4;

bool is_measured(const study::StudyPlan& plan) {
  return std::ranges::any_of(plan.measured, [](const study::MeasuredSlots& measured) {
    return measured.group->section == "friction.measured";
  });
}

ValueRule initial_stiffness(const study::StudyPlan& plan) {
  return plausibility_rule(
      {"friction.k2", "friction.k1", "friction.beta", "friction.breakaway", "friction.model"},
      [unit = parameters::unit_on(plan.units.axis, "N m/rad")](Limits l) -> Faults {
        const double initial = l[1].typical + l[0].typical;
        const double mean = l[3].typical / range_of(l[1], l[0], l[2], l[3]);
        if (!has_spring(l[4]) || initial <= max_initial_ratio * mean) return {};
        return {
            {fmt::format("the spring begins with {:.4g} {}, {:.3g} times breakaway over travel, {:.4g} {}",
                         initial, unit, initial / mean, mean, unit),
             fmt::format("at most {:g} times; is a power of ten wrong, or a unit?", max_initial_ratio)}};
      });
}

ValueRule softening_of_measured() {
  return plausibility_rule(
      {"friction.beta", "friction.breakaway", "friction.k1", "friction.k2", "friction.model"},
      [](Limits l) -> Faults {
        const double softening = l[0].typical * range_of(l[2], l[3], l[0], l[1]);
        if (!has_spring(l[4]) || softening >= min_softening) return {};
        return {{fmt::format("the spring slides before it softens: its initial stiffness is {:.4g} times "
                             "breakaway over travel",
                             (l[2].typical + l[3].typical) * range_of(l[2], l[3], l[0], l[1]) / l[1].typical),
                 "a softer final stiffness, or a stiffer initial one"}};
      });
}

ValueRule softening(const std::string& unit, const std::string& micro_unit) {
  return plausibility_rule(
      {"friction.beta", "friction.breakaway", "friction.k1", "friction.k2", "friction.model"},
      [unit, micro_unit](Limits l) -> Faults {
        const double softening = l[0].typical * range_of(l[2], l[3], l[0], l[1]);
        if (!has_spring(l[4]) || l[3].typical == 0.0 || softening >= min_softening) return {};
        return {{fmt::format("the spring slides before it softens from k1 + k2 to k1: beta times the "
                             "pre-sliding range is {:.3g}, with beta {:.4g} {}",
                             softening, l[0].typical, unit),
                 fmt::format("well above 1; {:.4g} {} are {:.4g} {}", l[0].typical, micro_unit,
                             1e6 * l[0].typical, unit)}};
      });
}

ValueRule counts_before_sliding(const study::StudyPlan& plan) {
  return plausibility_rule(
      {"friction.breakaway", "friction.k1", "friction.k2", "friction.beta", fine_encoder_name(plan),
       "friction.model"},
      [&plan, torque = parameters::unit_on(plan.units.axis, "N m"),
       length = parameters::unit_on(plan.units.axis, "rad")](Limits l) -> Faults {
        const double range = range_of(l[1], l[2], l[3], l[0]);
        const double count = typical_count(plan, l[4].typical);
        if (!has_spring(l[5]) || range / count >= min_counts) return {};
        return {{fmt::format("the spring yields by {:.3g} counts before it slides: it reaches the breakaway "
                             "of {:.4g} {} after {:.3g} {}, and a count is {:.3g} {}",
                             range / count, l[0].typical, torque, range, length, count, length),
                 fmt::format("at least {} counts; is a power of ten wrong, or a unit?", min_counts)}};
      });
}

}  // namespace

std::vector<ValueRule> plausible_contact(const study::StudyPlan& plan) {
  if (is_measured(plan))
    return {softening_of_measured(), initial_stiffness(plan), counts_before_sliding(plan)};
  const bool linear = plan.units.axis == parameters::AxisKind::linear;
  return {softening(linear ? "1/m" : "1/rad", linear ? "1/µm" : "1/µrad"), counts_before_sliding(plan)};
}

}  // namespace zerocount::rules
