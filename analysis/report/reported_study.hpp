#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/goal/question.hpp"
#include "analysis/measures/trial_value.hpp"
#include "analysis/summary/chosen_point.hpp"
#include "analysis/summary/summary.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/grouping.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::report {

struct ReportedStudy;

/// The trials under one condition, as a study of its own.
struct ReportedCondition {
  std::string name;
  std::shared_ptr<const reading::AllTrialsFile> file;  ///< that `study` refers to
  std::shared_ptr<const ReportedStudy> study;          ///< with the chosen point of all
};

/// A results file with the data that several parts of the report need.
struct ReportedStudy {
  const reading::AllTrialsFile& file;
  const study::Study& study;
  summary::StudySummary summary;
  summary::ChosenPoint chosen{};                ///< that the page speaks of
  std::vector<std::string> names{};             ///< [point] short labels
  std::vector<ReportedCondition> conditions{};  ///< empty without conditions
  std::size_t worst_condition{0};               ///< at the chosen point
};

/// Whether figures tell the conditions of the study apart.
inline bool has_conditions(const ReportedStudy& reported) {
  return !reported.conditions.empty();
}
/// The trials under the condition that is the worst at the chosen point; the study itself without conditions.
const ReportedStudy& worst_of_conditions(const ReportedStudy& reported);
/// "Under loaded, the worst condition. ", for what is of worst_of_conditions(); empty without conditions.
std::string worst_condition_text(const ReportedStudy& reported);

/// One line of a figure that compares points: of all trials, or of those under a condition.
struct ReportedPart {
  std::string condition;  ///< empty without conditions
  const ReportedStudy& study;
};
/// A part for each condition; without conditions the study itself.
std::vector<ReportedPart> parts_of(const ReportedStudy& reported);

/// The label, the statistics and the success bounds of a point.
inline const std::string& label_of(const ReportedStudy& reported, std::int64_t point) {
  return reported.names[static_cast<std::size_t>(point)];
}
/// The label in a figure, with a star at the chosen one of several points.
std::string marked_label_of(const ReportedStudy& reported, std::int64_t point);
/// The chosen point, the first of the study as its baseline, and the runner-up: every figure has them.
std::vector<std::int64_t> leading_points(const ReportedStudy& reported);
inline const measures::PointSummary& point_of(const ReportedStudy& reported, std::int64_t point) {
  return reported.summary.points[static_cast<std::size_t>(point)];
}
/// What the study is judged by.
inline const goal::Question& question_of(const ReportedStudy& reported) {
  return reported.summary.question;
}
/// The rate that figures compare points by.
goal::QuestionRate shown_rate(const ReportedStudy& reported, std::int64_t point);
/// Its bounds: "one-sided 95 % bounds", "95 % Clopper-Pearson bounds".
std::string shown_bounds(const ReportedStudy& reported);

/// Note for results of a study with dependent trials (StudyFeatures::dependent_trials).
inline constexpr std::string_view dependence_sentence =
    "The trials of a saltelli design are not independent: those of a row share most of their draws.";
/// How near a move that settles is to its target: "1 count", "10 nm".
std::string precision_text(const ReportedStudy& reported, const study::Goal& goal);

/// Reads the whole file once, and under conditions once more for each.
/// @param file a complete study.
/// @param point that the page speaks of; nothing: the best
/// @throws Failure (bad_input) if there is no such point
ReportedStudy reported_study(const reading::AllTrialsFile& file, std::optional<std::int64_t> point = {});

/// The global rows of the trials of a point.
layout::RowRange rows_of(const ReportedStudy& reported, std::int64_t point);

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
