#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/friction/law.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/rules/value_rules.hpp"

namespace zerocount::rules {
namespace {

using Faults = std::vector<ValueFault>;

// That of a positioning axis is tens to hundreds of Hz; of a telescope, which is sampled slowly, below 1 Hz.
constexpr double max_lowest_natural_frequency = 2.0;  // Hz
constexpr double min_of_sample_rate = 1e-3;

constexpr double min_delay = 0.01;  // samples; nobody measures less
constexpr double max_delay = 20.0;  // samples; a loop has some of them

/// Stiffness of the friction contact at rest, and the parameters that it comes from. The value is 0 and the
/// name empty for a law with neither k1 and k2 nor sigma0: coulomb, none and gms.
struct Stiffness {
  double value{0.0};  ///< stiffness at rest, N m/rad
  std::string_view name{};
};

Stiffness stiffness_at_rest(friction::FrictionModel model, double k1, double k2, double sigma0) {
  const friction::LawTraits& law = friction::traits_of(model);
  if (friction::has_spring(model)) return {k1 + k2, "k1 + k2"};
  if (law.bristle != nullptr) return {sigma0, "sigma0"};
  return {};
}

}  // namespace

std::vector<ValueRule> plausible_delay(const study::StudyPlan&) {
  return {plausible(
      {parameter::controller::delay, parameter::controller::sample_rate}, [](const Ranges& of) -> Faults {
        const study::ParameterRange& of_delay = of[parameter::controller::delay];
        const study::ParameterRange& rate = of[parameter::controller::sample_rate];
        const double delay = of_delay.typical;
        if (delay > max_delay)
          return {{fmt::format("a delay of {:.6g} samples is {:.3g} s at {:.6g} Hz", delay,
                               delay / rate.typical, rate.typical),
                   fmt::format("a number of samples, at most {}; {:.6g} µs are {:.6g} samples", max_delay,
                               delay, 1e-6 * delay * rate.typical)}};
        if (delay == 0.0 || delay >= min_delay) return {};
        return {{fmt::format("a delay of {:.6g} samples is {:.3g} s at {:.6g} Hz", delay,
                             delay / rate.typical, rate.typical),
                 fmt::format("a number of samples, 0 or at least {}; {:.6g} s are {:.6g} samples", min_delay,
                             delay, delay * rate.typical)}};
      })};
}

std::vector<ValueRule> plausible_dynamics(const study::StudyPlan& plan) {
  const std::string kg = parameters::unit_on(plan.units.axis, "kg m^2");
  const std::string stiff = parameters::unit_on(plan.units.axis, "N m/rad");
  return {plausible(
      {parameter::plant::inertia, parameter::friction::k1, parameter::friction::k2,
       parameter::friction::sigma0, parameter::controller::sample_rate, parameter::friction::model},
      [kg, stiff](const Ranges& of) -> Faults {
        const study::ParameterRange& inertia = of[parameter::plant::inertia];
        const study::ParameterRange& k1 = of[parameter::friction::k1];
        const study::ParameterRange& k2 = of[parameter::friction::k2];
        const study::ParameterRange& sigma0 = of[parameter::friction::sigma0];
        const study::ParameterRange& rate = of[parameter::controller::sample_rate];
        const study::ParameterRange& of_model = of[parameter::friction::model];
        const auto model = static_cast<friction::FrictionModel>(static_cast<int>(of_model.low));
        const Stiffness k = stiffness_at_rest(model, k1.typical, k2.typical, sigma0.typical);
        if (k.value == 0.0) return {};
        const double frequency = std::sqrt(k.value / inertia.typical) / (2.0 * std::numbers::pi);
        const std::string what = fmt::format(
            "the natural frequency is {:.3g} Hz, that of an inertia of {:.4g} {} on {} = {:.4g} {}",
            frequency, inertia.typical, kg, k.name, k.value, stiff);
        const double lowest = std::min(max_lowest_natural_frequency, min_of_sample_rate * rate.typical);
        if (frequency < lowest)
          return {{what, fmt::format("at least {:.3g} Hz; is a power of ten wrong, or a unit?", lowest)}};
        if (frequency > 0.5 * rate.typical)
          return {
              {what, fmt::format("less than half the sample rate of {:.4g} Hz; is a power of ten wrong, or a "
                                 "unit?",
                                 rate.typical)}};
        return {};
      })};
}

}  // namespace zerocount::rules
