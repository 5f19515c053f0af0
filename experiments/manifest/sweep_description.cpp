#include <limits>
#include <set>

#include <fmt/format.h>

#include "experiments/manifest/sweep.hpp"
#include "experiments/study/slots.hpp"

namespace zerocount {

std::vector<std::string> label_points(const std::vector<SweptAxis>& axes) {
  std::vector<std::string> labels{axes.empty() ? "all" : ""};
  for (const SweptAxis& axis : axes) {
    std::vector<std::string> longer;
    longer.reserve(labels.size() * axis.labels.size());
    for (const std::string& label : labels) {
      for (const std::string& option : axis.labels) {
        longer.push_back(label.empty() ? option : fmt::format("{}, {}", label, option));
      }
    }
    labels = std::move(longer);
  }
  return labels;
}

namespace {

SweepAxis empty_axis(std::size_t slot, const StudyPlan& plan, std::size_t points) {
  const Parameter& parameter = parameter_table()[row_of_slot(slot, plan.list)];
  SweepAxis axis;
  axis.name = slot_name(slot, plan.list);
  axis.unit = unit_of(parameter, plan.units);
  axis.meaning = meaning_of(parameter, plan.units);
  if (has_labels(parameter)) {
    axis.kind = SweepAxis::Kind::text;
    axis.unit.clear();
    axis.texts.reserve(points);
  } else {
    axis.numbers.reserve(points);
  }
  return axis;
}

void append_value(SweepAxis& axis, std::size_t slot, const Value& value) {
  if (axis.kind == SweepAxis::Kind::text) {
    axis.texts.emplace_back(parameter_table()[slot].labels[static_cast<std::size_t>(value.number)]);
  } else {
    axis.numbers.push_back(value.kind == Value::Kind::number ? value.number
                                                             : std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace

std::vector<SweepAxis> describe_axes(const std::vector<SweptAxis>& axes, const StudyPlan& plan) {
  std::size_t points = 1;
  for (const SweptAxis& axis : axes) points *= axis.labels.size();
  std::vector<SweepAxis> described;
  std::set<std::size_t> shown;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].cases) {
      SweepAxis names;
      names.name = axes[a].name;
      names.meaning = "name of the case";
      names.kind = SweepAxis::Kind::text;
      for (std::size_t point = 0; point < points; ++point)
        names.texts.push_back(axes[a].labels[option_at(plan, a, point)]);
      described.push_back(std::move(names));
    }
    for (const std::size_t slot : axes[a].slots) {
      if (!shown.insert(slot).second) continue;  // swept by the cases and by the grid
      SweepAxis axis = empty_axis(slot, plan, points);
      for (std::size_t point = 0; point < points; ++point)
        append_value(axis, slot, *value_at_point(plan, slot, point));
      described.push_back(std::move(axis));
    }
  }
  return described;
}

}  // namespace zerocount
