#include <limits>
#include <set>

#include <fmt/format.h>

#include "experiments/sections/sections.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::sections {

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

study::SweepAxis empty_axis(std::size_t slot, const study::StudyPlan& plan, std::size_t points) {
  const parameters::Parameter& parameter = plan.table.rows[slot];
  study::SweepAxis axis;
  axis.name = parameter.name;
  axis.unit = parameters::unit_of(parameter, plan.units);
  axis.meaning = parameters::meaning_of(parameter, plan.units);
  if (parameters::has_labels(parameter)) {
    axis.kind = study::SweepAxis::Kind::text;
    axis.unit.clear();
    axis.texts.reserve(points);
  } else {
    axis.numbers.reserve(points);
  }
  return axis;
}

void append_value(study::SweepAxis& axis, const parameters::Parameter& parameter, const study::Value& value) {
  if (axis.kind == study::SweepAxis::Kind::text) {
    axis.texts.emplace_back(parameter.labels[static_cast<std::size_t>(value.number)]);
  } else {
    axis.numbers.push_back(
        value.kind == study::Value::Kind::number ? value.number : std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace

std::vector<study::SweepAxis> describe_axes(const std::vector<SweptAxis>& axes,
                                            const study::StudyPlan& plan) {
  std::size_t points = 1;
  for (const SweptAxis& axis : axes) points *= axis.labels.size();
  const auto place_of = [&](std::size_t point) {
    return study::plan_point(plan, static_cast<std::int64_t>(point));
  };
  std::vector<study::SweepAxis> described;
  std::set<std::size_t> shown;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].cases) {
      study::SweepAxis names;
      names.name = axes[a].name;
      names.meaning = "name of the case";
      names.kind = study::SweepAxis::Kind::text;
      for (std::size_t point = 0; point < points; ++point)
        names.texts.push_back(axes[a].labels[study::option_at(plan, a, place_of(point))]);
      described.push_back(std::move(names));
    }
    for (const std::size_t slot : axes[a].slots) {
      if (!shown.insert(slot).second) continue;  // swept by the cases and by the grid
      study::SweepAxis axis = empty_axis(slot, plan, points);
      for (std::size_t point = 0; point < points; ++point)
        append_value(axis, plan.table.rows[slot], *study::value_at_point(plan, slot, place_of(point)));
      described.push_back(std::move(axis));
    }
  }
  return described;
}

}  // namespace zerocount::sections
