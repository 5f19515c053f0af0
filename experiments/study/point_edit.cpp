#include "experiments/study/point_edit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "experiments/study/study.hpp"

namespace zerocount::study {
namespace {

std::size_t slot_named(const StudyPlan& plan, std::string_view parameter) {
  return slots_named(plan.table, {&parameter, 1}).front();
}

/// The values that the distribution can give, if it is a list or a short range of whole numbers; empty for
/// other distributions.
std::optional<distributions::Choice> listed(const distributions::Distribution& distribution) {
  if (const auto* choice = std::get_if<distributions::Choice>(&distribution)) return *choice;
  const auto* integers = std::get_if<distributions::Integers>(&distribution);
  constexpr std::int64_t longest = 1000;
  if (integers == nullptr || integers->high - integers->low >= longest) return std::nullopt;
  distributions::Choice values;
  for (std::int64_t i = integers->low; i <= integers->high; ++i)
    values.values.push_back(integers->unit * static_cast<double>(i));
  return values;
}

distributions::Distribution scaled_by(const Scaling& scaling, const distributions::Distribution& distribution,
                                      std::optional<double> none) {
  std::optional<distributions::Choice> list = listed(distribution);
  if (!list) return distributions::scaled(distribution, scaling.factor);
  for (double& value : list->values)
    if (value != none) value = scaling(value);
  return *list;
}

}  // namespace

PointEdit::PointEdit(const Study& study, std::int64_t point)
    : study_(study), plan_(*study.plan), point_(plan_point(*study.plan, point)) {
  plan_.axes.push_back({{0, 0}, {}});
}

std::vector<std::size_t> PointEdit::points() const {
  std::vector<std::size_t> points;
  for (std::int64_t setting = 0; setting < study_.settings.total(); ++setting)
    points.push_back(point_ + static_cast<std::size_t>(setting));
  return points;
}

ParameterRange PointEdit::limits(std::string_view parameter, std::int64_t setting) const {
  const std::size_t point = point_ + static_cast<std::size_t>(setting);
  return range_of_slot(plan_, slot_named(plan_, parameter), point);
}

void PointEdit::set(std::size_t slot, double number) {
  assign(slot, {.kind = Value::Kind::number, .number = number});
}

void PointEdit::set(std::string_view parameter, double number) {
  set(slot_named(plan_, parameter), number);
}

void PointEdit::scale(std::size_t slot, const Scaling& scaling) {
  const Value value = value_of(slot);
  const std::optional<double> none = plan_.table.rows[slot].none;
  switch (value.kind) {
    case Value::Kind::number:
      if (value.number != none && !std::isnan(value.number))
        assign(slot, {.kind = value.kind, .number = scaling(value.number), .aging = value.aging});
      return;
    case Value::Kind::distribution:
      assign(slot, drawn_from(value, scaled_by(scaling, plan_.distributions[value.index], none)));
      return;
    case Value::Kind::profile:
    case Value::Kind::derived:  // a friction parameter, whose unit does not depend on the loop
      return;
  }
}

void PointEdit::scale(std::string_view parameter, const Scaling& scaling) {
  scale(slot_named(plan_, parameter), scaling);
}

Widened PointEdit::widen(double factor) {
  Widened widened;
  for (std::size_t slot = 0; slot < plan_.table.rows.size(); ++slot) {
    const parameters::Parameter& row = plan_.table.rows[slot];
    const std::string_view name = row.name;
    const Value* const drawn = value_at_point(plan_, slot, point_);
    if (drawn == nullptr || name.starts_with("initial.") || name.starts_with("command.")) continue;
    const numerics::Interval& range = row.range;
    if (std::ranges::find(plan_.sampled_slots, static_cast<std::uint32_t>(slot)) != plan_.sampled_slots.end())
      continue;
    Value value = *drawn;
    bool fits = true;
    if (value.kind == Value::Kind::distribution) {
      const distributions::Distribution& before = plan_.distributions[value.index];
      distributions::Distribution wider = distributions::widened(before, factor);
      if (wider == before) continue;
      fits = distributions::extremes_are_inside(wider, range);
      if (fits) value = drawn_from(value, std::move(wider));
    } else if (value.kind == Value::Kind::profile) {
      std::shared_ptr<const Rotors> wider = plan_.profiles[value.index]->widened(factor);
      fits = numerics::contains(range, wider->bounds().low);
      value.index = static_cast<std::uint32_t>(plan_.profiles.size());
      if (fits) plan_.profiles.push_back(std::move(wider));
    } else {
      continue;
    }
    if (fits) assign(slot, value);
    (fits ? widened.changed : widened.kept).emplace_back(name);
  }
  return widened;
}

void PointEdit::add(std::string_view parameter, std::int64_t number) {
  const std::size_t slot = slot_named(plan_, parameter);
  const Value value = value_of(slot);
  if (value.kind == Value::Kind::number) return set(slot, value.number + static_cast<double>(number));
  distributions::Distribution distribution = plan_.distributions[value.index];
  if (auto* integers = std::get_if<distributions::Integers>(&distribution)) {
    integers->low += number;
    integers->high += number;
  } else {
    for (double& one : std::get<distributions::Choice>(distribution).values)
      one += static_cast<double>(number);
  }
  assign(slot, drawn_from(value, std::move(distribution)));
}

std::string PointEdit::out_of_range() const {
  for (const Assignment& one : plan_.axes.back().assignments) {
    const parameters::Parameter& parameter = plan_.table.rows[one.slot];
    const ParameterRange limits = range_of(plan_, one.value);
    const numerics::Interval& range = parameter.range;
    const auto is_allowed = [&](double value) {
      return value == parameter.none || numerics::contains(range, value);
    };
    const bool drawn = one.value.kind == Value::Kind::distribution;
    if (drawn ? distributions::extremes_are_inside(plan_.distributions[one.value.index], range)
              : is_allowed(limits.low))
      continue;
    return fmt::format("{}: it would be {}; expected {}", parameter.name,
                       limits.low == limits.high ? fmt::format("{:.6g}", limits.low)
                                                 : fmt::format("{:.6g} to {:.6g}", limits.low, limits.high),
                       numerics::notation(range));
  }
  return "";
}

Study PointEdit::study() const {
  Study study = study_;
  study.plan = std::make_shared<const StudyPlan>(plan_);
  return study;
}

const Value& PointEdit::value_of(std::size_t slot) const {
  return *value_at_point(plan_, slot, point_);
}

void PointEdit::assign(std::size_t slot, const Value& value) {
  const auto number = static_cast<std::uint32_t>(slot);
  PlanAxis& axis = plan_.axes.back();
  const auto same =
      std::ranges::find_if(axis.assignments, [number](const Assignment& one) { return one.slot == number; });
  if (same != axis.assignments.end()) {
    same->value = value;
    return;
  }
  axis.assignments.push_back({number, value});
  axis.first.back() = static_cast<std::uint32_t>(axis.assignments.size());
  std::vector<std::uint32_t>& inputs = plan_.input_slots;
  if (std::ranges::find(inputs, number) == inputs.end()) inputs.push_back(number);
}

Value PointEdit::drawn_from(const Value& like, distributions::Distribution distribution) {
  Value value = like;
  value.index = static_cast<std::uint32_t>(plan_.distributions.size());
  plan_.distributions.push_back(std::move(distribution));
  return value;
}

}  // namespace zerocount::study
