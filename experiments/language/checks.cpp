#include "experiments/language/checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/distributions/random_field.hpp"
#include "experiments/language/slots.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount {
namespace {

constexpr double most_samples = 1e12;  // a year of computing; a slip of the keyboard
constexpr std::size_t most_reported = 20;

enum Involved : std::size_t { breakaway, preload, hold, dwell, window, sample_rate, involved_count };

using Slots = std::array<std::size_t, involved_count>;

Slots involved_slots() {
  constexpr std::array<std::string_view, involved_count> names{
      "friction.breakaway", "initial.preload", "command.hold",
      "verdict.dwell",      "verdict.window",  "controller.sample_rate"};
  Slots slots{};
  for (std::size_t i = 0; i < names.size(); ++i) slots[i] = find_parameter(names[i]).value();
  return slots;
}

struct Limits {
  double low;
  double high;
};

// A value that could not be read is NaN, and fails no comparison below.
Limits limits_of(const StudyPlan& plan, const Value& value) {
  if (value.kind == Value::Kind::number) return {value.number, value.number};
  const Interval values = value.kind == Value::Kind::distribution ? support(plan.distributions[value.index])
                                                                  : limits(*plan.profiles[value.index]);
  return {values.low, values.high};
}

struct Fault {
  std::array<Involved, 2> between;  // the first gives the path
  std::string what;
  std::string expected;
};

using PointLimits = std::array<Limits, involved_count>;

void find_duration_faults(const PointLimits& p, Involved duration, std::vector<Fault>& faults) {
  if (std::round(p[duration].low * p[sample_rate].low) < 1.0) {
    faults.push_back(
        {{duration, sample_rate},
         fmt::format("{} s can be less than one sample at {} Hz", p[duration].low, p[sample_rate].low),
         "at least one sample"});
  }
  if (p[duration].high > p[hold].low) {
    faults.push_back({{duration, hold},
                      fmt::format("{} s can be longer than the hold of {} s", p[duration].high, p[hold].low),
                      "at most command.hold"});
  }
}

std::vector<Fault> find_faults(const PointLimits& p, std::size_t moves) {
  std::vector<Fault> faults;
  find_duration_faults(p, dwell, faults);
  find_duration_faults(p, window, faults);
  if (p[hold].high * p[sample_rate].high * static_cast<double>(moves) > most_samples) {
    faults.push_back({{hold, sample_rate},
                      fmt::format("{} moves of {} s at {} Hz can be more than {} samples", moves,
                                  p[hold].high, p[sample_rate].high, most_samples),
                      fmt::format("at most {} samples in a trial", most_samples)});
  }
  const double torque = std::max(std::abs(p[preload].low), std::abs(p[preload].high));
  if (torque >= p[breakaway].low && torque > 0.0) {
    faults.push_back(
        {{preload, breakaway},
         fmt::format("a preload of {} N m can reach the breakaway of {} N m", torque, p[breakaway].low),
         "|initial.preload| below friction.breakaway"});
  }
  return faults;
}

// The place of the slot's value at this point, and whether the sweep gives it.
std::pair<Place, bool> place_of(const StudyPlan& plan, const PlanPlaces& places, std::size_t slot,
                                std::size_t point) {
  for (std::size_t a = plan.axes.size(); a-- > 0;) {
    const PlanAxis& axis = plan.axes[a];
    const std::size_t option = option_at(plan, a, point);
    for (std::size_t i = axis.first[option]; i < axis.first[option + 1]; ++i) {
      if (axis.assignments[i].slot == slot) return {places.axes[a][i], true};
    }
  }
  return {places.base[slot], false};
}

void report(const StudyPlan& plan, const PlanPlaces& places, const Slots& slots, const Fault& fault,
            std::size_t point, Problems& problems) {
  const auto [first, first_swept] = place_of(plan, places, slots[fault.between[0]], point);
  const auto [second, second_swept] = place_of(plan, places, slots[fault.between[1]], point);
  const bool first_written = first_swept || places.written[slots[fault.between[0]]];
  const bool at_second =
      (second_swept && !first_swept) || (!first_written && places.written[slots[fault.between[1]]]);
  problems.add(at_second ? second : first, slot_name(slots[fault.between[0]]), fault.what, fault.expected);
}

bool any_swept(const StudyPlan& plan, const Slots& slots) {
  for (const PlanAxis& axis : plan.axes) {
    for (const Assignment& assignment : axis.assignments) {
      if (std::find(slots.begin(), slots.end(), assignment.slot) != slots.end()) return true;
    }
  }
  return false;
}

}  // namespace

void check_points(const StudyPlan& plan, const PlanPlaces& places, Problems& problems) {
  const Slots slots = involved_slots();
  std::size_t points = 1;
  if (any_swept(plan, slots)) {
    for (const PlanAxis& axis : plan.axes) points *= option_count(axis);
  }
  std::set<std::pair<Involved, std::string>> reported;  // the same fault at many points is one
  for (std::size_t point = 0; point < points && reported.size() < most_reported; ++point) {
    const std::vector<const Value*> values = values_at(plan, point);
    PointLimits limits{};
    for (std::size_t i = 0; i < slots.size(); ++i) limits[i] = limits_of(plan, *values[slots[i]]);
    for (const Fault& fault : find_faults(limits, plan.moves)) {
      if (reported.insert({fault.between[0], fault.what}).second)
        report(plan, places, slots, fault, point, problems);
    }
  }
}

}  // namespace zerocount
