#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/measures/trial_value.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/summary/summary.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount::report {

/// A results file with the data that several parts of the report need.
struct ReportedStudy {
  const reading::StudyFile& file;
  study::Study study;
  summary::StudySummary summary;
  std::vector<statistics::ConfidenceInterval> success_bounds{};  ///< 95 %, [point]
  std::string bounds_name{};                                     ///< kind of these bounds, for captions
  std::int64_t focus{0};                                         ///< design point of the single trials
};

/// The label, the statistics and the success bounds of a point.
inline const std::string& label_of(const ReportedStudy& reported, std::int64_t point) {
  return reported.summary.labels[static_cast<std::size_t>(point)];
}
inline const measures::PointSummary& point_of(const ReportedStudy& reported, std::int64_t point) {
  return reported.summary.points[static_cast<std::size_t>(point)];
}
inline const statistics::ConfidenceInterval& bounds_of(const ReportedStudy& reported, std::int64_t point) {
  return reported.success_bounds[static_cast<std::size_t>(point)];
}

/// Note for results of a study with dependent trials (StudyFeatures::dependent_trials).
inline constexpr std::string_view dependence_sentence =
    "The trials of a saltelli design are not independent: those of a row share most of their draws.";
inline constexpr std::string_view too_narrow_sentence =
    "Bounds assume independent trials, and are too narrow here.";

/// Reads the whole file once. The focus is the best point.
/// @param file a complete study.
ReportedStudy reported_study(const reading::StudyFile& file);

/// The point whose success rate is nearest to one half. It has the most information about the causes of
/// failures.
std::int64_t most_telling_point(const std::vector<measures::PointSummary>& points);

/// The global rows of the trials of a point.
layout::RowRange rows_of(const ReportedStudy& reported, std::int64_t point);

/// "controller.ki (N m/count)".
std::string axis_title(const study::SweepAxis& axis);

/// A proportion as a percentage with enough digits to differ from 100 %; only 1 is "100 %".
std::string proportion_text(double proportion);

/// The distinct values of an axis, sorted.
std::vector<double> values_of(const study::SweepAxis& axis);

/// Points that differ only in the axes `along`.
struct PointGroup {
  std::string label;                 ///< the values of the other axes; empty without other axes
  std::vector<std::int64_t> points;  ///< increasing
};

/// All points divided into such groups, in the order of their first points.
std::vector<PointGroup> groups_along(const ReportedStudy& reported, const std::vector<std::size_t>& along);

/// Indices of the sweep's axes that are numbers at every point and have at least `min_values` values
/// while all others are constant (this excludes keys set by cases). The axis with the most values comes
/// first.
std::vector<std::size_t> numeric_axes(const ReportedStudy& reported, std::size_t min_values);

}  // namespace zerocount::report
