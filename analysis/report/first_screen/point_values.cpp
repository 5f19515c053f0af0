#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/report/first_screen/first_screen.hpp"
#include "experiments/study/plan.hpp"

namespace zerocount::report {
namespace {

std::string_view level_text(study::DrawLevel level) {
  switch (level) {
    case study::DrawLevel::study:
      return "drawn once";
    case study::DrawLevel::world:
      return "per world";
    case study::DrawLevel::machine:
      return "per machine";
    case study::DrawLevel::trial:
      return "per trial";
    case study::DrawLevel::contact:
      break;
  }
  return "per contact";
}

/// The text of a list of values with non-breaking spaces, so that lines break only after a comma and beside
/// "…".
std::string unbroken(std::string text) {
  constexpr std::string_view no_break_space = "\u00a0", to = "…";
  const auto may_break = [&](std::size_t at) {
    const std::string_view before = std::string_view(text).substr(0, at);
    return before.ends_with(',') || before.ends_with(to) ||
           std::string_view(text).substr(at + 1).starts_with(to);
  };
  for (std::size_t at = text.find(' '); at != std::string::npos; at = text.find(' ', at + 1))
    if (!may_break(at)) text.replace(at, 1, no_break_space);
  return text;
}

}  // namespace

std::string quantity_text(double value, std::string_view unit) {
  return unbroken(text::quantity_text(value, unit));
}

std::string range_text(double low, double high, std::string_view unit) {
  return unbroken(text::range_text(low, high, unit));
}

std::string list_text(std::span<const double> values, std::string_view unit) {
  return unbroken(text::list_text(values, unit));
}
std::size_t PointValues::slot_of(std::string_view name) const {
  return study::find_slots(name, study_.plan->table).value().first;
}

study::ParameterRange PointValues::limits(std::size_t slot) const {
  study::ParameterRange all =
      study::range_of_slot(*study_.plan, slot, study::plan_point(*study_.plan, point_));
  for (std::int64_t setting = 1; setting < study_.plan->settings.total(); ++setting) {
    const study::ParameterRange one =
        study::range_of_slot(*study_.plan, slot, study::plan_point(*study_.plan, point_, setting));
    all.low = std::min(all.low, one.low);
    all.high = std::max(all.high, one.high);
  }
  return all;
}

std::vector<double> PointValues::typical_values(std::size_t slot) const {
  std::vector<double> values;
  for (std::int64_t setting = 0; setting < study_.plan->settings.total(); ++setting)
    values.push_back(
        study::range_of_slot(*study_.plan, slot, study::plan_point(*study_.plan, point_, setting)).typical);
  return values;
}

study::ParameterRange PointValues::limits(std::string_view name) const {
  return limits(slot_of(name));
}

bool PointValues::is_none(std::string_view name) const {
  return limits(name).low == study_.plan->table.rows[slot_of(name)].none;
}

std::string PointValues::text(std::size_t slot) const {
  const parameters::Parameter& parameter = study_.plan->table.rows[slot];
  const study::ParameterRange range = limits(slot);
  if (parameters::has_labels(parameter))
    return std::string(parameter.labels[static_cast<std::size_t>(range.low)]);
  if (range.low == parameter.none) return "none";
  const std::string unit = parameters::unit_of(parameter, study_.plan->units);
  if (std::isfinite(range.low) && std::isfinite(range.high)) return range_text(range.low, range.high, unit);
  const auto [least, largest] = std::ranges::minmax(typical_values(slot));
  return "about " + (least == largest ? quantity_text(least, unit) : range_text(least, largest, unit));
}

bool PointValues::has(std::string_view name) const {
  return study::find_slots(name, study_.plan->table).has_value();
}

std::string PointValues::text(std::string_view name) const {
  const study::SlotRange slots = study::find_slots(name, study_.plan->table).value();
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < slots.count; ++i) texts.push_back(text(slots.first + i));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string PointValues::draw_text(std::size_t slot) const {
  const study::Value& value =
      *study::value_at_point(*study_.plan, slot, study::plan_point(*study_.plan, point_));
  if (value.kind == study::Value::Kind::profile) return "along the axis";
  return value.kind == study::Value::Kind::distribution ? std::string(level_text(value.level)) : "";
}

}  // namespace zerocount::report
