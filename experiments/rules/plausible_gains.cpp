#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/loop/dac.hpp"
#include "core/theory/gains.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/parameters/phase_path.hpp"
#include "experiments/rules/value_rules.hpp"

namespace zerocount::rules {
namespace {

using Limits = std::span<const study::ParameterRange>;
using Faults = std::vector<ValueFault>;

/// A gain of one phase of the control.
struct Gain {
  std::string_view name;
  std::string_view structure;                 ///< parameter with the control structure of the gain's phase
  double theory::AnalogueGains::*continuous;  ///< the gain in SI units
  double loop::PidGains::*sampled;            ///< the gain per count
  std::string_view action;                    ///< effect of the gain on one count, for messages
};

constexpr std::string_view by_error = "one count of error commands";
constexpr std::string_view by_sum = "each sample with one count of error adds";
constexpr std::string_view by_change = "a change of one count in a sample commands";

using loop::PidGains;
using theory::AnalogueGains;

constexpr std::array<Gain, 6> gains{
    {{"controller.kp", "controller.structure", &AnalogueGains::kp, &PidGains::kp, by_error},
     {"controller.ki", "controller.structure", &AnalogueGains::ki, &PidGains::ki, by_sum},
     {"controller.kd", "controller.structure", &AnalogueGains::kd, &PidGains::kd, by_change},
     {"controller.coarse.kp", "controller.coarse.structure", &AnalogueGains::kp, &PidGains::kp, by_error},
     {"controller.coarse.ki", "controller.coarse.structure", &AnalogueGains::ki, &PidGains::ki, by_sum},
     {"controller.coarse.kd", "controller.coarse.structure", &AnalogueGains::kd, &PidGains::kd, by_change}}};

// The limits of the parameters of a rule, in their order.
enum : std::size_t { value, structure, bits, resolution, range, sample_rate, encoder, coarse_beyond };

/// The gain in torque per count.
double per_count(const study::StudyPlan& plan, const Gain& gain, Limits l) {
  if (plan.units.gains == parameters::GainUnits::count) return l[value].typical;
  loop::ControllerParameters controller;
  controller.sample_rate = l[sample_rate].typical;
  loop::EncoderParameters encoders;
  encoders.fine = 1.0;
  encoders.fine_length = typical_count(plan, l[encoder].typical);
  AnalogueGains continuous;
  continuous.*gain.continuous = l[value].typical;
  return theory::sampled_gains(continuous, controller, encoders).*gain.sampled;
}

/// Largest torque of the converter.
double max_torque(Limits l) {
  loop::DacParameters dac{.bits = static_cast<int>(l[bits].typical), .resolution = l[resolution].typical};
  return l[range].typical > 0.0 ? l[range].typical : -loop::lowest_torque(dac);
}

/// The action of a gain, and the torque that the gain commands by it, N m.
struct TorqueOf {
  std::string_view action;
  double torque;
};

ValueRule within_the_converter(const study::StudyPlan& plan, const Gain& gain) {
  const parameters::Parameter& row =
      parameters::parameter_table()[parameters::find_parameter(gain.name).value()];
  const bool coarse = gain.name.starts_with("controller.coarse.");
  return plausibility_rule(
      {gain.name, gain.structure, "dac.bits", "dac.resolution", "dac.range", "controller.sample_rate",
       fine_encoder_name(plan), "controller.coarse.coarse_beyond"},
      [&plan, &gain, &row, coarse](Limits l) -> Faults {
        if (l[structure].low != static_cast<double>(loop::ControlStructure::pid)) return {};
        if (coarse && !study::can_have_coarse_phase(l[coarse_beyond])) return {};
        const double torque = per_count(plan, gain, l);
        const double largest = max_torque(l);
        if (!(torque > largest)) return {};
        const bool si = plan.units.gains == parameters::GainUnits::si;
        parameters::StudyUnits other = plan.units;
        other.gains = si ? parameters::GainUnits::count : parameters::GainUnits::si;
        const std::string unit = parameters::unit_on(plan.units.axis, "N m");
        return {{fmt::format("{} {:.3g} {}, beyond the ±{:.3g} {} of the DAC", gain.action, torque, unit,
                             largest, unit),
                 fmt::format("a gain in {}; for one in {} say controller.units: {}",
                             parameters::unit_of(row, plan.units), parameters::unit_of(row, other),
                             si ? "count" : "si")}};
      });
}

/// The rules for the gains of one phase of the control, if it is a cascade.
template <parameters::Phase phase>
std::vector<ValueRule> cascade_within_the_converter(const study::StudyPlan& plan) {
  enum : std::size_t { kp = 0, feedforward = 0, kv = 8, ki = 9 };  // after those of a gain
  const auto rule = [&plan](std::string_view first, std::vector<std::string_view> more,
                            const std::function<std::vector<TorqueOf>(Limits, double count)>& torques) {
    std::vector<std::string_view> between{first,
                                          parameters::phase_path<phase, "structure">,
                                          "dac.bits",
                                          "dac.resolution",
                                          "dac.range",
                                          "controller.sample_rate",
                                          fine_encoder_name(plan),
                                          "controller.coarse.coarse_beyond"};
    between.insert(between.end(), more.begin(), more.end());
    return plausibility_rule(between, [&plan, torques](Limits l) -> Faults {
      if (phase == parameters::Phase::coarse && !study::can_have_coarse_phase(l[coarse_beyond])) return {};
      const double largest = max_torque(l);
      const std::string unit = parameters::unit_on(plan.units.axis, "N m");
      for (const TorqueOf& of : torques(l, typical_count(plan, l[encoder].typical))) {
        if (!(of.torque > largest)) continue;
        return {{fmt::format("{} {:.3g} {}, beyond the ±{:.3g} {} of the DAC", of.action, of.torque, unit,
                             largest, unit),
                 "a gain of this axis; is a power of ten wrong, or a unit?"}};
      }
      return {};
    });
  };
  const auto is_cascade = [](Limits l) {
    return l[structure].low == static_cast<double>(loop::ControlStructure::cascade);
  };
  return {rule(parameters::phase_path<phase, "cascade.kp">,
               {parameters::phase_path<phase, "cascade.kv">, parameters::phase_path<phase, "cascade.ki">},
               [is_cascade](Limits l, double count) -> std::vector<TorqueOf> {
                 if (!is_cascade(l)) return {};
                 const double T = 1.0 / l[sample_rate].typical;
                 return {{by_error, l[kp].typical * l[kv].typical * count},
                         {by_change, l[kp].typical * count / T},
                         {by_sum, l[ki].typical * 0.5 * T * l[kv].typical * count}};
               }),
          rule(parameters::phase_path<phase, "feedforward.friction">, {},
               [](Limits l, double) -> std::vector<TorqueOf> {
                 return {{"the feed-forward of friction commands", l[feedforward].typical}};
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
