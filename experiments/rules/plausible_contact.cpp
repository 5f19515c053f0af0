#include <fmt/format.h>

#include "core/friction/law.hpp"
#include "experiments/rules/plausibility.hpp"

namespace zerocount::rules {
namespace {

using Limits = std::span<const study::ValueLimits>;
using Faults = std::vector<ValueFault>;

// At breakaway the spring is stretched by up to breakaway/k1, and has softened over a travel of 1/β.
constexpr double least_softening = 0.1;
constexpr double least_counts = 5.0;

bool has_spring(const study::ValueLimits& model) {
  return friction::has_spring(static_cast<friction::FrictionModel>(static_cast<int>(model.low)));
}

ValueRule softening(const std::string& unit, const std::string& micro_unit) {
  return plausibility_rule(
      {"friction.beta", "friction.breakaway", "friction.k1", "friction.k2", "friction.model"},
      [unit, micro_unit](Limits l) -> Faults {
        const double softening = l[0].typical * l[1].typical / l[2].typical;
        if (!has_spring(l[4]) || l[3].typical == 0.0 || softening >= least_softening) return {};
        return {{fmt::format("the spring slides before it softens from k1 + k2 to k1: beta·breakaway/k1 is "
                             "{:.3g}, with beta {:.4g} {}",
                             softening, l[0].typical, unit),
                 fmt::format("well above 1; {:.4g} {} are {:.4g} {}", l[0].typical, micro_unit,
                             1e6 * l[0].typical, unit)}};
      });
}

ValueRule counts_before_sliding(const study::StudyPlan& plan) {
  return plausibility_rule(
      {"friction.breakaway", "friction.k1", fine_encoder_name(plan), "friction.model"},
      [&plan, unit = parameters::unit_on(plan.units.axis, "N m")](Limits l) -> Faults {
        const double torque_of_count = l[1].typical * typical_count(plan, l[2].typical);
        const double counts = l[0].typical / torque_of_count;
        if (!has_spring(l[3]) || counts >= least_counts) return {};
        return {
            {fmt::format("the spring yields by at most {:.3g} counts before it slides: breakaway is {:.4g} "
                         "{}, and k1·Δx {:.4g} {}",
                         counts, l[0].typical, unit, torque_of_count, unit),
             fmt::format("at least {} counts; is a power of ten wrong, or a unit?", least_counts)}};
      });
}

}  // namespace

std::vector<ValueRule> plausible_contact(const study::StudyPlan& plan) {
  const bool linear = plan.units.axis == parameters::AxisKind::linear;
  return {softening(linear ? "1/m" : "1/rad", linear ? "1/µm" : "1/µrad"), counts_before_sliding(plan)};
}

}  // namespace zerocount::rules
