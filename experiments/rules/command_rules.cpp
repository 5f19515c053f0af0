#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "core/loop/dac.hpp"
#include "core/loop/reference.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::rules {
namespace {

using Limits = std::span<const study::ParameterRange>;
using Faults = std::vector<ValueFault>;

constexpr double max_samples = 1e12;  // would take a year of computing: certainly a typing error

std::string too_many_samples() {
  return fmt::format("at most {} samples in a trial", max_samples);
}

// An unbounded distribution is reported once, at its own parameter.
ValueRule highest_value(parameter::Handle parameter, const std::string& expected) {
  return between({parameter}, [parameter, expected](const Ranges& of) -> Faults {
    const study::ParameterRange& limits = of[parameter];
    if (std::isfinite(limits.high)) return {};
    return {{"its values are unbounded, so a trial could have any number of samples", expected}};
  });
}

ValueRule samples_of_targets(double moves) {
  return between({parameter::command::hold, parameter::controller::sample_rate},
                 [moves](const Ranges& of) -> Faults {
                   const study::ParameterRange& hold = of[parameter::command::hold];
                   const study::ParameterRange& rate = of[parameter::controller::sample_rate];
                   if (!std::isfinite(hold.high) || !std::isfinite(rate.high)) return {};  // reported already
                   if (hold.high * rate.high * moves <= max_samples) return {};
                   return {{fmt::format("{} moves of {} s at {} Hz can be more than {} samples", moves,
                                        hold.high, rate.high, max_samples),
                            too_many_samples()}};
                 });
}

double farthest_apart(const study::ParameterRange& a, const study::ParameterRange& b) {
  return std::max(a.high - b.low, b.high - a.low);
}

// Noun for the unit of targets.
std::string unit_of_targets(const parameters::StudyUnits& units) {
  return units.targets == parameters::TargetUnits::si ? parameters::unit_on(units.axis, "rad") : "counts";
}

double largest(const study::ParameterRange& range) {
  return std::max(std::abs(range.low), std::abs(range.high));
}

// The longest travel to each value of the list, from the start or from the value before it.
std::vector<double> longest_travels(Limits list) {
  std::vector<double> travels;
  study::ParameterRange last{};
  for (const study::ParameterRange& next : list) {
    travels.push_back(farthest_apart(next, last));
    last = next;
  }
  return travels;
}

double total_travel(Limits list) {
  const std::vector<double> travels = longest_travels(list);
  return std::accumulate(travels.begin(), travels.end(), 0.0);
}

// @param what why a value of the list needs limits
// @param expected the distribution that it needs
ValueRule limits_of_the_list(const std::string& what, const std::string& expected) {
  return {{}, true, [what, expected](const Ranges&, Limits list) -> Faults {
            Faults faults;
            for (std::size_t i = 0; i < list.size(); ++i) {
              if (std::isfinite(list[i].low) && std::isfinite(list[i].high)) continue;
              faults.push_back({what, expected, {i}});
            }
            return faults;
          }};
}

// Total time of all ramps, s. If the torque stays at 0, every rate is allowed.
double time_of_ramps(Limits levels, const study::ParameterRange& rate) {
  const double travel = total_travel(levels);
  return travel == 0.0 ? 0.0 : travel / rate.low;
}

ValueRule limits_of_torque_levels() {
  return limits_of_the_list("its values are unbounded, so the ramp to the level could take for ever",
                            "a distribution of the level with a lowest and a highest value");
}

// Those in counts are bounded, because they are whole numbers.
ValueRule limits_of_positions() {
  return limits_of_the_list("its values are unbounded, so the target could have any number of counts",
                            "a distribution of the target with a lowest and a highest value");
}

ValueRule lowest_rate_of_torque() {
  return {{parameter::command::torque::rate}, true, [](const Ranges& of, Limits levels) -> Faults {
            if (std::isfinite(time_of_ramps(levels, of[parameter::command::torque::rate])) ||
                !std::isfinite(total_travel(levels)))
              return {};
            return {{"the rate can be so small that a ramp takes for ever",
                     "a rate with a lowest value above 0"}};
          }};
}

ValueRule samples_of_torque_levels() {
  return {
      {parameter::command::hold, parameter::controller::sample_rate, parameter::command::torque::rate},
      true,
      [](const Ranges& of, Limits levels) -> Faults {
        const double hold = of[parameter::command::hold].high;
        const double rate = of[parameter::controller::sample_rate].high;
        const double ramps = time_of_ramps(levels, of[parameter::command::torque::rate]);
        if (!std::isfinite(hold) || !std::isfinite(rate) || !std::isfinite(ramps)) return {};
        const double time = static_cast<double>(levels.size()) * hold + ramps;
        if (time * rate <= max_samples) return {};
        return {
            {fmt::format(
                 "{} levels held for {} s, and ramps of {} s in all, can be more than {} samples at {} Hz",
                 levels.size(), hold, ramps, max_samples, rate),
             too_many_samples()}};
      }};
}

// Warns about torques beyond the range of the converter or the amplifier, which are clipped.
ValueRule range_of_the_converter(const std::string& unit) {
  return {{parameter::command::torque::through, parameter::dac::bits, parameter::dac::resolution,
           parameter::dac::range, parameter::amplifier::limit},
          true,
          [unit](const Ranges& of, Limits levels) -> Faults {
            const bool by_dac =
                of[parameter::command::torque::through].low == static_cast<double>(trial::TorquePath::dac);
            loop::DacParameters dac{.bits = static_cast<int>(of[parameter::dac::bits].low),
                                    .resolution = of[parameter::dac::resolution].low};
            dac.limit = of[parameter::amplifier::limit].low;
            const double range = of[parameter::dac::range].low;
            if (range > 0.0) dac.resolution = std::ldexp(range, 1 - dac.bits);
            const double lowest = by_dac ? loop::lowest_torque(dac) : -dac.limit;
            const double highest = by_dac ? loop::highest_torque(dac) : dac.limit;
            Faults faults;
            for (std::size_t i = 0; i < levels.size(); ++i) {
              if (levels[i].low >= lowest && levels[i].high <= highest) continue;
              const double beyond = levels[i].high > highest ? levels[i].high : levels[i].low;
              faults.push_back(
                  {fmt::format("{} {} can be outside the {}'s range from {:.6g} to {:.6g} {}, "
                               "to which it is clipped",
                               beyond, unit, by_dac ? "converter" : "amplifier", lowest, highest, unit),
                   "",
                   {i}});
            }
            return faults;
          },
          true};
}

ValueRule length_of_the_record(double length, std::string_view key) {
  return between({parameter::command::hold}, [length, key](const Ranges& of) -> Faults {
    const study::ParameterRange& hold = of[parameter::command::hold];
    constexpr double rounding = 1e-9;
    if (!std::isfinite(hold.high) || hold.high <= length * (1.0 + rounding)) return {};
    return {
        {fmt::format("the record of {} lasts {:.9g} s, and the move can take {} s", key, length, hold.high),
         "at most the record"}};
  });
}

// A hold that the study gives may cut the record of a reference.
// @param held without one, s
ValueRule end_of_the_reference(double last, double held, std::string_view key) {
  return warning(between(
      {parameter::command::hold, parameter::controller::sample_rate},
      [last, held, key](const Ranges& of) -> Faults {
        const study::ParameterRange& hold = of[parameter::command::hold];
        const study::ParameterRange& rate = of[parameter::controller::sample_rate];
        const bool reaches_last_row = hold.low * rate.low >= last * rate.low + 0.5;
        if (hold.low == held || reaches_last_row || !(rate.low > 0.0)) return {};
        return {{fmt::format("a hold of {:.9g} s cuts the record of {}, whose last row is at {:.9g} s",
                             hold.low, key, last),
                 fmt::format("command.hold at least {:.9g} s, or none", last + 1.0 / rate.low)}};
      }));
}

// The rule of a list, as of one value between the lowest and the highest of the record.
ValueRule of_the_record(ValueRule rule, std::span<const double> record) {
  const auto [lowest, highest] = std::ranges::minmax(record);
  const std::vector<study::ParameterRange> levels{{.low = lowest, .high = highest}};
  rule.whole_list = false;
  rule.of_record = true;
  rule.find_faults = [levels, of_levels = rule.find_faults](const Ranges& of, Limits) {
    Faults faults = of_levels(of, levels);
    for (ValueFault& fault : faults) fault.listed.clear();
    return faults;
  };
  return rule;
}

ValueRule shape_of_the_reference(bool has_record) {
  return between({parameter::command::profile::shape}, [has_record](const Ranges& of) -> Faults {
    const study::ParameterRange& shape = of[parameter::command::profile::shape];
    const bool is_record = shape.low == static_cast<double>(loop::ReferenceShape::record);
    if (is_record == has_record) return {};
    if (has_record) return {{"command.reference defines the path of the reference", "no shape"}};
    return {{"there is no record", "command.reference: {file: ...} in place of targets"}};
  });
}

ValueRule order_of_targets(const std::string& unit) {
  return {{}, true, [unit](const Ranges&, Limits targets) -> Faults {
            Faults faults;
            for (std::size_t i = 1; i < targets.size(); ++i) {
              if (targets[i].low > targets[i - 1].high) continue;
              faults.push_back({fmt::format("the target can be {} {}, not above the one before it, {} {}",
                                            targets[i].low, unit, targets[i - 1].high, unit),
                                "targets in ascending order in every trial",
                                {i, i - 1}});
            }
            return faults;
          }};
}

ValueRule reach_of_the_overrun() {
  return {{parameter::command::sequence::overrun}, true, [](const Ranges& of, Limits targets) -> Faults {
            const double farthest = of[parameter::command::sequence::overrun].high +
                                    std::max(std::abs(targets.front().low), std::abs(targets.back().high));
            if (farthest <= parameters::max_count) return {};
            return {{fmt::format("the sequence can reach {} counts", farthest),
                     fmt::format("at most {} counts from the start", parameters::max_count)}};
          }};
}

// The longest travel between consecutive targets, including the start, counts.
double max_step(Limits targets) {
  return std::ranges::max(longest_travels(targets));
}

// The longest travel of a sequence, which moves beyond its targets before it reverses, counts.
double max_step_of_sequence(Limits targets, const study::ParameterRange& overrun,
                            const study::SequenceCycle& cycle) {
  const study::ParameterRange below{targets.front().low - overrun.high, targets.front().high - overrun.low};
  const study::ParameterRange above{targets.back().low + overrun.low, targets.back().high + overrun.high};
  const bool starts_below = cycle.approach != study::SequenceApproach::negative;
  double longest = std::max(overrun.high, farthest_apart(starts_below ? below : above, {}));
  for (std::size_t i = 1; i < targets.size(); ++i)
    longest = std::max(longest, farthest_apart(targets[i], targets[i - 1]));
  if (cycle.approach == study::SequenceApproach::bidirectional || cycle.cycles == 1) return longest;
  return std::max(
      longest, starts_below ? farthest_apart(targets.back(), below) : farthest_apart(targets.front(), above));
}

// The maximum length of a count of the fine encoder, rad or m.
double longest_count(parameters::AxisKind axis, const study::ParameterRange& encoder) {
  switch (axis) {
    case parameters::AxisKind::rotary:
      break;
    case parameters::AxisKind::linear:
      return encoder.high;
  }
  return 2.0 * std::numbers::pi / encoder.low;
}

// The minimum length of a count of the fine encoder, rad or m.
double shortest_count(parameters::AxisKind axis, const study::ParameterRange& encoder) {
  return longest_count(axis, {encoder.high, encoder.low});
}

// Targets in rad are counts of an encoder that may be too fine for them.
ValueRule reach_of_positions(const study::StudyPlan& plan, bool sequence) {
  const parameter::Handle encoder = fine_encoder(plan);
  ValueRule rule{{encoder}, true, {}};
  if (sequence) rule.between.push_back(parameter::command::sequence::overrun);
  rule.find_faults = [axis = plan.units.axis, encoder, sequence](const Ranges& of, Limits targets) -> Faults {
    double farthest = 0.0;
    for (const study::ParameterRange& target : targets) farthest = std::max(farthest, largest(target));
    if (sequence) farthest += of[parameter::command::sequence::overrun].high;
    const double counts = farthest / shortest_count(axis, of[encoder]);
    if (!std::isfinite(counts) || counts <= parameters::max_count) return {};
    return {{fmt::format("the command can reach {:.6g} counts of this encoder", counts),
             fmt::format("at most {} counts from the start", parameters::max_count)}};
  };
  return rule;
}

ValueRule time_of_travel(const study::StudyPlan& plan) {
  const parameters::StudyUnits& units = plan.units;
  const std::optional<study::SequenceCycle>& sequence = plan.sequence;
  const parameter::Handle encoder = fine_encoder(plan);
  ValueRule rule{
      {parameter::command::hold, parameter::verdict::window, parameter::command::profile::shape,
       parameter::command::profile::velocity_limit, parameter::command::profile::acceleration_limit,
       parameter::command::profile::jerk_limit, parameter::command::profile::frequency, encoder},
      true,
      {}};
  if (sequence) rule.between.push_back(parameter::command::sequence::overrun);
  rule.find_faults = [units, sequence, encoder](const Ranges& of, Limits targets) -> Faults {
    using profile = parameter::command::profile;
    const double hold = of[parameter::command::hold].low;
    const double window = of[parameter::verdict::window].high;
    loop::ReferenceProfile slowest;
    slowest.shape = static_cast<loop::ReferenceShape>(static_cast<int>(of[profile::shape].low));
    if (slowest.shape == loop::ReferenceShape::step || slowest.shape == loop::ReferenceShape::record)
      return {};
    if (slowest.shape == loop::ReferenceShape::sine) {
      const double frequency = of[profile::frequency].low;
      if (2.0 <= frequency * hold) return {};
      return {{fmt::format("a hold of {} s is less than two periods of a sine reference of {} Hz", hold,
                           frequency),
               "at least 2/frequency: the first period is not measured"}};
    }
    slowest.velocity_limit = of[profile::velocity_limit].low;
    slowest.acceleration_limit = of[profile::acceleration_limit].low;
    slowest.jerk_limit = of[profile::jerk_limit].low;
    const double count = longest_count(units.axis, of[encoder]);
    const double step =
        sequence ? max_step_of_sequence(targets, of[parameter::command::sequence::overrun], *sequence)
                 : max_step(targets);
    // Each end of a travel in rad is rounded to a count.
    const bool si = units.targets == parameters::TargetUnits::si;
    const double counts = si ? std::floor(step / count) + 1.0 : step;
    if (si && !(counts <= 2.0 * parameters::max_count)) return {};  // see reach_of_positions()
    const loop::Reference travel(slowest, 0, static_cast<std::int64_t>(counts), count);
    const double needed = travel.duration() + window;
    if (needed <= hold) return {};
    if (!std::isfinite(needed)) {
      return {{"a limit of the profile can be so small that the travel takes for ever",
               "limits of the profile with a lowest value above 0"}};
    }
    return {{fmt::format(
                 "a travel of {} {} can take {:.6g} s, which leaves no window of {} s in the hold of {} s",
                 step, unit_of_targets(units), travel.duration(), window, hold),
             fmt::format("command.hold at least {:.6g} s, or higher limits of the profile", needed)}};
  };
  return rule;
}

}  // namespace

double hold_of_the_reference(const study::StudyPlan& plan) {
  const std::size_t rate = study::find_slots(parameter::controller::sample_rate, plan.table).value().first;
  const double lowest = study::range_of(plan, plan.base[rate]).low;  // not a number where it is unreadable
  return loop::record_duration(plan.common.command.profile.record->time, lowest > 0.0 ? 1.0 / lowest : 0.0);
}

std::string_view record_key(const study::StudyPlan& plan) {
  return plan.open_loop ? "command.torque.file" : "command.reference.file";
}

std::vector<ValueRule> command_rules(const study::StudyPlan& plan) {
  std::vector<ValueRule> rules{
      highest_value(parameter::command::hold, "a distribution of the hold with a highest value"),
      highest_value(parameter::controller::sample_rate,
                    "a distribution of the sample rate with a highest value")};
  const auto add = [&rules](const std::vector<ValueRule>& more) {
    rules.insert(rules.end(), more.begin(), more.end());
  };
  const auto listed = static_cast<std::int64_t>(plan.list.count);
  const bool si = plan.units.targets == parameters::TargetUnits::si;
  if (plan.open_loop) {
    add({limits_of_torque_levels(), lowest_rate_of_torque(), samples_of_torque_levels(),
         range_of_the_converter(parameters::unit_on(plan.units.axis, "N m"))});
    if (const auto& record = plan.common.command.torque.record)
      add({length_of_the_record(trial::record_duration(*record), record_key(plan)),
           of_the_record(range_of_the_converter(parameters::unit_on(plan.units.axis, "N m")),
                         record->torque)});
  } else if (!plan.sequence) {
    add({samples_of_targets(static_cast<double>(listed)), time_of_travel(plan)});
  } else {
    add({samples_of_targets(static_cast<double>(study::sequence_move_count(*plan.sequence, listed))),
         order_of_targets(unit_of_targets(plan.units)), time_of_travel(plan)});
  }
  if (!plan.open_loop) add({shape_of_the_reference(plan.common.command.profile.record != nullptr)});
  if (const auto& record = plan.common.command.profile.record) {
    add({end_of_the_reference(record->time.back(), hold_of_the_reference(plan), record_key(plan)),
         of_the_record(reach_of_positions(plan, false), record->position)});
  } else if (si) {
    add({limits_of_positions(), reach_of_positions(plan, plan.sequence.has_value())});
  } else if (plan.sequence) {
    add({reach_of_the_overrun()});
  }
  return rules;
}

}  // namespace zerocount::rules
