#include "analysis/report/reported_study.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/summary/best_point.hpp"
#include "analysis/summary/summary.hpp"
#include "results/layout/header.hpp"

namespace zerocount::report {

ReportedStudy reported_study(const reading::StudyFile& file) {
  ReportedStudy reported{file, layout::recorded_study(file.header(), file.path()), summary::summarise(file)};
  reported.bounds_name = reported.study.stop   ? "bounds that hold at whatever trial one stops"
                         : reported.study.rigs ? "Korn-Graubard bounds"
                                               : "Clopper-Pearson bounds";
  for (const measures::PointSummary& point : reported.summary.points)
    reported.success_bounds.push_back(
        summary::bounds_of_chosen(point, 1, reported.study.stop.has_value(), statistics::summary_confidence));
  reported.focus = summary::best_point(reported.summary);
  return reported;
}

std::int64_t most_telling_point(const std::vector<measures::PointSummary>& points) {
  const auto distance = [](const measures::PointSummary& point) {
    return std::abs(point.success_rate().value - 0.5);
  };
  return std::min_element(points.begin(), points.end(),
                          [&](const auto& a, const auto& b) { return distance(a) < distance(b); }) -
         points.begin();
}

layout::RowRange rows_of(const ReportedStudy& reported, std::int64_t point) {
  const std::int64_t trials = reported.file.header().trials;
  return {point * trials, trials};
}

std::string axis_title(const study::SweepAxis& axis) {
  if (axis.unit.empty() || axis.unit == "1") return axis.name;
  return fmt::format("{} ({})", axis.name, axis.unit);
}

std::string proportion_text(double proportion) {
  if (proportion == 1.0) return "100 %";
  const double distance = std::min(proportion, 1.0 - proportion);
  const int digits =
      distance > 0.0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(distance))) - 1, 1, 9) : 0;
  return fmt::format("{:.{}f} %", 100.0 * proportion, digits);
}

}  // namespace zerocount::report
