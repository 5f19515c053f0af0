#include "experiments/rules/value_rules.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "core/friction/law.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/rules/plausibility.hpp"

namespace zerocount::rules {
namespace {

using Limits = std::span<const study::ValueLimits>;
using Faults = std::vector<ValueFault>;

Faults shorter_than_a_sample(const study::ValueLimits& duration, const study::ValueLimits& sample_rate) {
  if (std::round(duration.low * sample_rate.low) >= 1.0) return {};
  return {{fmt::format("{} s can be less than one sample at {} Hz", duration.low, sample_rate.low),
           "at least one sample"}};
}

Faults longer_than_the_hold(const study::ValueLimits& duration, const study::ValueLimits& hold) {
  if (duration.high <= hold.low) return {};
  return {{fmt::format("{} s can be longer than the hold of {} s", duration.high, hold.low),
           "at most command.hold"}};
}

std::vector<ValueRule> rules_of_durations(bool open_loop) {
  const auto at_least_one_sample = [](Limits l, Limits) { return shorter_than_a_sample(l[0], l[1]); };
  const auto within_the_hold = [](Limits l, Limits) { return longer_than_the_hold(l[0], l[1]); };
  if (open_loop) return {{{"command.hold", "controller.sample_rate"}, false, at_least_one_sample}};
  return {
      {{"verdict.dwell", "controller.sample_rate"}, false, at_least_one_sample},
      {{"verdict.dwell", "command.hold"}, false, within_the_hold},
      {{"verdict.window", "controller.sample_rate"}, false, at_least_one_sample},
      {{"verdict.window", "command.hold"}, false, within_the_hold},
  };
}

double max_abs(const study::ValueLimits& limits) {
  return std::max(std::abs(limits.low), std::abs(limits.high));
}

std::vector<ValueRule> rules_of_the_start(const std::string& torque_unit) {
  return {
      {{"initial.preload", "friction.breakaway"},
       false,
       [torque_unit](Limits l, Limits) -> Faults {
         const double torque = max_abs(l[0]);
         if (torque < l[1].low || torque == 0.0) return {};
         return {{fmt::format("a preload of {} {} can reach the breakaway of {} {}", torque, torque_unit,
                              l[1].low, torque_unit),
                  "|initial.preload| below friction.breakaway"}};
       }},
      {{"initial.history.torque", "friction.breakaway"},
       false,
       [torque_unit](Limits l, Limits) -> Faults {
         if (l[0].high < l[1].low || l[0].high == 0.0) return {};
         return {{fmt::format("a history of {} {} can reach the breakaway of {} {}", l[0].high, torque_unit,
                              l[1].low, torque_unit),
                  "initial.history.torque below friction.breakaway"}};
       }},
      {{"initial.velocity", "initial.mode", "friction.model"},
       false,
       [](Limits l, Limits) -> Faults {
         const auto model = static_cast<friction::FrictionModel>(static_cast<int>(l[2].low));
         const bool slides = l[1].low == static_cast<double>(trial::InitialMode::slide) &&
                             friction::traits_of(model).breakaway != friction::Breakaway::never;
         if (!slides || !l[0].can_be_zero) return {};
         return {{"the velocity can be 0 although the hook slides at the start",
                  "a velocity that is never 0 with initial.mode: slide"}};
       }},
  };
}

// A trial that is stopped early lacks the ends of some moves.
ValueRule no_stop_in_a_sequence() {
  return {{"verdict.stop"}, false, [](Limits l, Limits) -> Faults {
            if (l[0].high == 0.0) return {};
            return {{"the values of ISO 230-2 need the end of every move, which a stopped trial lacks",
                     "false with command.sequence"}};
          }};
}

ValueRule stop_with_two_phases() {
  return {{"verdict.stop", "controller.coarse.coarse_beyond"},
          false,
          [](Limits l, Limits) -> Faults {
            if (l[0].high == 0.0 || !study::can_have_coarse_phase(l[1])) return {};
            return {
                {"the coarse phase may bring the $rotor back from beyond verdict.limit, and so change an "
                 "outcome that counted as decided",
                 ""}};
          },
          true};
}

std::vector<ValueRule> rules_of_two_phases(const std::string& derivative_unit) {
  return {
      stop_with_two_phases(),
      {{"controller.kd", "controller.coarse.coarse_beyond"},
       false,
       [derivative_unit](Limits l, Limits) -> Faults {
         if (!study::can_have_coarse_phase(l[1]) || l[0].high == 0.0) return {};
         return {{fmt::format("{} {} can act in the fine phase of a control with two phases", l[0].high,
                              derivative_unit),
                  "0 with a coarse phase, which alone has a derivative (controller.coarse.kd)"}};
       }},
      {{"controller.coarse.fine_within", "controller.coarse.coarse_beyond"},
       false,
       [](Limits l, Limits) -> Faults {
         if (!study::can_have_coarse_phase(l[1]) || l[0].high <= l[1].low) return {};
         return {{fmt::format("the fine phase can be entered at {} counts and left beyond {}", l[0].high,
                              l[1].low),
                  "at most controller.coarse.coarse_beyond"}};
       }},
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
          for (const study::ValueLimits& on_load : l.subspan(load_torque)) largest += max_abs(on_load);
        // The bristle of dahl yields at the Coulomb level.
        const double level = l[breakaway].low * (law == friction::FrictionModel::dahl ? l[ratio].low : 1.0);
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
                            "torques of `disturbance` that friction.breakaway exceeds"});
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
  return {{{"controller.jitter", "controller.sample_rate"},
           false,
           [](Limits l, Limits) -> Faults {
             if (l[0].high == 0.0 || l[0].high * l[1].high < 1.0) return {};
             return {{fmt::format("a sample can be {} s late, a whole sample time at {} Hz", l[0].high,
                                  l[1].high),
                      "less than 1/controller.sample_rate"}};
           }},
          {{"controller.dither.frequency", "controller.sample_rate", "controller.dither.amplitude"},
           false,
           [](Limits l, Limits) -> Faults {
             if (l[2].high == 0.0 || l[0].high <= 0.5 * l[1].low) return {};
             return {{fmt::format("{} Hz can be more than half the sample rate, {} Hz", l[0].high, l[1].low),
                      "at most half of controller.sample_rate"}};
           }}};
}

ValueRule order_of_hold(std::string_view leave, std::string_view enter) {
  return {{leave, enter}, false, [](Limits l, Limits) -> Faults {
            if (l[0].high < 0.0 || l[0].low >= l[1].high) return {};
            return {{fmt::format("the hold can end at {} counts and begin at {}", l[0].low, l[1].high),
                     "at least the |error| with which it begins"}};
          }};
}

/// Rules of the blocks of one phase, by the names of their parameters.
std::vector<ValueRule> rules_of_blocks(std::string_view enter, std::string_view leave, std::string_view zone,
                                       std::string_view bandwidth) {
  return {
      {{leave, enter},
       false,
       [](Limits l, Limits) -> Faults {
         if (l[0].high < 0.0 || l[0].low >= l[1].high) return {};
         return {{fmt::format("the deadband can be left at {} counts and entered at {}", l[0].low, l[1].high),
                  "at least the |error| with which it is entered"}};
       }},
      {{zone, enter, leave},
       false,
       [zone, enter](Limits l, Limits) -> Faults {
         if (l[0].high > l[1].low) return {};
         return {{"the integral never changes: its zone lies inside the deadband",
                  fmt::format("{} above {}", zone, enter)}};
       },
       true},
      {{bandwidth, "controller.sample_rate"},
       false,
       [](Limits l, Limits) -> Faults {
         if (l[0].high == 0.0 || l[0].high < 0.5 * l[1].low) return {};
         return {{fmt::format("{} Hz can be half the sample rate, {} Hz, or more", l[0].high, l[1].low),
                  "a bandwidth below half of controller.sample_rate"}};
       }},
  };
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
    add({order_of_hold("controller.hold.leave", "controller.hold.enter"),
         order_of_hold("controller.coarse.hold.leave", "controller.coarse.hold.enter")});
    add(rules_of_the_loops_encoders());
    add(rules_of_two_phases(parameters::unit_of(kd, plan.units)));
    add(rules_of_blocks("controller.deadband.enter", "controller.deadband.leave",
                        "controller.integrator_zone", "controller.observer.bandwidth"));
    add(rules_of_blocks("controller.coarse.deadband.enter", "controller.coarse.deadband.leave",
                        "controller.coarse.integrator_zone", "controller.coarse.observer.bandwidth"));
  }
  add(plausibility_rules(plan));
  if (plan.sequence) add({no_stop_in_a_sequence()});
  return rules;
}

std::vector<ValueFault> longer_than_the_move(double within, const study::ValueLimits& hold) {
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
        rule.find_faults(study::limits_at(plan, named, point), study::limits_at(plan, listed, point));
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
