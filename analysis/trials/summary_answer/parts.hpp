#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/basis/document/description.hpp"
#include "analysis/trials/goal/goal_verdict.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary/observed_comparison.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "analysis/trials/worlds/world_statistics.hpp"

/// The parts from which the answer on a summary is composed. Each part adds what it describes, if the study
/// has it: items to a design point in data, and to the summary a table for people with sentences.
namespace zerocount::summary_answer {

/// A design point with the results that depend on this point alone.
struct DescribedPoint {
  const summary::StudySummary& summary;
  std::int64_t point{0};
  bool marked{false};  ///< True if the point was chosen from several, so that tables mark it with a star.
  /// Verdict on the goal at this point; empty without a goal, and for a point without trials.
  std::optional<goal::Verdict> verdict{};
  std::optional<worlds::PointWorlds> worlds{};
  /// Comparison with the counts on the real machine; empty if no counts were observed.
  std::optional<summary::ObservedComparison> observed{};

  std::size_t index() const { return static_cast<std::size_t>(point); }
  const std::string& label() const { return summary.labels[index()]; }
  const measures::PointSummary& statistics() const { return summary.points[index()]; }
};

/// A torque level at a design point of an open-loop study.
struct LevelAtPoint {
  const DescribedPoint& point;
  std::size_t level{0};

  const measures::LevelStatistics& statistics() const { return point.statistics().levels[level]; }
};

/// A design point that was run again with a fresh seed, to confirm its result.
struct Confirmation {
  std::int64_t point{0};
  std::uint64_t seed{0};
  std::int64_t trials{0};
  std::int64_t machines{0};   ///< Number of machines on which the trials run; 0: no trials share one.
  std::int64_t successes{0};  ///< Number of trials in which all moves ended at zero error.
  /// [goal] Counts of the judged moves and of those that meet the goal.
  std::vector<measures::CellCounts> goals{};
};

/// Options for showing a summary: which design points, and with which explanations.
struct SummaryForm {
  std::vector<std::int64_t> points{};  ///< Indices of the design points to show, in their order; empty: all.
  /// Index of the design point of the headline; empty: the best point.
  std::optional<std::int64_t> chosen{};
  bool legend{false};  ///< True if an explanation of the tables' columns is added.
};

/// A summary of a study with all results that its answer needs.
struct SummaryResults {
  const summary::StudySummary& summary;
  summary::ChosenPoint chosen;
  std::vector<DescribedPoint> points;  ///< The design points that are shown, in their order.
  bool legend{false};
  std::optional<Confirmation> confirmation{};

  std::vector<LevelAtPoint> levels() const;
};

DescribedPoint read_point(const summary::StudySummary& summary, std::int64_t point);

/// Computes the results for the answer of a summary.
/// @param summary must outlive the result
/// @throws Failure (bad_data) if the summary is inconsistent
SummaryResults read_summary(const summary::StudySummary& summary, const SummaryForm& form = {});

/// An output item that appears in JSON only, not in the text for people.
inline document::Item in_json(std::string key, std::string meaning, std::string unit = {}) {
  return {.key = std::move(key),
          .meaning = std::move(meaning),
          .unit = std::move(unit),
          .shown = document::Visibility::in_json};
}

using PointDescription = document::Description<DescribedPoint>;
using SummaryDescription = document::Description<SummaryResults>;

/// The output items of a design point: in data with the names of datasets.md, and as a table row for people.
/// A column for people has its line of the legend as Item::meaning, or no meaning.
/// @param summary summary of the study; its points decide which columns people are shown
PointDescription point_description(const summary::StudySummary& summary);

/// The output items of a torque level of an open-loop study: in data, and as a table row for people.
document::Description<LevelAtPoint> level_description(const summary::StudySummary& summary);

/// The legend of a table: the meanings of the columns that people see, one line each.
std::string legend_of(const std::vector<document::Item>& columns);

/// A settling time as text, for a quantile over all moves of a design point or a bound of it: four
/// significant digits; "> 1 s" if the quantile is not reached within the hold, "> hold" if trials differ in
/// their hold; "–" if no move has a target.
/// @param time the quantile, s; NaN if not reached
std::string settling_text(const measures::PointSummary& point, double time);

/// Value of a swept parameter: a number, or the name of a case.
using AxisValue = std::variant<double, std::string>;
AxisValue value_at(const study::SweepAxis& axis, const DescribedPoint& point);

/// Adds the items that identify a point: number, label, and the swept parameters. If there are few swept
/// parameters, each has a column. The labels of a grid only repeat the swept values, so people see the number
/// of the point instead. A star marks the chosen point among several.
void add_axes(PointDescription& point, const summary::StudySummary& summary);

/// Head of a column of bounds: "95 % bounds", with the confidence of the summary.
std::string bounds_head(const summary::StudySummary& summary);

/// The number of trials that every design point has; empty if the points have different numbers.
std::optional<std::int64_t> trials_of_each(const summary::StudySummary& summary);

/// Adds the columns for people of a study with targets, the most important ones first: the criteria by which
/// the study is judged, then zero counts, arrival, jerks, stability and the paper's criteria. If the study
/// has a goal, the latter are in a separate table, zero_count_table().
void add_question_columns(PointDescription& point, const summary::StudySummary& summary);

/// Title of the table of zero counts; empty if the study is judged by zero counts and needs no separate
/// table.
inline const char* zero_count_table(const summary::StudySummary& summary) {
  return summary.question.goal() ? "zero counts" : "";
}

/// A function that returns the short label of a design point.
std::function<std::string(const DescribedPoint&)> short_label(const summary::StudySummary& summary);

void add_goal(PointDescription& point, const summary::StudySummary& summary);
document::Description<goal::ClaimVerdict> verdict_description(const goal::Question& question,
                                                              bool on_machines);

/// Adds to a design point the moves whose end does not decide their success: their numbers, and the hold time
/// that would decide them.
void add_undecided(PointDescription& point, const summary::StudySummary& summary);

/// Adds to a design point whether the counts on the real machine are consistent with the simulated trials.
void add_observed(PointDescription& point, const summary::StudySummary& summary);

/// Adds to a design point the proportions by world (draw of what all machines share), what the bad worlds
/// have in common, the results in each setting and at each age, and, for a study with several claims, each
/// goal in each setting.
void add_cells(PointDescription& point, const summary::StudySummary& summary);
/// Whether the study has several claims: several goals, or a goal in several settings.
bool has_several_claims(const summary::StudySummary& summary);
/// Adds a table for people of the claims on the chosen design point: each goal in each setting.
void add_claims(SummaryDescription& answer, const summary::StudySummary& summary);

/// Adds bounds of the success rate that hold although the study looked at the outcomes after every block and
/// decided the number of trials itself (`stop`).
///
/// With machines they bound the mean over the machines of the study, because the rule is about the trials of
/// these machines. Every machine has run equally many trials at each look. The product of the likelihood
/// ratios of trials with different probabilities pᵢ is on average no larger than for trials that all have the
/// mean probability (the geometric mean does not exceed the arithmetic mean). The bounds do not cover other
/// machines: more trials on the same machines do not tell how far others differ.
void add_stopping(PointDescription& point, const summary::StudySummary& summary);

/// Adds tolerance statements: what the trials of a point show about all machines that the manifest describes.
void add_assurance(PointDescription& point, const summary::StudySummary& summary);

/// Adds to a design point the repeatability by ISO 230-2, for a study with a test sequence of targets.
void add_repeatability(PointDescription& point, const summary::StudySummary& summary);
void add_repeatability(SummaryDescription& answer, const summary::StudySummary& summary);

}  // namespace zerocount::summary_answer
