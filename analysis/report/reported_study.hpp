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

/// The trials in one setting, as a study of its own.
struct ReportedSetting {
  std::string name;
  std::shared_ptr<const reading::AllTrialsFile> file;  ///< Results file to which `study` refers.
  /// Study of the trials in the setting, with the chosen point of the whole study.
  std::shared_ptr<const ReportedStudy> study;
};

/// A results file with the data that several parts of the report need.
struct ReportedStudy {
  const reading::AllTrialsFile& file;
  const study::Study& study;
  summary::StudySummary summary;
  summary::ChosenPoint chosen{};            ///< Design point that the page describes.
  std::vector<std::string> names{};         ///< [point] Short label.
  std::vector<ReportedSetting> settings{};  ///< empty without settings
  std::size_t worst_setting{0};             ///< Index of the worst setting at the chosen point.
};

/// Whether figures distinguish the settings of the study.
inline bool has_settings(const ReportedStudy& reported) {
  return !reported.settings.empty();
}
/// The trials in the setting that is the worst at the chosen point; the study itself without settings.
const ReportedStudy& worst_of_settings(const ReportedStudy& reported);
/// Introduction to results of worst_of_settings(): "Under loaded, the worst condition. "; empty without
/// settings.
std::string worst_setting_phrase(const ReportedStudy& reported);

/// One line of a figure that compares points: all trials, or the trials in one setting.
struct ReportedPart {
  std::string setting;  ///< empty without settings
  const ReportedStudy& study;
};
/// A part for each setting; without settings the study itself.
std::vector<ReportedPart> parts_of(const ReportedStudy& reported);

/// The short label of a point.
inline const std::string& label_of(const ReportedStudy& reported, std::int64_t point) {
  return reported.names[static_cast<std::size_t>(point)];
}
/// The label in a figure, with a star at the chosen one of several points.
std::string marked_label_of(const ReportedStudy& reported, std::int64_t point);
/// The points that every figure shows: the chosen point, the first point of the study as a baseline, and the
/// runner-up.
std::vector<std::int64_t> leading_points(const ReportedStudy& reported);
inline const measures::PointSummary& point_of(const ReportedStudy& reported, std::int64_t point) {
  return reported.summary.points[static_cast<std::size_t>(point)];
}
/// The question by which the study is judged.
inline const goal::Question& question_of(const ReportedStudy& reported) {
  return reported.summary.question;
}
/// The rate that figures compare points by.
goal::QuestionRate shown_rate(const ReportedStudy& reported, std::int64_t point);
/// Description of the bounds of shown_rate(): "one-sided 95 % bounds", "95 % Clopper-Pearson bounds".
std::string shown_bounds(const ReportedStudy& reported);

/// Note for results of a study with dependent trials (StudyFeatures::dependent_trials).
inline constexpr std::string_view dependence_sentence =
    "The trials of a saltelli design are not independent: those of a row share most of their draws.";
/// Largest distance of a settled move from its target as text: "1 count", "10 nm".
std::string precision_text(const ReportedStudy& reported, const study::Goal& goal);

/// Reads the whole file once, and with settings once more for each of them.
/// @param file a complete study.
/// @param point design point that the page describes; nothing: the best
/// @throws Failure (bad_input) if there is no such point
ReportedStudy reported_study(const reading::AllTrialsFile& file, std::optional<std::int64_t> point = {});

/// The global rows of the trials of a point.
layout::RowRange rows_of(const ReportedStudy& reported, std::int64_t point);

/// The distinct values of an axis, sorted.
std::vector<double> values_of(const study::SweepAxis& axis);

/// Points that differ only in the axes `along`.
struct PointGroup {
  std::string label;                 ///< Values of the other axes; empty without other axes.
  std::vector<std::int64_t> points;  ///< Points in increasing order.
};

/// All points divided into groups that differ only in the axes `along`, in the order of the groups' first
/// points.
std::vector<PointGroup> groups_along(const ReportedStudy& reported, const std::vector<std::size_t>& along);

/// Indices of the sweep's axes that are numbers at every point and have at least `min_values` values
/// while all others are constant (this excludes keys set by cases). The axis with the most values comes
/// first.
std::vector<std::size_t> numeric_axes(const ReportedStudy& reported, std::size_t min_values);

}  // namespace zerocount::report
