#include <algorithm>

#include <fmt/format.h>

#include "core/friction/law.hpp"
#include "core/friction/presliding/spring.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/rules/value_rules.hpp"

namespace zerocount::rules {
namespace {

using Faults = std::vector<ValueFault>;

// The spring softens over a travel of 1/β.
constexpr double min_softening = 0.1;
constexpr double min_counts = 5.0;

bool has_spring(const study::ParameterRange& model) {
  return friction::has_spring(static_cast<friction::FrictionModel>(static_cast<int>(model.low)));
}

/// The pre-sliding range of a friction contact (travel until it slides) with the typical values of its
/// parameters, rad or m.
double range_of(const study::ParameterRange& k1, const study::ParameterRange& k2,
                const study::ParameterRange& beta, const study::ParameterRange& breakaway) {
  friction::FrictionParameters contact;
  contact.k1 = k1.typical;
  contact.k2 = k2.typical;
  contact.beta = beta.typical;
  contact.breakaway = breakaway.typical;
  return friction::presliding_range(contact);
}

/// Largest plausible ratio of the spring's initial stiffness k1 + k2 to its mean stiffness, breakaway over
/// travel.
constexpr double max_initial_ratio = 1e4;

bool is_measured(const study::StudyPlan& plan) {
  return std::ranges::any_of(plan.measured, [](const study::MeasuredSlots& measured) {
    return measured.group->section == "friction.measured";
  });
}

ValueRule initial_stiffness(const study::StudyPlan& plan) {
  return plausible(
      {parameter::friction::k2, parameter::friction::k1, parameter::friction::beta,
       parameter::friction::breakaway, parameter::friction::model},
      [unit = parameters::unit_on(plan.units.axis, "N m/rad")](const Ranges& of) -> Faults {
        const study::ParameterRange& k2 = of[parameter::friction::k2];
        const study::ParameterRange& k1 = of[parameter::friction::k1];
        const study::ParameterRange& beta = of[parameter::friction::beta];
        const study::ParameterRange& breakaway = of[parameter::friction::breakaway];
        const study::ParameterRange& model = of[parameter::friction::model];
        const double initial = k1.typical + k2.typical;
        const double mean = breakaway.typical / range_of(k1, k2, beta, breakaway);
        if (!has_spring(model) || initial <= max_initial_ratio * mean) return {};
        return {
            {fmt::format("the spring begins with {:.4g} {}, {:.3g} times breakaway over travel, {:.4g} {}",
                         initial, unit, initial / mean, mean, unit),
             fmt::format("at most {:g} times; is a power of ten wrong, or a unit?", max_initial_ratio)}};
      });
}

ValueRule softening_of_measured() {
  return plausible(
      {parameter::friction::beta, parameter::friction::breakaway, parameter::friction::k1,
       parameter::friction::k2, parameter::friction::model},
      [](const Ranges& of) -> Faults {
        const study::ParameterRange& beta = of[parameter::friction::beta];
        const study::ParameterRange& breakaway = of[parameter::friction::breakaway];
        const study::ParameterRange& k1 = of[parameter::friction::k1];
        const study::ParameterRange& k2 = of[parameter::friction::k2];
        const study::ParameterRange& model = of[parameter::friction::model];
        const double softening = beta.typical * range_of(k1, k2, beta, breakaway);
        if (!has_spring(model) || softening >= min_softening) return {};
        return {
            {fmt::format("the spring slides before it softens: its initial stiffness is {:.4g} times "
                         "breakaway over travel",
                         (k1.typical + k2.typical) * range_of(k1, k2, beta, breakaway) / breakaway.typical),
             "a softer final stiffness, or a stiffer initial one"}};
      });
}

ValueRule softening(const std::string& unit, const std::string& micro_unit) {
  return plausible(
      {parameter::friction::beta, parameter::friction::breakaway, parameter::friction::k1,
       parameter::friction::k2, parameter::friction::model},
      [unit, micro_unit](const Ranges& of) -> Faults {
        const study::ParameterRange& beta = of[parameter::friction::beta];
        const study::ParameterRange& breakaway = of[parameter::friction::breakaway];
        const study::ParameterRange& k1 = of[parameter::friction::k1];
        const study::ParameterRange& k2 = of[parameter::friction::k2];
        const study::ParameterRange& model = of[parameter::friction::model];
        const double softening = beta.typical * range_of(k1, k2, beta, breakaway);
        if (!has_spring(model) || k2.typical == 0.0 || softening >= min_softening) return {};
        return {{fmt::format("the spring slides before it softens from k1 + k2 to k1: beta times the "
                             "pre-sliding range is {:.3g}, with beta {:.4g} {}",
                             softening, beta.typical, unit),
                 fmt::format("well above 1; {:.4g} {} are {:.4g} {}", beta.typical, micro_unit,
                             1e6 * beta.typical, unit)}};
      });
}

ValueRule counts_before_sliding(const study::StudyPlan& plan) {
  const parameter::Handle of_encoder = fine_encoder(plan);
  return plausible(
      {parameter::friction::breakaway, parameter::friction::k1, parameter::friction::k2,
       parameter::friction::beta, of_encoder, parameter::friction::model},
      [&plan, of_encoder, torque = parameters::unit_on(plan.units.axis, "N m"),
       length = parameters::unit_on(plan.units.axis, "rad")](const Ranges& of) -> Faults {
        const study::ParameterRange& breakaway = of[parameter::friction::breakaway];
        const study::ParameterRange& k1 = of[parameter::friction::k1];
        const study::ParameterRange& k2 = of[parameter::friction::k2];
        const study::ParameterRange& beta = of[parameter::friction::beta];
        const study::ParameterRange& encoder = of[of_encoder];
        const study::ParameterRange& model = of[parameter::friction::model];
        const double range = range_of(k1, k2, beta, breakaway);
        const double count = typical_count(plan, encoder.typical);
        if (!has_spring(model) || range / count >= min_counts) return {};
        return {{fmt::format("the spring yields by {:.3g} counts before it slides: it reaches the breakaway "
                             "of {:.4g} {} after {:.3g} {}, and a count is {:.3g} {}",
                             range / count, breakaway.typical, torque, range, length, count, length),
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
