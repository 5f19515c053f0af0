#include "analysis/jerks/jerk_report.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "analysis/jerks/creep_comparison.hpp"

namespace zerocount::jerks {

JerkReport jerk_report(const reading::AllTrialsFile& file, const study::Study& study,
                       std::vector<std::int64_t> points, double confidence, std::int64_t creep_trials) {
  if (points.empty()) {
    points.resize(static_cast<std::size_t>(study::point_count(study)));
    std::iota(points.begin(), points.end(), 0);
  }
  JerkReport report{.name = study.name, .axis = study.units.axis, .confidence = confidence, .points = {}};
  for (const std::int64_t point : points) {
    PointJerks jerks{.point = point, .label = {}, .statistics = {}, .creep = {}, .creep_agreement = {}};
    jerks.statistics = jerk_statistics(file, study, point, confidence);
    jerks.label = study.points.labels[static_cast<std::size_t>(point)];
    jerks.creep = compare_with_creep(study, point, std::min(creep_trials, file.header().trials));
    const double sample_time = 1.0 / study::study_trial(study, point, 0).parameters.controller.sample_rate;
    jerks.creep_agreement = agreement_of(jerks.creep, sample_time);
    report.points.push_back(std::move(jerks));
  }
  return report;
}

bool any_arrival(const JerkReport& report) {
  return std::any_of(report.points.begin(), report.points.end(), [](const PointJerks& point) {
    return point.statistics.arrived > point.statistics.lost;
  });
}

}  // namespace zerocount::jerks
