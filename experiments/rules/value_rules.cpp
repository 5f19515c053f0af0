#include "experiments/rules/value_rules.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "core/friction/law.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/parameters/phase_path.hpp"

namespace zerocount::rules {
namespace {

using parameters::Phase;
using parameters::phase_path;
using Faults = std::vector<ValueFault>;

ValueRule at_least_a_sample(parameter::Handle duration) {
  return between({duration, parameter::controller::sample_rate}, [duration](const Ranges& of) -> Faults {
    const double time = of[duration].low;
    const double rate = of[parameter::controller::sample_rate].low;
    if (std::round(time * rate) >= 1.0) return {};
    return {{fmt::format("{} s can be less than one sample at {} Hz", time, rate), "at least one sample"}};
  });
}

ValueRule at_most_the_hold(parameter::Handle duration) {
  return between({duration, parameter::command::hold}, [duration](const Ranges& of) -> Faults {
    const double time = of[duration].high;
    const double hold = of[parameter::command::hold].low;
    if (time <= hold) return {};
    return {{fmt::format("{} s can be longer than the hold of {} s", time, hold), "at most command.hold"}};
  });
}

std::vector<ValueRule> rules_of_durations(bool open_loop) {
  if (open_loop) return {at_least_a_sample(parameter::command::hold)};
  return {at_least_a_sample(parameter::verdict::dwell), at_most_the_hold(parameter::verdict::dwell),
          at_least_a_sample(parameter::verdict::window), at_most_the_hold(parameter::verdict::window)};
}

double max_abs(const study::ParameterRange& range) {
  return std::max(std::abs(range.low), std::abs(range.high));
}

std::vector<ValueRule> rules_of_the_start(const std::string& torque_unit) {
  return {
      between({parameter::initial::preload, parameter::friction::breakaway},
              [torque_unit](const Ranges& of) -> Faults {
                const study::ParameterRange& preload = of[parameter::initial::preload];
                const study::ParameterRange& breakaway = of[parameter::friction::breakaway];
                const double torque = max_abs(preload);
                if (torque < breakaway.low || torque == 0.0) return {};
                return {{fmt::format("a preload of {} {} can reach the breakaway of {} {}", torque,
                                     torque_unit, breakaway.low, torque_unit),
                         "|initial.preload| below friction.breakaway"}};
              }),
      between({parameter::initial::history::torque, parameter::friction::breakaway},
              [torque_unit](const Ranges& of) -> Faults {
                const study::ParameterRange& history = of[parameter::initial::history::torque];
                const study::ParameterRange& breakaway = of[parameter::friction::breakaway];
                if (history.high < breakaway.low || history.high == 0.0) return {};
                return {{fmt::format("a history of {} {} can reach the breakaway of {} {}", history.high,
                                     torque_unit, breakaway.low, torque_unit),
                         "initial.history.torque below friction.breakaway"}};
              }),
      between({parameter::initial::velocity, parameter::initial::mode, parameter::friction::model},
              [](const Ranges& of) -> Faults {
                const study::ParameterRange& velocity = of[parameter::initial::velocity];
                const study::ParameterRange& mode = of[parameter::initial::mode];
                const study::ParameterRange& law = of[parameter::friction::model];
                const auto model = static_cast<friction::FrictionModel>(static_cast<int>(law.low));
                const bool slides = mode.low == static_cast<double>(trial::InitialMode::slide) &&
                                    friction::traits_of(model).breakaway != friction::Breakaway::never;
                if (!slides || !velocity.can_be_zero) return {};
                return {{"the velocity can be 0 although the hook slides at the start",
                         "a velocity that is never 0 with initial.mode: slide"}};
              }),
  };
}

// A trial that is stopped early lacks the ends of some moves.
ValueRule no_stop_in_a_sequence() {
  return between({parameter::verdict::stop}, [](const Ranges& of) -> Faults {
    const study::ParameterRange& stop = of[parameter::verdict::stop];
    if (stop.high == 0.0) return {};
    return {{"the values of ISO 230-2 need the end of every move, which a stopped trial lacks",
             "false with command.sequence"}};
  });
}

ValueRule stop_with_two_phases() {
  return warning(
      between({parameter::verdict::stop, parameter::controller::coarse::coarse_beyond},
              [](const Ranges& of) -> Faults {
                const study::ParameterRange& stop = of[parameter::verdict::stop];
                const study::ParameterRange& beyond = of[parameter::controller::coarse::coarse_beyond];
                if (stop.high == 0.0 || !study::can_have_coarse_phase(beyond)) return {};
                return {
                    {"the coarse phase may bring the $rotor back from beyond verdict.limit, and so change an "
                     "outcome that counted as decided",
                     ""}};
              }));
}

std::vector<ValueRule> rules_of_two_phases(const std::string& derivative_unit) {
  return {
      stop_with_two_phases(),
      between({parameter::controller::kd, parameter::controller::coarse::coarse_beyond},
              [derivative_unit](const Ranges& of) -> Faults {
                const study::ParameterRange& kd = of[parameter::controller::kd];
                const study::ParameterRange& beyond = of[parameter::controller::coarse::coarse_beyond];
                if (!study::can_have_coarse_phase(beyond) || kd.high == 0.0) return {};
                return {{fmt::format("{} {} can act in the fine phase of a control with two phases", kd.high,
                                     derivative_unit),
                         "0 with a coarse phase, which alone has a derivative (controller.coarse.kd)"}};
              }),
      between({parameter::controller::coarse::fine_within, parameter::controller::coarse::coarse_beyond},
              [](const Ranges& of) -> Faults {
                const study::ParameterRange& within = of[parameter::controller::coarse::fine_within];
                const study::ParameterRange& beyond = of[parameter::controller::coarse::coarse_beyond];
                if (!study::can_have_coarse_phase(beyond) || within.high <= beyond.low) return {};
                return {{fmt::format("the fine phase can be entered at {} counts and left beyond {}",
                                     within.high, beyond.low),
                         "at most controller.coarse.coarse_beyond"}};
              }),
  };
}

/// Handles of the amplitude parameters of all torque ripples on the load that the study has.
std::vector<parameter::Handle> ripples_on_the_load(const study::StudyPlan& plan) {
  std::vector<parameter::Handle> amplitudes;
  for (const parameters::Parameter& row : plan.table.rows) {
    // Cheap comparisons first: `tune` asks for the rules at each candidate.
    if (!row.name.starts_with("disturbance.load.") || !parameters::has_value(row)) continue;
    if (parameters::without_indices(row.name) == parameter::disturbance::load::ripple::amplitude.path)
      amplitudes.emplace_back(row.name);
  }
  return amplitudes;
}

/// The largest constant torque that the friction contact has to hold at the start of a trial, N m.
/// @param ripples amplitudes of the ripples on the load
double largest_held_torque(const Ranges& of, const std::vector<parameter::Handle>& ripples) {
  double largest = max_abs(of[parameter::disturbance::torque]);
  if (of[parameter::plant::load::inertia].high == 0.0) return largest;
  largest += max_abs(of[parameter::disturbance::load::torque]);
  for (const parameter::Handle& amplitude : ripples) largest += max_abs(of[amplitude]);
  return largest;
}

/// The faults of a trial's start at which friction alone must hold a constant disturbance: a disturbance that
/// can reach the friction. Empty if the friction is always larger.
/// @param largest largest constant disturbance torque, N m
Faults faults_of_friction_alone(const Ranges& of, double largest, bool open_loop, const std::string& unit) {
  const auto law = static_cast<friction::FrictionModel>(static_cast<int>(of[parameter::friction::model].low));
  const double level = friction::holding_limit(law, of[parameter::friction::breakaway].low,
                                               of[parameter::friction::coulomb_ratio].low);
  if (largest == 0.0 || largest < level) return {};
  if (level == 0.0)
    return {{fmt::format("a disturbance of {} {} can reach the friction that is to hold it: "
                         "friction.breakaway is drawn without a smallest value above 0",
                         largest, unit),
             "a distribution of friction.breakaway with a smallest value above that, such as uniform or "
             "truncated_normal"}};
  return {{fmt::format("a disturbance of {} {} can reach the friction of {} {} that is to hold it", largest,
                       unit, level, unit),
           open_loop
               ? "a smaller disturbance"
               : "initial.holding left out, with an initial.integral that carries the disturbance, or a "
                 "smaller disturbance"}};
}

/// The rule about a trial that starts while the axis holds the constant disturbance (initial.holding):
/// friction or an integral must be able to hold it, and the axis must stand still without any other initial
/// load.
ValueRule what_holds_the_axis(const study::StudyPlan& plan) {
  std::vector<parameter::Handle> parameters{parameter::initial::holding,
                                            parameter::disturbance::torque,
                                            parameter::friction::breakaway,
                                            parameter::friction::coulomb_ratio,
                                            parameter::friction::model,
                                            parameter::initial::preload,
                                            parameter::initial::history::reversals,
                                            parameter::initial::integral,
                                            parameter::initial::velocity,
                                            parameter::initial::gap,
                                            parameter::plant::load::inertia,
                                            parameter::disturbance::load::torque};
  const std::vector<parameter::Handle> ripples = ripples_on_the_load(plan);
  parameters.insert(parameters.end(), ripples.begin(), ripples.end());
  return between(
      parameters,
      [ripples, unit = parameters::unit_on(plan.units.axis, "N m"),
       open_loop = plan.open_loop](const Ranges& of) -> Faults {
        if (of[parameter::initial::holding].high == 0.0) return {};
        const auto law =
            static_cast<friction::FrictionModel>(static_cast<int>(of[parameter::friction::model].low));
        // With a second mass, the integral holds what the contact cannot.
        const bool has_integral = of[parameter::plant::load::inertia].low > 0.0 && !open_loop;
        if (!has_integral && !friction::has_friction(law))
          return {{"nothing holds an axis without friction", "another friction.model, or the key left out"}};
        Faults faults;
        if (!has_integral)
          faults = faults_of_friction_alone(of, largest_held_torque(of, ripples), open_loop, unit);
        if (max_abs(of[parameter::initial::velocity]) > 0.0)
          faults.push_back({"an axis that holds a disturbance stands still", "initial.velocity of 0"});
        if (max_abs(of[parameter::initial::gap]) > 0.0)
          faults.push_back(
              {"the load of an axis that holds lies where what acts on it keeps it", "initial.gap of 0"});
        if (max_abs(of[parameter::initial::preload]) > 0.0 ||
            of[parameter::initial::history::reversals].high > 0.0 ||
            max_abs(of[parameter::initial::integral]) > 0.0)
          faults.push_back({"the contact has been loaded from virgin to the disturbance and nothing else",
                            "initial.preload, initial.history and initial.integral of 0"});
        return faults;
      });
}

/// The rule that relates a choice of encoder (the parameter `choice`) to the encoders that the axis has.
ValueRule about_encoder(parameter::Handle choice,
                        std::function<std::vector<ValueFault>(const Ranges& of)> find_faults) {
  std::vector<parameter::Handle> parameters{choice};
  parameters.insert(parameters.end(), study::two_encoders.begin(), study::two_encoders.end());
  return between(std::move(parameters), std::move(find_faults));
}

ValueRule no_coarse_encoder_beside_two(parameter::Handle choice) {
  return about_encoder(choice, [choice](const Ranges& of) -> Faults {
    const bool coarse = of[choice].high == static_cast<double>(loop::EncoderChoice::coarse);
    if (!coarse || !study::has_two_encoders(of)) return {};
    return {{"there is no coarse encoder beside encoder.load", "fine"}};
  });
}

/// The rules that the encoder that each loop reads exists on the axis.
std::vector<ValueRule> rules_of_the_loops_encoders() {
  static constexpr parameter::Handle of_velocity = parameter::controller::cascade::velocity;
  return {no_coarse_encoder_beside_two(parameter::controller::encoder),
          no_coarse_encoder_beside_two(parameter::controller::coarse::encoder),
          about_encoder(of_velocity, [](const Ranges& of) -> Faults {
            const auto choice = static_cast<loop::LoopEncoder>(static_cast<int>(of[of_velocity].low));
            const bool at_load = choice == loop::LoopEncoder::of_the_plant
                                     ? of[parameter::plant::load::encoder].high ==
                                           static_cast<double>(motion::EncoderPlace::load)
                                     : choice == loop::LoopEncoder::load;
            const bool cascade = of[parameter::controller::structure].low ==
                                 static_cast<double>(loop::ControlStructure::cascade);
            if (!cascade || study::has_two_encoders(of) || at_load == study::closes_at_load(of)) return {};
            return {{"the loops of the cascade read two masses, and there is one encoder",
                     "the same mass for both, or encoder.load"}};
          })};
}

std::vector<ValueRule> rules_of_the_clock() {
  return {between({parameter::controller::jitter, parameter::controller::sample_rate},
                  [](const Ranges& of) -> Faults {
                    const study::ParameterRange& jitter = of[parameter::controller::jitter];
                    const study::ParameterRange& rate = of[parameter::controller::sample_rate];
                    if (jitter.high == 0.0 || jitter.high * rate.high < 1.0) return {};
                    return {{fmt::format("a sample can be {} s late, a whole sample time at {} Hz",
                                         jitter.high, rate.high),
                             "less than 1/controller.sample_rate"}};
                  }),
          between({parameter::controller::dither::frequency, parameter::controller::sample_rate,
                   parameter::controller::dither::amplitude},
                  [](const Ranges& of) -> Faults {
                    const study::ParameterRange& frequency = of[parameter::controller::dither::frequency];
                    const study::ParameterRange& rate = of[parameter::controller::sample_rate];
                    const study::ParameterRange& amplitude = of[parameter::controller::dither::amplitude];
                    if (amplitude.high == 0.0 || frequency.high <= 0.5 * rate.low) return {};
                    return {{fmt::format("{} Hz can be more than half the sample rate, {} Hz", frequency.high,
                                         rate.low),
                             "at most half of controller.sample_rate"}};
                  })};
}

/// The rule that a state of the control (such as a standstill) ends at an |error| of at least the |error| at
/// which it begins.
/// @param text message with both numbers, the end first
ValueRule order_of(parameter::Handle end, parameter::Handle begin, const char* text, const char* expected) {
  return between({end, begin}, [=](const Ranges& of) -> Faults {
    const study::ParameterRange& of_end = of[end];
    const study::ParameterRange& of_begin = of[begin];
    if (of_end.high < 0.0 || of_end.low >= of_begin.high) return {};
    return {{fmt::format(fmt::runtime(text), of_end.low, of_begin.high), expected}};
  });
}

template <Phase phase>
ValueRule order_of_hold() {
  return order_of(parameter::Control<phase>::hold::leave, parameter::Control<phase>::hold::enter,
                  "the hold can end at {} counts and begin at {}",
                  "at least the |error| with which it begins");
}

template <Phase phase>
std::vector<ValueRule> rules_of_blocks() {
  using Control = parameter::Control<phase>;
  static constexpr parameter::Handle enter = Control::deadband::enter;
  static constexpr parameter::Handle leave = Control::deadband::leave;
  static constexpr parameter::Handle zone = Control::integrator_zone;
  return {order_of(leave, enter, "the deadband can be left at {} counts and entered at {}",
                   "at least the |error| with which it is entered"),
          warning(between({zone, enter, leave},
                          [](const Ranges& of) -> Faults {
                            const study::ParameterRange& of_zone = of[zone];
                            const study::ParameterRange& of_enter = of[enter];
                            if (of_zone.high > of_enter.low) return {};
                            return {{"the integral never changes: its zone lies inside the deadband",
                                     fmt::format("{} above {}", zone.path, enter.path)}};
                          })),
          between({Control::observer::bandwidth, parameter::controller::sample_rate},
                  [](const Ranges& of) -> Faults {
                    const study::ParameterRange& bandwidth = of[Control::observer::bandwidth];
                    const study::ParameterRange& rate = of[parameter::controller::sample_rate];
                    if (bandwidth.high == 0.0 || bandwidth.high < 0.5 * rate.low) return {};
                    return {{fmt::format("{} Hz can be half the sample rate, {} Hz, or more", bandwidth.high,
                                         rate.low),
                             "a bandwidth below half of controller.sample_rate"}};
                  })};
}

}  // namespace

std::vector<ValueRule> value_rules(const study::StudyPlan& plan) {
  std::vector<ValueRule> rules = rules_of_durations(plan.open_loop);
  const auto add = [&](std::vector<ValueRule> more) { std::ranges::move(more, std::back_inserter(rules)); };
  add(command_rules(plan));
  add(list_rules(plan));
  add(plugin_rules(plan));
  add(rules_of_the_start(parameters::unit_on(plan.units.axis, "N m")));
  static const parameters::Parameter& kd =
      parameters::parameter_table()[parameters::find_parameter(parameter::controller::kd).value()];
  add({what_holds_the_axis(plan)});
  add(rules_of_the_clock());
  if (!plan.open_loop) {
    add({order_of_hold<Phase::fine>(), order_of_hold<Phase::coarse>()});
    add(rules_of_the_loops_encoders());
    add(rules_of_two_phases(parameters::unit_of(kd, plan.units)));
    add(rules_of_blocks<Phase::fine>());
    add(rules_of_blocks<Phase::coarse>());
  }
  add(plausibility_rules(plan));
  if (plan.sequence) add({no_stop_in_a_sequence()});
  return rules;
}

std::vector<ValueFault> longer_than_the_move(double within, const study::ParameterRange& hold) {
  if (!(hold.low < within)) return {};
  return {{fmt::format("{} s is longer than the hold of a move, {} s", within, hold.low),
           "a time in s, at most command.hold"}};
}

std::string first_fault(const study::StudyPlan& plan, std::size_t point) {
  for (const ValueRule& rule : value_rules(plan)) {
    if (rule.warn_only) continue;
    const std::vector<std::size_t> named = study::slots_named(plan.table, rule.between);
    const std::vector<std::size_t> listed =
        rule.whole_list ? study::slots_of(plan.list) : std::vector<std::size_t>{};
    const Faults faults = rule.find_faults({rule.between, study::ranges_at(plan, named, point)},
                                           study::ranges_at(plan, listed, point));
    if (faults.empty()) continue;
    const ValueFault& fault = faults.front();
    const std::size_t slot = fault.listed.empty() ? named.front() : listed[fault.listed.front()];
    return parameters::text_on(plan.units.axis, fmt::format("{}: {}; expected {}", plan.table.rows[slot].name,
                                                            fault.what, fault.expected));
  }
  return "";
}

std::string refusal_of(const study::PointEdit& edit) {
  std::string fault = edit.out_of_range();
  for (const std::size_t point : edit.points()) {
    if (fault.empty()) fault = first_fault(edit.plan(), point);
  }
  return fault;
}

}  // namespace zerocount::rules
