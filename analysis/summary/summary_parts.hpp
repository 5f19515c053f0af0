#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/measures/point_statistics.hpp"
#include "analysis/summary/summary.hpp"
#include "analysis/text/text.hpp"
#include "analysis/worlds/world_statistics.hpp"
#include "experiments/study/study.hpp"

/// Parts of the summary of a study, which summary_table, summary_json and summary_csv put together.
namespace zerocount::summary {

/// The properties of a study as a whole.
StudySummary summary_without_points(const study::Study& study, double confidence);

/// Adds to the statistics what the study says of their points, and the sections that need no more.
/// @param undecided [point] @param numbers [point] its number in the study
void describe_points(StudySummary& summary, const study::Study& study,
                     const std::vector<measures::UndecidedMoves>& undecided,
                     std::span<const std::int64_t> numbers);

/// Adds the claims about all axes. They count independent trials.
void add_claims(StudySummary& summary);

/// Whether the section is about what the study is judged by, and not beside its goal.
bool is_of_question(const StudySummary& summary, const measures::SummarySection& section);

/// "95 % bounds", with the confidence of the summary: the head of a column of them.
std::string bounds_head(const StudySummary& summary);

/// A quantile of the settling times of all moves of a point, or a bound of it, as text: four significant
/// digits, "> 1 s" if it is not reached within the hold, "> hold" if trials differ in theirs, "–" if there is
/// no move with a target.
/// @param time s; NaN if not reached
std::string settling_text(const measures::PointSummary& point, double time);

/// The end of the dotted path of the axis that no other swept parameter has: "ki", or "coarse.kp" beside a
/// "kp".
std::string short_name(std::span<const study::SweepAxis> axes, const study::SweepAxis& axis);

/// The columns that tell the points apart: their labels, and a column for each swept parameter with its unit
/// in the head, where these are few. In a grid, whose labels only repeat the swept values, the number of the
/// point takes the place of the label. A star marks the chosen point among several.
std::vector<text::TextColumn> sweep_columns(const StudySummary& summary, std::int64_t chosen);

/// The table of a study with targets by its question, the most important columns first; without a goal that
/// of zero counts. @param chosen the point that is marked
std::vector<text::TextColumn> question_columns(const StudySummary& summary, std::int64_t chosen);
/// The table of zero counts, arrival, jerks, outcomes and criteria.
std::vector<text::TextColumn> zero_count_columns(const StudySummary& summary, std::int64_t chosen);
/// The meaning of the columns of both.
std::string loop_legend(const StudySummary& summary);

/// The number of trials of every point; nothing where points differ in it.
std::optional<std::int64_t> trials_of_each(const StudySummary& summary);

/// "8 points × 2000 trials on 100 rigs".
std::string size_line(const StudySummary& summary);

/// The effect of the study's design on the bounds, one line.
std::string design_line(const StudySummary& summary);

/// The table of an open-loop study, a row per point and level, and what its columns mean.
text::PointTable level_table(const StudySummary& summary);
std::string level_legend(parameters::AxisKind axis);

/// The observations on the real rig, [point]; empty where there are none at any point.
std::vector<std::string> observations(const StudySummary& summary);

/// The levels of a point: an array of objects with the names of level_fields(), by group.
nlohmann::ordered_json levels_json(const measures::PointSummary& point);

/// The section "stopped" of the summary of a study that decided itself how many trials it took (`stop`): the
/// bounds of the success rate that hold although it looked after every block.
///
/// With rigs they are bounds of the mean over the rigs of the study, whose trials the rule is about: every
/// rig has run equally many at each look, and the product of the likelihood ratios of trials with different
/// probabilities pᵢ is no larger on average than that of trials which all have their mean (the geometric mean
/// is not above the arithmetic). How far other rigs differ, more trials on these do not tell.
///
/// Its JSON is {"success_rate_low", "success_rate_high", "confidence", "halfwidth", "halfwidth_asked",
/// "halfwidth_confidence", "reached", with rigs "of_rigs"}: what the rule asked for, at its own confidence,
/// and what was reached. Its columns are stopped_success_rate_low and stopped_success_rate_high; its text is
/// a table.
/// @param labels [point]
/// @param confidence of the bounds
measures::SummarySection stopping_section(std::span<const measures::PointSummary> points,
                                          const std::vector<std::string>& labels,
                                          const study::StoppingRule& rule, double confidence);

/// Key of the section of counts observed on a real rig.
inline constexpr const char* observed_key = "observed_counts";

/// The section "observed_counts": whether the counts on a real rig are consistent with the simulated trials
/// of the point, by fisher_test, or with rigs by rig_rank_test. The observed trials are all of one rig.
///
/// Its JSON is null for a point without counts, else {"successes", "of", "p_value" (null where it cannot be
/// tested), "lowest_p_value", "verdict" (consistent, differs, too_few, untested), "statement"}; its columns
/// are observed_successes, observed_trials and observed_p_value; its text is a table.
/// @param labels [point]
/// @param confidence differences are significant at 1 − confidence
measures::SummarySection observed_section(std::span<const measures::PointSummary> points,
                                          const std::vector<std::string>& labels,
                                          const std::map<std::string, study::ObservedCounts>& counts,
                                          double confidence);

/// The columns of that section with 95 %, for the results file; empty without counts.
/// @param first the first of the points, which are consecutive
std::vector<layout::PointColumn> observed_columns(std::span<const measures::PointSummary> points,
                                                  const study::Study& study, std::int64_t first = 0);

/// The verdicts of the complete_points() by the goal of the study, each on its own; nothing for a point
/// without trials.
std::vector<std::optional<goal::Verdict>> goal_verdicts(const StudySummary& summary);

/// {"status", "rate", "rate_low", "rate_high"}, the proportion of moves that meet the goal; if the goal asks
/// for machines "machines", "machines_low", "machines_high" too, with rigs "rigs_without_miss".
nlohmann::ordered_json verdict_json(const study::Goal& goal, const goal::Verdict& verdict, bool on_rigs);

/// The section "goal" of a summary: whether each point meets the goal of the study, with bounds of that point
/// alone.
///
/// Its JSON is verdict_json(). Its columns are goal_rate, goal_rate_low, goal_rate_high, and goal_machines…
/// likewise; its cells are columns of the main table.
measures::SummarySection goal_section(const StudySummary& summary);

/// The worlds at a point; nothing for a study without worlds, or where a world has no trials yet.
/// @param chosen_from number of points that it was chosen from
std::optional<worlds::PointWorlds> worlds_of_point(const StudySummary& summary, std::int64_t point,
                                                   std::size_t chosen_from = 1);

/// Parameters, and quantities derived from them, that differ between the worlds at a point of a study with
/// worlds.
inline const std::vector<worlds::WorldInput>& world_inputs_of(const StudySummary& summary,
                                                              std::int64_t point) {
  return summary.world_inputs[static_cast<std::size_t>(point)];
}

/// "5 of 30 worlds fall short of the goal: where friction.alpha > 1.4 1/s (5 of these 5, and 1 of the other
/// 25; by chance with probability 0.0025); what separates them need not be the cause", with the other
/// quantities that separate the same worlds, and what derived ones mean.
std::string bad_worlds_sentence(const worlds::PointWorlds& point,
                                const std::vector<worlds::WorldInput>& inputs,
                                const goal::Question& question);

/// The section "worlds" of a summary of a study with worlds. Its JSON is that of worlds_description(); its
/// columns are worlds_success_worst, …; its text is a table and a sentence a point on what bad worlds have in
/// common.
measures::SummarySection worlds_section(const StudySummary& summary);

/// The section "assurance" of a summary: what the trials of each point show of all axes that the manifest
/// describes, as tolerance statements.
///
/// Its JSON is {"success_at_least", "failure_at_most", "rule_of_three" (null where there was a failure),
/// "settling_time": [{"content", "within"}], "statement"}; its columns are success_at_least,
/// failure_at_most, settling_within_95, _99 and _99_9, and mean_bound_fields(); its text is a sentence for
/// each point.
/// @param labels [point]
measures::SummarySection tolerance_section(std::span<const measures::PointSummary> points,
                                           const std::vector<std::string>& labels,
                                           const study::StudyFeatures& features = {});

}  // namespace zerocount::summary
