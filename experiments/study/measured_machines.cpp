#include "experiments/study/measured_machines.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "experiments/study/point_limits.hpp"
#include "experiments/study/trial_draws.hpp"

namespace zerocount::study {
namespace {

/// The last key of a dotted path.
std::string_view last_key(std::string_view name) {
  return name.substr(name.rfind('.') + 1);
}

MeasuredFault fault_of(const StudyPlan& plan, const MeasuredSlots& measured,
                       const parameters::MeasuredCondition& condition, std::span<const double> numbers) {
  MeasuredFault fault;
  for (const std::string_view formula : {condition.low, condition.high}) {
    for (std::size_t i = 0; i < measured.slots.size(); ++i) {
      if (formula.find(last_key(measured.group->names[i])) != std::string_view::npos)
        fault.slots.push_back(measured.slots[i]);
    }
  }
  const std::string unit = parameters::unit_on(plan.units.axis, condition.unit);
  fault.what =
      fmt::format("{} = {:.6g} {} is not below {} = {:.6g} {}", condition.low, condition.low_value(numbers),
                  unit, condition.high, condition.high_value(numbers), unit);
  fault.expected = fmt::format("{} below {}", condition.low, condition.high);
  return fault;
}

/// The numbers at one corner of the box that the ends of the numbers span. Bit i of `corner` selects the high
/// end of number i.
std::vector<double> corner_of(std::span<const std::pair<double, double>> ends, std::size_t corner) {
  std::vector<double> numbers;
  numbers.reserve(ends.size());
  for (std::size_t i = 0; i < ends.size(); ++i)
    numbers.push_back(((corner >> i) & 1U) == 1U ? ends[i].second : ends[i].first);
  return numbers;
}

/// Whether the corner of the box differs from all corners before it. It does not if it takes the high end of
/// a known number, whose ends are equal.
bool is_new(std::span<const std::pair<double, double>> ends, std::size_t corner) {
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (((corner >> i) & 1U) == 1U && ends[i].first == ends[i].second) return false;
  }
  return true;
}

}  // namespace

std::optional<MeasuredFault> fault_within(const StudyPlan& plan, const MeasuredSlots& measured,
                                          const SlotEnds& ends) {
  std::vector<std::pair<double, double>> all;
  all.reserve(measured.slots.size());
  for (const std::uint32_t slot : measured.slots) all.push_back(ends(slot));
  for (std::size_t corner = 0; corner < (std::size_t{1} << all.size()); ++corner) {
    if (!is_new(all, corner)) continue;
    const std::vector<double> numbers = corner_of(all, corner);
    for (const parameters::MeasuredCondition& condition : measured.group->conditions) {
      if (!(condition.low_value(numbers) < condition.high_value(numbers)))
        return fault_of(plan, measured, condition, numbers);
    }
  }
  return std::nullopt;
}

std::optional<MeasuredFault> fault_of_machine(const StudyPlan& plan, std::size_t point,
                                              const MeasuredSlots& measured, const SlotEnds& ends) {
  const auto is_of_contact = [&](std::uint32_t slot) {
    return is_drawn_per_contact(*value_at_point(plan, slot, point));
  };
  const auto is_sampled = [&](std::uint32_t slot) {
    return std::ranges::find(plan.sampled_slots, slot) != plan.sampled_slots.end();
  };
  const auto row_slot = std::ranges::find_if(
      measured.slots, [&](std::uint32_t slot) { return is_sampled(slot) && is_of_contact(slot); });
  std::size_t rows = 1;
  if (row_slot != measured.slots.end()) {
    const Value& value = *value_at_point(plan, *row_slot, point);
    rows = std::get<distributions::Choice>(plan.distributions[value.index]).values.size();
  }
  for (std::size_t row = 0; row < rows; ++row) {
    auto fault = fault_within(plan, measured, [&](std::uint32_t slot) {
      const Value& value = *value_at_point(plan, slot, point);
      if (!is_of_contact(slot)) return ends(slot);
      if (!is_sampled(slot)) return extremes_of(plan, slot, point);
      const double number = distributions::quantile(
          plan.distributions[value.index], (static_cast<double>(row) + 0.5) / static_cast<double>(rows));
      return std::pair(number, number);
    });
    if (fault) return fault;
  }
  return std::nullopt;
}

bool is_machine(const Study& study, std::int64_t point, std::int64_t index, const GivenDraws& given) {
  const StudyPlan& plan = *study.plan;
  return std::ranges::none_of(plan.measured, [&](const MeasuredSlots& measured) {
    const std::vector<double> numbers = drawn_numbers(study, point, index, measured.slots, given);
    const auto known = [&](std::uint32_t slot) {
      const auto i = std::ranges::find(measured.slots, slot) - measured.slots.begin();
      return std::pair(numbers[static_cast<std::size_t>(i)], numbers[static_cast<std::size_t>(i)]);
    };
    return fault_of_machine(plan, plan_point(plan, point), measured, known).has_value();
  });
}

std::vector<double> drawn_numbers(const Study& study, std::int64_t point, std::int64_t index,
                                  std::span<const std::uint32_t> slots, const GivenDraws& given) {
  const TrialPlace place = place_of(study, point, index);
  const TrialDraws draws = draws_of(study, point, place.draw, given);
  std::vector<double> numbers;
  numbers.reserve(slots.size());
  for (const std::uint32_t slot : slots)
    numbers.push_back(
        drawn_number(draws, slot, *value_at_point(draws.plan(), slot, place.point), place.point));
  return numbers;
}

}  // namespace zerocount::study
