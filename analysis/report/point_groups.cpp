#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/report/reported_study.hpp"

namespace zerocount::report {
namespace {

std::string value_text(const study::SweepAxis& axis, std::size_t point) {
  if (axis.kind == study::SweepAxis::Kind::text)
    return axis.name == "case" ? axis.texts[point] : fmt::format("{} {}", axis.name, axis.texts[point]);
  return fmt::format("{} {}", axis.name, text::short_number(axis.numbers[point]));
}

}  // namespace

std::vector<double> values_of(const study::SweepAxis& axis) {
  std::vector<double> values = axis.numbers;
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::vector<PointGroup> groups_along(const ReportedStudy& reported, const std::vector<std::size_t>& along) {
  std::vector<PointGroup> groups;
  const std::vector<study::SweepAxis>& axes = reported.summary.axes;
  for (std::size_t point = 0; point < reported.summary.points.size(); ++point) {
    std::string label;
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      if (std::find(along.begin(), along.end(), axis) != along.end()) continue;
      label += (label.empty() ? "" : ", ") + value_text(axes[axis], point);
    }
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const PointGroup& g) { return g.label == label; });
    if (group == groups.end()) group = groups.insert(groups.end(), PointGroup{label, {}});
    group->points.push_back(static_cast<std::int64_t>(point));
  }
  return groups;
}

std::vector<std::size_t> numeric_axes(const ReportedStudy& reported, std::size_t min_values) {
  std::vector<std::size_t> found;
  const std::vector<study::SweepAxis>& axes = reported.summary.axes;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::vector<double>& numbers = axes[i].numbers;
    if (axes[i].kind != study::SweepAxis::Kind::number ||
        !std::all_of(numbers.begin(), numbers.end(), [](double value) { return std::isfinite(value); })) {
      continue;
    }
    const std::vector<PointGroup> groups = groups_along(reported, {i});
    if (std::all_of(groups.begin(), groups.end(),
                    [&](const PointGroup& group) { return group.points.size() >= min_values; })) {
      found.push_back(i);
    }
  }
  std::stable_sort(found.begin(), found.end(), [&](std::size_t a, std::size_t b) {
    return values_of(axes[a]).size() > values_of(axes[b]).size();
  });
  return found;
}

}  // namespace zerocount::report
