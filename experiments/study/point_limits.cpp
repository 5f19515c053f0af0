#include "experiments/study/point_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <variant>

#include <fmt/format.h>

#include "core/loop/controller/controller.hpp"
#include "experiments/distributions/random_field.hpp"
#include "experiments/parameters/handles.hpp"

namespace zerocount::study {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

bool can_be_zero(const distributions::Distribution& distribution) {
  if (const auto* choice = std::get_if<distributions::Choice>(&distribution)) {
    return std::find(choice->values.begin(), choice->values.end(), 0.0) != choice->values.end();
  }
  return numerics::contains(distributions::support(distribution), 0.0);
}

/// Appends a number, unless it is NaN.
void add_number(double number, std::vector<double>& numbers) {
  if (!std::isnan(number)) numbers.push_back(number);
}

/// The numbers that a derived value has at the corners of the box of the values from which it is computed,
/// without NaN.
std::vector<double> numbers_at_corners(const StudyPlan& plan, const DerivedValue& derived,
                                       std::size_t point) {
  std::vector<double> numbers;
  for (std::size_t corner = 0; corner < (std::size_t{1} << derived.from.size()); ++corner) {
    std::size_t sides = corner;
    add_number(derived_value(derived,
                             [&](std::uint32_t slot) {
                               const auto [low, high] = extremes_of(plan, slot, point);
                               const bool is_high = sides % 2 == 1;
                               sides /= 2;
                               return is_high ? high : low;
                             }),
               numbers);
  }
  return numbers;
}

/// The numbers of a derived value at evenly spread quantiles of its sources (a Kronecker sequence), without
/// NaN. The first quantiles are the medians.
std::vector<double> numbers_inside(const StudyPlan& plan, const DerivedValue& derived, std::size_t point) {
  constexpr std::array<double, 5> primes{2.0, 3.0, 5.0, 7.0, 11.0};
  constexpr int spread = 512;
  const std::vector<std::uint32_t>& sampled = plan.sampled_slots;
  std::vector<double> numbers;
  for (int i = 0; i < spread; ++i) {
    std::size_t source = 0;
    add_number(derived_value(derived,
                             [&](std::uint32_t slot) {
                               const bool of_row = std::ranges::find(sampled, slot) != sampled.end();
                               const double step = std::sqrt(primes.at(of_row ? 0 : source % primes.size()));
                               ++source;
                               const Value& value = *value_at_point(plan, slot, point);
                               const double number =
                                   value.kind == Value::Kind::number
                                       ? value.number
                                       : distributions::quantile(plan.distributions[value.index],
                                                                 std::fmod(0.5 + i * step, 1.0));
                               return number * age_factors(plan, slot, point).typical;
                             }),
               numbers);
  }
  return numbers;
}

/// The range of a derived value, from its values at the corners of the box of its sources. If some corner has
/// no value (NaN), points inside the box are used as well.
ParameterRange range_of_derived(const StudyPlan& plan, const DerivedValue& derived, std::size_t point) {
  if (derived.value == nullptr) return range_of_slot(plan, derived.from.front(), point);
  std::vector<double> numbers = numbers_at_corners(plan, derived, point);
  double typical =
      derived_value(derived, [&](std::uint32_t slot) { return range_of_slot(plan, slot, point).typical; });
  if (numbers.size() < (std::size_t{1} << derived.from.size())) {
    const std::vector<double> inside = numbers_inside(plan, derived, point);
    numbers.insert(numbers.end(), inside.begin(), inside.end());
    if (std::isnan(typical) && !inside.empty()) typical = inside.front();
  }
  if (numbers.empty() || std::isnan(typical)) return {nothing, nothing, false, nothing};
  const auto [low, high] = std::ranges::minmax(numbers);
  return {low, high, low <= 0.0, typical};
}

/// The median of the distribution. The values of a choice are sorted for it.
double median_of(const distributions::Distribution& distribution) {
  const auto* choice = std::get_if<distributions::Choice>(&distribution);
  if (choice == nullptr) return distributions::quantile(distribution, 0.5);
  distributions::Choice sorted = *choice;
  std::ranges::sort(sorted.values);
  return distributions::quantile(sorted, 0.5);
}

bool assigns_any(const PlanAxis& axis, const std::vector<bool>& wanted) {
  return std::any_of(axis.assignments.begin(), axis.assignments.end(),
                     [&](const Assignment& assignment) { return wanted[assignment.slot]; });
}

/// The lowest and the highest number that can be drawn for a value, at age 0.
std::pair<double, double> drawn_extremes(const StudyPlan& plan, const Value& value) {
  if (value.kind == Value::Kind::number) return {value.number, value.number};
  const distributions::Distribution& distribution = plan.distributions[value.index];
  // The values of a choice are in the order of its list.
  if (const auto* choice = std::get_if<distributions::Choice>(&distribution)) {
    const auto [low, high] = std::ranges::minmax(choice->values);
    return {low, high};
  }
  return {distributions::quantile(distribution, 0x1p-53),
          distributions::quantile(distribution, 1.0 - 0x1p-53)};
}

/// The lowest and the highest product of a number between `low` and `high`, which may be infinite, and a
/// factor in the range `factors`.
std::pair<double, double> times(double low, double high, const ParameterRange& factors) {
  const auto product = [](double x, double factor) { return x == 0.0 || factor == 0.0 ? 0.0 : x * factor; };
  return std::minmax({product(low, factors.low), product(low, factors.high), product(high, factors.low),
                      product(high, factors.high)});
}

}  // namespace

std::pair<double, double> extremes_of(const StudyPlan& plan, std::size_t slot, std::size_t point) {
  const Value& value = *value_at_point(plan, slot, point);
  const auto [low, high] = drawn_extremes(plan, value);
  return value.aging ? times(low, high, age_factors(plan, slot, point)) : std::pair(low, high);
}

ParameterRange age_factors(const StudyPlan& plan, std::size_t slot, std::size_t point) {
  const Value& value = *value_at_point(plan, slot, point);
  if (!value.aging) return {1.0, 1.0, false, 1.0};
  const Aging& aging = plan.agings[*value.aging];
  const Value& rate = *value_at_point(plan, aging.rate, point);
  const auto factor = [&](double of_rate) { return factor_at_age(aging, of_rate, age_at(plan, point)); };
  const auto [low, high] = drawn_extremes(plan, rate);  // the laws rise with the rate
  return {factor(low), factor(high), factor(low) <= 0.0 && factor(high) >= 0.0,
          factor(range_of(plan, rate).typical)};
}

ParameterRange range_of(const StudyPlan& plan, const Value& value) {
  if (value.kind == Value::Kind::number)
    return {value.number, value.number, value.number == 0.0, value.number};
  if (value.kind == Value::Kind::distribution) {
    const distributions::Distribution& distribution = plan.distributions[value.index];
    const numerics::Interval values = distributions::support(distribution);
    return {values.low, values.high, can_be_zero(distribution), median_of(distribution)};
  }
  const Rotors& rotors = *plan.profiles[value.index];
  const numerics::Interval values = rotors.all_limits();
  return {values.low, values.high, numerics::contains(values, 0.0), rotors.mean(0)};
}

ParameterRange range_of_slot(const StudyPlan& plan, std::size_t slot, std::size_t point) {
  const Value& value = *value_at_point(plan, slot, point);
  if (value.kind == Value::Kind::derived) return range_of_derived(plan, plan.derived[value.index], point);
  const ParameterRange range = range_of(plan, value);
  if (!value.aging || std::isnan(range.low)) return range;
  const ParameterRange factors = age_factors(plan, slot, point);
  const auto [low, high] = times(range.low, range.high, factors);
  return {low, high, range.can_be_zero || factors.can_be_zero, range.typical * factors.typical};
}

const ParameterRange& Ranges::operator[](const parameter::Handle& handle) const {
  const auto found = std::ranges::find(handles_, handle);
  if (found == handles_.end())
    throw std::logic_error(fmt::format("the range of {} is not here", handle.path));
  return ranges_[static_cast<std::size_t>(found - handles_.begin())];
}

bool has_two_encoders(const Ranges& of) {
  return of[parameter::encoder::load::counts_per_revolution].high > 0.0 ||
         of[parameter::encoder::load::resolution].high > 0.0;
}

bool closes_at_load(const Ranges& of) {
  const bool of_plant =
      of[parameter::plant::load::encoder].high == static_cast<double>(motion::EncoderPlace::load);
  const auto choice =
      static_cast<loop::LoopEncoder>(static_cast<int>(of[parameter::controller::cascade::position].high));
  const bool is_pid =
      of[parameter::controller::structure].high == static_cast<double>(loop::ControlStructure::pid);
  if (is_pid || choice == loop::LoopEncoder::of_the_plant) return of_plant;
  return choice == loop::LoopEncoder::load;
}

bool closes_somewhere(const StudyPlan& plan, motion::EncoderPlace mass) {
  const auto has_load = [](const ParameterRange& inertia) { return inertia.high > 0.0; };
  return holds_somewhere(plan, parameter::plant::load::inertia, has_load) &&
         holds_somewhere(plan, two_encoders, [&](const Ranges& of) {
           return closes_at_load(of) == (mass == motion::EncoderPlace::load);
         });
}

bool can_have_coarse_phase(const ParameterRange& coarse_beyond) {
  trial::TrialParameters trial;
  parameters::parameter_table()[parameters::find_parameter(parameter::controller::coarse::coarse_beyond)
                                    .value()]
      .set(trial, coarse_beyond.low);
  return loop::has_coarse_phase(trial.controller);
}

bool has_coarse_encoder(const StudyPlan& plan) {
  for (std::size_t slot = 0; slot < plan.table.rows.size(); ++slot)
    if (plan.given[slot] && plan.table.rows[slot].name.starts_with(parameter::encoder::coarse)) return true;
  const auto is_coarse = [](const ParameterRange& encoder) {
    return encoder.low == static_cast<double>(loop::EncoderChoice::coarse);
  };
  return holds_somewhere(plan, parameter::controller::encoder, is_coarse) ||
         (holds_somewhere(plan, parameter::controller::coarse::coarse_beyond, can_have_coarse_phase) &&
          holds_somewhere(plan, parameter::controller::coarse::encoder, is_coarse));
}

std::vector<std::size_t> slots_named(const StudyTable& table, std::span<const std::string_view> paths) {
  std::vector<std::size_t> slots;
  for (const std::string_view path : paths) slots.push_back(find_slots(path, table).value().first);
  return slots;
}

std::vector<std::size_t> slots_named(const StudyTable& table, std::span<const parameter::Handle> handles) {
  std::vector<std::size_t> slots;
  for (const parameter::Handle& handle : handles)
    slots.push_back(find_slots(handle.path, table).value().first);
  return slots;
}

std::vector<std::size_t> slots_of(const RowGroup& group) {
  std::vector<std::size_t> slots(group.count);
  std::iota(slots.begin(), slots.end(), group.first);
  return slots;
}

void visit_points(const StudyPlan& plan, std::span<const std::size_t> slots,
                  const std::function<bool(std::size_t point)>& visit) {
  struct Turning {
    std::size_t options;
    std::size_t stride;  // number of points between consecutive options
    std::size_t option;
  };
  std::vector<bool> wanted(plan.base.size(), false);
  for (const std::size_t slot : slots) {
    wanted[slot] = true;
    if (plan.base[slot].kind != Value::Kind::derived) continue;
    for (const std::uint32_t source : plan.derived[plan.base[slot].index].from) wanted[source] = true;
  }
  std::vector<Turning> turning;  // the relevant axes, fastest first
  std::size_t stride = 1;
  const bool aging =
      std::ranges::any_of(slots, [&](std::size_t slot) { return changes_with_age(plan, slot); });
  for (std::size_t a = plan.axes.size(); a-- > 0;) {
    const std::size_t options = option_count(plan.axes[a]);
    const bool of_ages = aging && a == plan.settings_axis;
    if (of_ages || assigns_any(plan.axes[a], wanted)) turning.push_back({options, stride, 0});
    stride *= options;
  }
  for (std::size_t point = 0; visit(point);) {
    auto axis = turning.begin();
    for (; axis != turning.end() && axis->option + 1 == axis->options; ++axis) {
      point -= axis->option * axis->stride;
      axis->option = 0;
    }
    if (axis == turning.end()) return;
    ++axis->option;
    point += axis->stride;
  }
}

std::vector<const Value*> values_of(const StudyPlan& plan, std::size_t slot) {
  std::vector<const Value*> values;
  visit_points(plan, {&slot, 1}, [&](std::size_t point) {
    values.push_back(value_at_point(plan, slot, point));
    return true;
  });
  return values;
}

std::vector<ParameterRange> ranges_at(const StudyPlan& plan, std::span<const std::size_t> slots,
                                      std::size_t point) {
  std::vector<ParameterRange> ranges;
  ranges.reserve(slots.size());
  for (const std::size_t slot : slots) ranges.push_back(range_of_slot(plan, slot, point));
  return ranges;
}

bool are_readable(std::span<const ParameterRange> ranges) {
  return std::none_of(ranges.begin(), ranges.end(),
                      [](const ParameterRange& l) { return std::isnan(l.low); });
}

bool holds_somewhere(const StudyPlan& plan, std::span<const parameter::Handle> handles,
                     const std::function<bool(const Ranges&)>& holds) {
  const std::vector<std::size_t> slots = slots_named(plan.table, handles);
  bool found = false;
  visit_points(plan, slots, [&](std::size_t point) {
    found = holds({handles, ranges_at(plan, slots, point)});
    return !found;
  });
  return found;
}

bool holds_somewhere(const StudyPlan& plan, std::string_view path,
                     const std::function<bool(const ParameterRange&)>& holds) {
  const parameter::Handle handle(path);
  return holds_somewhere(plan, {&handle, 1}, [&](const Ranges& of) { return holds(of[handle]); });
}

}  // namespace zerocount::study
