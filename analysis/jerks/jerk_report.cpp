#include "analysis/jerks/jerk_report.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "analysis/jerks/creep_comparison.hpp"
#include "experiments/study/condition_study.hpp"

namespace zerocount::jerks {

namespace {

/// @param file of the trials under `condition`
PointJerks jerks_at(const reading::AllTrialsFile& file, const std::string& condition, std::int64_t point,
                    double confidence, std::int64_t creep_trials) {
  const study::Study& study = file.study();
  PointJerks jerks;
  jerks.point = point;
  jerks.label = study::label_under(study.points.labels[static_cast<std::size_t>(point)], condition);
  if (!condition.empty()) jerks.condition = condition;
  jerks.statistics = jerk_statistics(file, study, point, confidence);
  jerks.creep = compare_with_creep(study, point, std::min(creep_trials, study.trials));
  const double sample_time = 1.0 / study::study_trial(study, point, 0).parameters.controller.sample_rate;
  jerks.creep_agreement = agreement_of(jerks.creep, sample_time);
  return jerks;
}

}  // namespace

JerkReport jerk_report(const reading::AllTrialsFile& file, std::vector<std::int64_t> points,
                       double confidence, std::int64_t creep_trials) {
  const study::Study& study = file.study();
  if (points.empty()) {
    points.resize(static_cast<std::size_t>(study::point_count(study)));
    std::iota(points.begin(), points.end(), 0);
  }
  JerkReport report{.name = study.name, .axis = study.units.axis, .confidence = confidence, .points = {}};
  reading::for_each_condition(file, [&](const reading::AllTrialsFile& one, const std::string& condition) {
    for (const std::int64_t point : points)
      report.points.push_back(jerks_at(one, condition, point, confidence, creep_trials));
  });
  std::ranges::stable_sort(report.points, {}, [&](const PointJerks& jerks) {
    return std::ranges::find(points, jerks.point) - points.begin();
  });
  return report;
}

bool any_arrival(const JerkReport& report) {
  return std::any_of(report.points.begin(), report.points.end(), [](const PointJerks& point) {
    return point.statistics.arrived > point.statistics.lost;
  });
}

}  // namespace zerocount::jerks
