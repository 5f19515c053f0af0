#include "analysis/summary/best_point.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "analysis/goal/question.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::summary {
namespace {

/// Swept parameters of the point that are other than 0 or none: the fewer, the simpler.
std::int64_t parts_in_use(const StudySummary& summary, std::size_t point) {
  return std::ranges::count_if(summary.axes, [&](const study::SweepAxis& axis) {
    if (axis.kind != study::SweepAxis::Kind::number) return false;
    const auto row = parameters::find_parameter(axis.name);
    const double value = axis.numbers[point];
    return value != 0.0 && !(row && parameters::parameter_table()[*row].none == value);
  });
}

/// Criteria for the best point, the most important first. Larger values are better.
std::vector<double> merits_of(const StudySummary& summary, std::size_t index) {
  if (summary.features.open_loop) return {};
  std::vector<double> merits = goal::merits_of(summary.question, summary.points[index]);
  merits.push_back(-static_cast<double>(parts_in_use(summary, index)));
  return merits;
}

}  // namespace

std::vector<std::int64_t> points_by_merit(const StudySummary& summary) {
  std::vector<std::pair<std::vector<double>, std::int64_t>> points;
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    if (summary.points[i].trials > 0)
      points.emplace_back(merits_of(summary, i), static_cast<std::int64_t>(i));
  }
  std::ranges::stable_sort(points, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::int64_t> order;
  order.reserve(points.size());
  for (const auto& [merits, point] : points) order.push_back(point);
  return order;
}

std::int64_t best_point(const StudySummary& summary) {
  const std::vector<std::int64_t> order = points_by_merit(summary);
  return order.empty() ? 0 : order.front();
}

}  // namespace zerocount::summary
