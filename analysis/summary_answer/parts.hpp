#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/chosen_point.hpp"
#include "analysis/summary/observed_comparison.hpp"
#include "analysis/summary/summary.hpp"
#include "analysis/worlds/world_statistics.hpp"

/// The parts that descriptions of a summary are put together of. Each adds what the study has of it: to a
/// point its items, to the summary its table for people and the sentences on it.
namespace zerocount::summary_answer {

/// A design point, with what is found out of it alone.
struct PointReading {
  const summary::StudySummary& summary;
  std::int64_t point{0};
  bool marked{false};                      ///< it is the chosen one of several
  std::optional<goal::Verdict> verdict{};  ///< with a goal, of a point with trials
  std::optional<worlds::PointWorlds> worlds{};
  std::optional<summary::ObservedComparison> observed{};  ///< where counts were observed on the real machine

  std::size_t index() const { return static_cast<std::size_t>(point); }
  const std::string& label() const { return summary.labels[index()]; }
  const measures::PointSummary& statistics() const { return summary.points[index()]; }
};

/// The level of a point of an open-loop study.
struct LevelReading {
  const PointReading& point;
  std::size_t level{0};

  const measures::LevelStatistics& statistics() const { return point.statistics().levels[level]; }
};

/// A design point run again with a fresh seed.
struct Confirmation {
  std::int64_t point{0};
  std::uint64_t seed{0};
  std::int64_t trials{0};
  std::int64_t machines{0};                   ///< 0: no trials share one that they were drawn for
  std::int64_t successes{0};                  ///< trials all of whose moves ended at zero error
  std::vector<measures::CellCounts> goals{};  ///< [goal]
};

/// How a summary is shown.
struct SummaryForm {
  std::vector<std::int64_t> points{};    ///< that are shown, in their order; empty: all
  std::optional<std::int64_t> chosen{};  ///< point that the headline is of; nothing: the best
  bool legend{false};                    ///< the columns of the tables are explained
};

/// A summary with all that its answer needs.
struct SummaryReading {
  const summary::StudySummary& summary;
  summary::ChosenPoint chosen;
  std::vector<PointReading> points;  ///< those that are shown, in their order
  bool legend{false};
  std::optional<Confirmation> confirmation{};

  std::vector<LevelReading> levels() const;
};

PointReading read_point(const summary::StudySummary& summary, std::int64_t point);

/// @param summary stays as long as the reading
/// @throws Failure (bad_data) unless the summary is consistent
SummaryReading read_summary(const summary::StudySummary& summary, const SummaryForm& form = {});

/// An item that is shown in JSON only.
inline document::Item in_json(std::string key, std::string meaning, std::string unit = {}) {
  return {.key = std::move(key),
          .meaning = std::move(meaning),
          .unit = std::move(unit),
          .shown = document::Shown::in_json};
}

using PointDescription = document::Description<PointReading>;
using SummaryDescription = document::Description<SummaryReading>;

/// A design point in data, by names as in datasets.md, and as a row for people: what the study has. A column
/// for people has its line of the legend as its meaning, or none.
/// @param summary of the study; its points decide which columns people are shown
PointDescription point_description(const summary::StudySummary& summary);

/// A level of a point of an open-loop study, likewise.
document::Description<LevelReading> level_description(const summary::StudySummary& summary);

/// The meanings of the columns for people, a line each.
std::string legend_of(const std::vector<document::Item>& columns);

/// A quantile of the settling times of all moves of a point, or a bound of it, as text: four significant
/// digits, "> 1 s" if it is not reached within the hold, "> hold" if trials differ in theirs, "–" if there is
/// no move with a target.
/// @param time s; NaN if not reached
std::string settling_text(const measures::PointSummary& point, double time);

/// A number, or the name of a case.
using AxisValue = std::variant<double, std::string>;
AxisValue value_at(const study::SweepAxis& axis, const PointReading& point);

/// What tells points apart: number, label, and the swept parameters, with a column for each where these are
/// few. In a grid, whose labels only repeat the swept values, people are shown the number of the point in
/// place of the label. A star marks the chosen point among several.
void add_axes(PointDescription& point, const summary::StudySummary& summary);

/// "95 % bounds", with the confidence of the summary.
std::string bounds_head(const summary::StudySummary& summary);

/// The number of trials of every point; nothing where points differ in it.
std::optional<std::int64_t> trials_of_each(const summary::StudySummary& summary);

/// The columns for people of a study with targets, the most important first: what the study is judged by,
/// then zero counts, arrival, jerks, stability and the paper's criteria, in a table of their own where the
/// study has a goal.
void add_question_columns(PointDescription& point, const summary::StudySummary& summary);

/// The title of that table; empty where a study is judged by zero counts.
inline const char* zero_count_table(const summary::StudySummary& summary) {
  return summary.question.claim() ? "zero counts" : "";
}

/// The short labels of the points.
std::function<std::string(const PointReading&)> short_label(const summary::StudySummary& summary);

/// The description of the table of a part, with the column "point".
PointDescription labelled_points(const summary::StudySummary& summary);

void add_goal(PointDescription& point, const summary::StudySummary& summary);
document::Description<goal::ClaimVerdict> verdict_description(const goal::Question& question,
                                                              bool on_machines);

/// Moves that are off target: their numbers, and the hold that would decide them.
void add_undecided(PointDescription& point, const summary::StudySummary& summary);

/// Whether the counts on the real machine are consistent with the simulated trials.
void add_observed(PointDescription& point, const summary::StudySummary& summary);

/// The rates of the worlds, and what the bad ones have in common; the point under each condition, at each
/// age; and of a study with several claims each goal under each condition.
void add_cells(PointDescription& point, const summary::StudySummary& summary);
/// Whether the study claims several things: goals, or one under several conditions.
bool has_several_claims(const summary::StudySummary& summary);
/// The claims on the chosen point, for people.
void add_claims(SummaryDescription& answer, const summary::StudySummary& summary);

/// The bounds of the success rate that hold although the study looked after every block and decided itself
/// how many trials it took (`stop`).
///
/// With machines they are bounds of the mean over the machines of the study, whose trials the rule is about:
/// every machine has run equally many at each look, and the product of the likelihood ratios of trials with
/// different probabilities pᵢ is no larger on average than that of trials which all have their mean (the
/// geometric mean is not above the arithmetic). How far other machines differ, more trials on these do not
/// tell.
void add_stopping(PointDescription& point, const summary::StudySummary& summary);

/// What the trials of a point show of all axes that the manifest describes, as tolerance statements.
void add_assurance(PointDescription& point, const summary::StudySummary& summary);

/// The values of ISO 230-2 of a study with a sequence.
void add_repeatability(PointDescription& point, const summary::StudySummary& summary);
void add_repeatability(SummaryDescription& answer, const summary::StudySummary& summary);

}  // namespace zerocount::summary_answer
