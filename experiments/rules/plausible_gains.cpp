#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "core/loop/dac.hpp"
#include "core/theory/gains.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/parameters/phase_path.hpp"
#include "experiments/rules/value_rules.hpp"

namespace zerocount::rules {
namespace {

using Faults = std::vector<ValueFault>;

/// A controller gain of one phase of the control (fine or coarse).
struct Gain {
  parameter::Handle handle;
  /// Parameter that chooses the control structure (such as PID) of the gain's phase.
  parameter::Handle structure;
  double theory::AnalogueGains::*continuous;  ///< member of the gains in SI units that holds this gain
  double loop::PidGains::*sampled;  ///< member of the gains per count and sample that holds this gain
  /// Beginning of a message about the torque of this gain: "one count of error commands".
  std::string_view action;
};

constexpr std::string_view by_error = "one count of error commands";
constexpr std::string_view by_sum = "each sample with one count of error adds";
constexpr std::string_view by_change = "a change of one count in a sample commands";

using loop::PidGains;
using theory::AnalogueGains;

constexpr std::array<Gain, 6> gains{
    {{parameter::controller::kp, parameter::controller::structure, &AnalogueGains::kp, &PidGains::kp,
      by_error},
     {parameter::controller::ki, parameter::controller::structure, &AnalogueGains::ki, &PidGains::ki, by_sum},
     {parameter::controller::kd, parameter::controller::structure, &AnalogueGains::kd, &PidGains::kd,
      by_change},
     {parameter::controller::coarse::kp, parameter::controller::coarse::structure, &AnalogueGains::kp,
      &PidGains::kp, by_error},
     {parameter::controller::coarse::ki, parameter::controller::coarse::structure, &AnalogueGains::ki,
      &PidGains::ki, by_sum},
     {parameter::controller::coarse::kd, parameter::controller::coarse::structure, &AnalogueGains::kd,
      &PidGains::kd, by_change}}};

/// The typical value of the gain, as torque per count.
double per_count(const study::StudyPlan& plan, const Gain& gain, const Ranges& of) {
  const double value = of[gain.handle].typical;
  if (plan.units.gains == parameters::GainUnits::count) return value;
  loop::ControllerParameters controller;
  controller.sample_rate = of[parameter::controller::sample_rate].typical;
  loop::EncoderParameters encoders;
  encoders.fine = 1.0;
  encoders.fine_length = typical_count(plan, of[fine_encoder(plan)].typical);
  AnalogueGains continuous;
  continuous.*gain.continuous = value;
  return theory::sampled_gains(continuous, controller, encoders).*gain.sampled;
}

/// Parameters on which all rules about gains depend, apart from the gains themselves.
std::vector<parameter::Handle> parameters_of_the_loop(const study::StudyPlan& plan) {
  return {parameter::dac::bits,  parameter::dac::resolution,
          parameter::dac::range, parameter::controller::sample_rate,
          fine_encoder(plan),    parameter::controller::coarse::coarse_beyond};
}

/// Largest torque that the converter (DAC) can command, N m.
double max_torque(const Ranges& of) {
  loop::DacParameters dac{.bits = static_cast<int>(of[parameter::dac::bits].typical),
                          .resolution = of[parameter::dac::resolution].typical};
  const double range = of[parameter::dac::range].typical;
  return range > 0.0 ? range : -loop::lowest_torque(dac);
}

bool can_have_coarse_phase(const Ranges& of) {
  return study::can_have_coarse_phase(of[parameter::controller::coarse::coarse_beyond]);
}

/// The torque that a gain commands for one count, N m, and the phrase for the message that describes this
/// action.
struct TorqueOf {
  std::string_view action;
  double torque;
};

ValueRule within_the_converter(const study::StudyPlan& plan, const Gain& gain) {
  const parameters::Parameter& row =
      parameters::parameter_table()[parameters::find_parameter(gain.handle).value()];
  const bool coarse = gain.structure == parameter::controller::coarse::structure;
  std::vector<parameter::Handle> parameters{gain.handle, gain.structure};
  std::ranges::copy(parameters_of_the_loop(plan), std::back_inserter(parameters));
  return plausible(parameters, [&plan, &gain, &row, coarse](const Ranges& of) -> Faults {
    if (of[gain.structure].low != static_cast<double>(loop::ControlStructure::pid)) return {};
    if (coarse && !can_have_coarse_phase(of)) return {};
    const double torque = per_count(plan, gain, of);
    const double largest = max_torque(of);
    if (!(torque > largest)) return {};
    const bool si = plan.units.gains == parameters::GainUnits::si;
    parameters::StudyUnits other = plan.units;
    other.gains = si ? parameters::GainUnits::count : parameters::GainUnits::si;
    const std::string unit = parameters::unit_on(plan.units.axis, "N m");
    return {{fmt::format("{} {:.3g} {}, beyond the ±{:.3g} {} of the DAC", gain.action, torque, unit, largest,
                         unit),
             fmt::format("a gain in {}; for one in {} say controller.units: {}",
                         parameters::unit_of(row, plan.units), parameters::unit_of(row, other),
                         si ? "count" : "si")}};
  });
}

/// The plausibility rules for the gains of one phase of the control that apply if it is a cascade: their
/// torque should be within the range of the converter.
template <parameters::Phase phase>
std::vector<ValueRule> cascade_within_the_converter(const study::StudyPlan& plan) {
  using Control = parameter::Control<phase>;
  using Torques = std::function<std::vector<TorqueOf>(const Ranges& of, double count)>;
  const auto rule = [&plan](const std::vector<parameter::Handle>& of_phase, const Torques& torques) {
    std::vector<parameter::Handle> parameters{of_phase.front(), Control::structure};
    std::ranges::copy(parameters_of_the_loop(plan), std::back_inserter(parameters));
    parameters.insert(parameters.end(), of_phase.begin() + 1, of_phase.end());
    return plausible(parameters, [&plan, torques](const Ranges& of) -> Faults {
      if (phase == parameters::Phase::coarse && !can_have_coarse_phase(of)) return {};
      const double largest = max_torque(of);
      const std::string unit = parameters::unit_on(plan.units.axis, "N m");
      for (const TorqueOf& one : torques(of, typical_count(plan, of[fine_encoder(plan)].typical))) {
        if (!(one.torque > largest)) continue;
        return {{fmt::format("{} {:.3g} {}, beyond the ±{:.3g} {} of the DAC", one.action, one.torque, unit,
                             largest, unit),
                 "a gain of this axis; is a power of ten wrong, or a unit?"}};
      }
      return {};
    });
  };
  using cascade = typename Control::cascade;
  return {rule({cascade::kp, cascade::kv, cascade::ki},
               [](const Ranges& of, double count) -> std::vector<TorqueOf> {
                 if (of[Control::structure].low != static_cast<double>(loop::ControlStructure::cascade))
                   return {};
                 const double kp = of[cascade::kp].typical;
                 const double kv = of[cascade::kv].typical;
                 const double T = 1.0 / of[parameter::controller::sample_rate].typical;
                 return {{by_error, kp * kv * count},
                         {by_change, kp * count / T},
                         {by_sum, of[cascade::ki].typical * 0.5 * T * kv * count}};
               }),
          rule({Control::feedforward::friction}, [](const Ranges& of, double) -> std::vector<TorqueOf> {
            return {{"the feed-forward of friction commands", of[Control::feedforward::friction].typical}};
          })};
}

}  // namespace

std::vector<ValueRule> plausible_gains(const study::StudyPlan& plan) {
  std::vector<ValueRule> rules;
  if (plan.open_loop || plan.plugin) return rules;
  const auto add = [&rules](const std::vector<ValueRule>& more) {
    rules.insert(rules.end(), more.begin(), more.end());
  };
  for (const Gain& gain : gains) add({within_the_converter(plan, gain)});
  add(cascade_within_the_converter<parameters::Phase::fine>(plan));
  add(cascade_within_the_converter<parameters::Phase::coarse>(plan));
  return rules;
}

}  // namespace zerocount::rules
