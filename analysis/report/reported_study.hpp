#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/grouping.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::report {

struct ReportedStudy;

/// The trials of a study in one setting (condition at an age), treated as a study of its own.
struct ReportedSetting {
  std::string name;
  /// Trials of the setting (condition at an age), as a results file of their own, to which `study` refers.
  std::shared_ptr<const reading::AllTrialsFile> file;
  /// Study of the trials in the setting, with the chosen point of the whole study.
  std::shared_ptr<const ReportedStudy> study;
};

/// A results file with the data that several parts of the report need.
struct ReportedStudy {
  const reading::AllTrialsFile& file;
  const study::Study& study;
  summary::StudySummary summary;
  summary::ChosenPoint chosen{};     ///< Design point that the page describes, and how it was chosen.
  std::vector<std::string> names{};  ///< [point] Short label of the design point.
  /// [setting] Results in each setting (condition at an age); empty without settings.
  std::vector<ReportedSetting> settings{};
  std::size_t worst_setting{0};  ///< Index of the worst setting at the chosen point.
};

/// Whether figures distinguish the settings of the study.
inline bool has_settings(const ReportedStudy& reported) {
  return !reported.settings.empty();
}
/// The results in the setting (condition at an age) that is the worst at the chosen point; the study itself
/// without settings.
const ReportedStudy& worst_of_settings(const ReportedStudy& reported);
/// Introduction to results of worst_of_settings(): "Under loaded, the worst condition. "; empty without
/// settings.
std::string worst_setting_phrase(const ReportedStudy& reported);

/// One line of a figure that compares points: all trials, or the trials in one setting.
struct ReportedPart {
  std::string setting;  ///< Name of the setting (condition at an age); empty without settings.
  const ReportedStudy& study;
};
/// The lines of a figure that compares points: one for each setting; without settings, one for the whole
/// study.
std::vector<ReportedPart> parts_of(const ReportedStudy& reported);

/// The short label of a design point.
inline const std::string& label_of(const ReportedStudy& reported, std::int64_t point) {
  return reported.names[static_cast<std::size_t>(point)];
}
/// The label of a design point in a figure, with a star if it is the chosen one of several.
std::string marked_label_of(const ReportedStudy& reported, std::int64_t point);
/// The points that every figure shows: the chosen point, the first point of the study as a baseline, and the
/// runner-up.
std::vector<std::int64_t> leading_points(const ReportedStudy& reported);
inline const measures::PointSummary& point_of(const ReportedStudy& reported, std::int64_t point) {
  return reported.summary.points[static_cast<std::size_t>(point)];
}
/// The question by which the study is judged: its goals or, without a goal, success (zero error at the end of
/// moves).
inline const goal::Question& question_of(const ReportedStudy& reported) {
  return reported.summary.question;
}
/// The rate by which figures compare design points: that of success, or of moves or machines that meet the
/// goal.
goal::QuestionRate shown_rate(const ReportedStudy& reported, std::int64_t point);
/// Description of the bounds of shown_rate(): "one-sided 95 % bounds", "95 % Clopper-Pearson bounds".
std::string shown_bounds(const ReportedStudy& reported);

/// Note for results of a study with dependent trials (StudyFeatures::dependent_trials).
inline constexpr std::string_view dependence_sentence =
    "The trials of a saltelli design are not independent: those of a row share most of their draws.";
/// Largest distance of a settled move from its target as text: "1 count", "10 nm".
std::string precision_text(const ReportedStudy& reported, const study::Goal& goal);

/// Makes the report's data from a results file. Reads the whole file once, and once more for each setting
/// (condition at an age).
/// @param file a complete study.
/// @param point design point that the page describes; nothing: the best
/// @throws Failure (bad_input) if there is no such point
ReportedStudy reported_study(const reading::AllTrialsFile& file, std::optional<std::int64_t> point = {});

/// The rows of the results file that hold the trials of a design point.
layout::RowRange rows_of(const ReportedStudy& reported, std::int64_t point);

/// The distinct values of a swept parameter, sorted.
std::vector<double> values_of(const study::SweepAxis& axis);

/// Design points that differ only in the swept parameters `along` of groups_along().
struct PointGroup {
  std::string label;  ///< Values of the other swept parameters as text; empty if there are none.
  std::vector<std::int64_t> points;  ///< Indices of the points, increasing.
};

/// All design points divided into groups that differ only in the swept parameters with the indices `along`,
/// in the order of the groups' first points.
std::vector<PointGroup> groups_along(const ReportedStudy& reported, const std::vector<std::size_t>& along);

/// Indices of the sweep's parameters that can be an axis of a figure: numbers at every point that have at
/// least `min_values` values while all other parameters are constant. (This excludes parameters set by
/// cases.) The parameter with the most values comes first.
std::vector<std::size_t> numeric_axes(const ReportedStudy& reported, std::size_t min_values);

}  // namespace zerocount::report
