#include "experiments/rules/value_rules.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "core/friction/law.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/parameters/phase_path.hpp"

namespace zerocount::rules {
namespace {

using parameters::Phase;
using parameters::phase_path;
using Limits = std::span<const study::ParameterRange>;
using Faults = std::vector<ValueFault>;

Faults shorter_than_a_sample(const study::ParameterRange& duration,
                             const study::ParameterRange& sample_rate) {
  if (std::round(duration.low * sample_rate.low) >= 1.0) return {};
  return {{fmt::format("{} s can be less than one sample at {} Hz", duration.low, sample_rate.low),
           "at least one sample"}};
}

Faults longer_than_the_hold(const study::ParameterRange& duration, const study::ParameterRange& hold) {
  if (duration.high <= hold.low) return {};
  return {{fmt::format("{} s can be longer than the hold of {} s", duration.high, hold.low),
           "at most command.hold"}};
}

std::vector<ValueRule> rules_of_durations(bool open_loop) {
  if (open_loop) return {between({"command.hold", "controller.sample_rate"}, shorter_than_a_sample)};
  return {between({"verdict.dwell", "controller.sample_rate"}, shorter_than_a_sample),
          between({"verdict.dwell", "command.hold"}, longer_than_the_hold),
          between({"verdict.window", "controller.sample_rate"}, shorter_than_a_sample),
          between({"verdict.window", "command.hold"}, longer_than_the_hold)};
}

double max_abs(const study::ParameterRange& range) {
  return std::max(std::abs(range.low), std::abs(range.high));
}

std::vector<ValueRule> rules_of_the_start(const std::string& torque_unit) {
  return {
      between({"initial.preload", "friction.breakaway"},
              [torque_unit](const auto& preload, const auto& breakaway) -> Faults {
                const double torque = max_abs(preload);
                if (torque < breakaway.low || torque == 0.0) return {};
                return {{fmt::format("a preload of {} {} can reach the breakaway of {} {}", torque,
                                     torque_unit, breakaway.low, torque_unit),
                         "|initial.preload| below friction.breakaway"}};
              }),
      between({"initial.history.torque", "friction.breakaway"},
              [torque_unit](const auto& history, const auto& breakaway) -> Faults {
                if (history.high < breakaway.low || history.high == 0.0) return {};
                return {{fmt::format("a history of {} {} can reach the breakaway of {} {}", history.high,
                                     torque_unit, breakaway.low, torque_unit),
                         "initial.history.torque below friction.breakaway"}};
              }),
      between({"initial.velocity", "initial.mode", "friction.model"},
              [](const auto& velocity, const auto& mode, const auto& law) -> Faults {
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
  return between({"verdict.stop"}, [](const auto& stop) -> Faults {
    if (stop.high == 0.0) return {};
    return {{"the values of ISO 230-2 need the end of every move, which a stopped trial lacks",
             "false with command.sequence"}};
  });
}

ValueRule stop_with_two_phases() {
  return warning(
      between({"verdict.stop", "controller.coarse.coarse_beyond"},
              [](const auto& stop, const auto& beyond) -> Faults {
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
      between({"controller.kd", "controller.coarse.coarse_beyond"},
              [derivative_unit](const auto& kd, const auto& beyond) -> Faults {
                if (!study::can_have_coarse_phase(beyond) || kd.high == 0.0) return {};
                return {{fmt::format("{} {} can act in the fine phase of a control with two phases", kd.high,
                                     derivative_unit),
                         "0 with a coarse phase, which alone has a derivative (controller.coarse.kd)"}};
              }),
      between({"controller.coarse.fine_within", "controller.coarse.coarse_beyond"},
              [](const auto& within, const auto& beyond) -> Faults {
                if (!study::can_have_coarse_phase(beyond) || within.high <= beyond.low) return {};
                return {{fmt::format("the fine phase can be entered at {} counts and left beyond {}",
                                     within.high, beyond.low),
                         "at most controller.coarse.coarse_beyond"}};
              }),
  };
}

// The contact that carries the constant disturbance at the start.
ValueRule what_holds_the_axis(const study::StudyPlan& plan) {
  enum : std::size_t {
    holding,
    torque,
    breakaway,
    ratio,
    model,
    preload,
    reversals,
    integral,
    velocity,
    gap,
    load,
    load_torque  // and amplitudes of ripples on the load
  };
  std::vector<std::string_view> between{
      "initial.holding",  "disturbance.torque", "friction.breakaway",        "friction.coulomb_ratio",
      "friction.model",   "initial.preload",    "initial.history.reversals", "initial.integral",
      "initial.velocity", "initial.gap",        "plant.load.inertia",        "disturbance.load.torque"};
  for (const parameters::Parameter& row : plan.table.rows) {
    if (parameters::has_value(row) && row.name.starts_with("disturbance.load.ripple.") &&
        row.name.ends_with(".amplitude"))
      between.push_back(row.name);
  }
  return {
      between, false,
      [torque_unit = parameters::unit_on(plan.units.axis, "N m"), open_loop = plan.open_loop](
          Limits l, Limits) -> Faults {
        if (l[holding].high == 0.0) return {};
        const auto law = static_cast<friction::FrictionModel>(static_cast<int>(l[model].low));
        // With a second mass, the integral holds what the contact cannot.
        const bool has_integral = l[load].low > 0.0 && !open_loop;
        if (!has_integral && !friction::has_friction(law))
          return {{"nothing holds an axis without friction", "another friction.model, or the key left out"}};
        Faults faults;
        double largest = max_abs(l[torque]);
        if (l[load].high > 0.0)
          for (const study::ParameterRange& on_load : l.subspan(load_torque)) largest += max_abs(on_load);
        const double level = friction::holding_limit(law, l[breakaway].low, l[ratio].low);
        if (!has_integral && level == 0.0 && largest > 0.0)
          faults.push_back({fmt::format("a disturbance of {} {} can reach the friction that is to hold it: "
                                        "friction.breakaway is drawn without a smallest value above 0",
                                        largest, torque_unit),
                            fmt::format("a distribution of friction.breakaway with a smallest value above "
                                        "that, such as uniform or truncated_normal")});
        else if (!has_integral && largest >= level && largest > 0.0)
          faults.push_back({fmt::format("a disturbance of {} {} can reach the friction of {} {} that is to "
                                        "hold it",
                                        largest, torque_unit, level, torque_unit),
                            open_loop ? "a smaller disturbance"
                                      : "initial.holding left out, with an initial.integral that carries the "
                                        "disturbance, or a smaller disturbance"});
        if (max_abs(l[velocity]) > 0.0)
          faults.push_back({"an axis that holds a disturbance stands still", "initial.velocity of 0"});
        if (max_abs(l[gap]) > 0.0)
          faults.push_back(
              {"the load of an axis that holds lies where what acts on it keeps it", "initial.gap of 0"});
        if (max_abs(l[preload]) > 0.0 || l[reversals].high > 0.0 || max_abs(l[integral]) > 0.0)
          faults.push_back({"the contact has been loaded from virgin to the disturbance and nothing else",
                            "initial.preload, initial.history and initial.integral of 0"});
        return faults;
      }};
}

// Which encoder each loop reads.
std::vector<ValueRule> rules_of_the_loops_encoders() {
  const auto between = [](std::string_view first) {
    std::vector<std::string_view> names{first};
    names.insert(names.end(), study::two_encoders.begin(), study::two_encoders.end());
    return names;
  };
  const auto no_coarse_one = [&](std::string_view choice) -> ValueRule {
    return {between(choice), false, [](Limits l, Limits) -> Faults {
              const bool coarse = l[0].high == static_cast<double>(loop::EncoderChoice::coarse);
              if (!coarse || !study::has_two_encoders(l.subspan(1))) return {};
              return {{"there is no coarse encoder beside encoder.load", "fine"}};
            }};
  };
  return {no_coarse_one("controller.encoder"),
          no_coarse_one("controller.coarse.encoder"),
          {between("controller.cascade.velocity"), false, [](Limits l, Limits) -> Faults {
             const auto choice = static_cast<loop::LoopEncoder>(static_cast<int>(l[0].low));
             const bool at_load = choice == loop::LoopEncoder::of_the_plant
                                      ? l[4].high == static_cast<double>(motion::EncoderPlace::load)
                                      : choice == loop::LoopEncoder::load;
             const bool cascade = l[5].low == static_cast<double>(loop::ControlStructure::cascade);
             if (!cascade || study::has_two_encoders(l.subspan(1)) ||
                 at_load == study::closes_at_load(l.subspan(1)))
               return {};
             return {{"the loops of the cascade read two masses, and there is one encoder",
                      "the same mass for both, or encoder.load"}};
           }}};
}

std::vector<ValueRule> rules_of_the_clock() {
  return {between({"controller.jitter", "controller.sample_rate"},
                  [](const auto& jitter, const auto& rate) -> Faults {
                    if (jitter.high == 0.0 || jitter.high * rate.high < 1.0) return {};
                    return {{fmt::format("a sample can be {} s late, a whole sample time at {} Hz",
                                         jitter.high, rate.high),
                             "less than 1/controller.sample_rate"}};
                  }),
          between({"controller.dither.frequency", "controller.sample_rate", "controller.dither.amplitude"},
                  [](const auto& frequency, const auto& rate, const auto& amplitude) -> Faults {
                    if (amplitude.high == 0.0 || frequency.high <= 0.5 * rate.low) return {};
                    return {{fmt::format("{} Hz can be more than half the sample rate, {} Hz", frequency.high,
                                         rate.low),
                             "at most half of controller.sample_rate"}};
                  })};
}

/// The rule that a state ends at an |error| of at least the |error| at which it begins.
/// @param text message with both numbers, the end first
ValueRule order_of(std::string_view end, std::string_view begin, const char* text, const char* expected) {
  return between({end, begin}, [text, expected](const auto& of_end, const auto& of_begin) -> Faults {
    if (of_end.high < 0.0 || of_end.low >= of_begin.high) return {};
    return {{fmt::format(fmt::runtime(text), of_end.low, of_begin.high), expected}};
  });
}

template <Phase phase>
ValueRule order_of_hold() {
  return order_of(phase_path<phase, "hold.leave">, phase_path<phase, "hold.enter">,
                  "the hold can end at {} counts and begin at {}",
                  "at least the |error| with which it begins");
}

template <Phase phase>
std::vector<ValueRule> rules_of_blocks() {
  static constexpr std::string_view enter = phase_path<phase, "deadband.enter">;
  static constexpr std::string_view leave = phase_path<phase, "deadband.leave">;
  static constexpr std::string_view zone = phase_path<phase, "integrator_zone">;
  return {order_of(leave, enter, "the deadband can be left at {} counts and entered at {}",
                   "at least the |error| with which it is entered"),
          warning(between({zone, enter, leave},
                          [](const auto& of_zone, const auto& of_enter, const auto&) -> Faults {
                            if (of_zone.high > of_enter.low) return {};
                            return {{"the integral never changes: its zone lies inside the deadband",
                                     fmt::format("{} above {}", zone, enter)}};
                          })),
          between({phase_path<phase, "observer.bandwidth">, "controller.sample_rate"},
                  [](const auto& bandwidth, const auto& rate) -> Faults {
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
      parameters::parameter_table()[parameters::find_parameter("controller.kd").value()];
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
    const Faults faults =
        rule.find_faults(study::ranges_at(plan, named, point), study::ranges_at(plan, listed, point));
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
