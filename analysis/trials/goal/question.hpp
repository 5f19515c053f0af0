#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/basis/statistics/clusters/tolerance.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/trials/goal/goal_verdict.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/measures/point_statistics.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/study.hpp"

/// The question of a study: the goals of its manifest, or success if it has none. All code that judges
/// trials, machines, worlds and design points takes its criteria, and the words for them, from here.
namespace zerocount::goal {

/// One criterion that moves must meet: that of a goal, or success (the move ends at zero counts).
struct JudgedCriterion {
  std::size_t number{0};  ///< Index of the goal in Study::goals; 0 for the criterion of success.
  /// The goal, which demands that a proportion of moves or of machines meets the criterion; null for the
  /// criterion of success.
  std::optional<study::Goal> goal{};
  measures::MoveCriterion criterion{};  ///< Criterion by which moves are counted.
};

/// The criteria by which a study is judged. All parts must be met: one for each goal of the study, or one
/// for success.
struct Question {
  std::vector<JudgedCriterion> parts{JudgedCriterion{}};
  /// Number of worlds (draws of what all machines share); the criteria must be met in each. 0: no worlds.
  std::int64_t worlds{0};
  bool stopped{false};  ///< True: the outcomes of the trials decided when the study stopped (key `stop`).
  /// Conditions and ages of the study; each pair is a setting, in which the criteria must be met.
  study::Settings settings{};
  /// Text that names the mass whose zero counts mean success: " of the motor" (study::of_closing_mass());
  /// empty on an axis with one mass.
  std::string_view of_mass{};

  /// The first goal; null if the study has none and is judged by success.
  const std::optional<study::Goal>& goal() const { return parts.front().goal; }
  const measures::MoveCriterion& criterion() const { return parts.front().criterion; }
};

Question question_of(const study::Study& study);
/// Text that names a setting: " under condition loaded", " at loaded, 100000 cycles"; empty without settings.
/// @param setting index of the setting
std::string under_text(const Question& question, std::size_t setting);

/// Whether the study has several goals.
inline bool has_several(const Question& question) {
  return question.parts.size() > 1;
}
/// Whether the goals have names. They have names if they are in the manifest's `goals`, which may hold a
/// single goal.
inline bool has_names(const Question& question) {
  return question.goal() && !question.goal()->name.empty();
}
/// The question restricted to the part with the index `number`, to judge a point by its worst goal
/// (Verdict::goal).
Question only(const Question& question, std::size_t number);
/// Requires that the study has a goal.
/// @param path path of the manifest or file, for the message
/// @param others what the user may give instead of a goal: ", or --success"
/// @throws Failure (bad_input) if the study has no goal
void require_claim(const study::Study& study, std::string_view path, std::string_view others = "");
/// Requires that the moves of the study have targets.
/// @param path path of the manifest or file, for the message
/// @throws Failure (bad_input) if the study applies torque levels, whose moves have no targets
void require_targets(const study::Study& study, std::string_view path);
/// The question in which success (all moves end at zero counts) takes the place of the goals.
inline Question success(const Question& question) {
  Question without = question;
  without.parts = {JudgedCriterion{}};
  return without;
}

/// Whether a trial with these moves meets the question: all moves meet the goals that judge them or, without
/// goals, all succeed.
bool meets(const Question& question, std::span<const trial::MoveOutcome> moves);

/// Settling time of a trial, s: the time at which the slowest of its moves is within the goal's band for good
/// or, without a goal, has arrived. Infinite if a move never does.
double settling_time(const Question& question, std::span<const trial::MoveOutcome> moves);

/// Numbers that rank a trial among others; the larger value, compared in the order of the array, is worse.
/// With a goal: number of moves that miss a goal, settling_time(), severity of the outcome, |final error| in
/// counts. Without one: severity, |final error|, settling_time(), 0.
using Badness = std::array<double, 4>;
Badness badness_of(const Question& question, std::span<const trial::MoveOutcome> moves);

/// The verdict on all goals of the question, in all settings, at a design point.
/// @param points number of design points from which this one was chosen by its trials; 1 if it was chosen
/// before
Verdict verdict_on(const Question& question, const measures::PointSummary& point, std::size_t points = 1);

/// Sizes of studies that decide all goals of the question at a design point; see deciding_studies() and
/// needs_of() for lists of goals.
std::vector<Needs> deciding_studies(const Question& question, const measures::PointSummary& point,
                                    std::size_t points);
Needs needs_of(const Question& question, const measures::PointSummary& point, std::size_t points);

/// Counts of the moves of a point that are judged, and of those that meet the worst claim. Without a goal:
/// counts of the trials, each as one move, and of those that succeed.
measures::MoveCounts counts_of(const Question& question, const measures::PointSummary& point);

/// Final settling times of the moves that one goal judges in one setting: the times from which on the error
/// stays within the goal's band or tolerance.
struct GoalTimes {
  std::size_t part{0};     ///< Index of the goal in Question::parts.
  std::size_t setting{0};  ///< Index of the setting; 0 without settings.
  const measures::MeasureStatistics* statistics{nullptr};
  /// Longest time that the goal allows to a judged move, s from the start of the move.
  double allowed{statistics::unknown};
  /// 95 % quantile of settling time divided by allowed time; infinite if this proportion of the moves does
  /// not settle.
  double time_ratio{statistics::unknown};
};
/// Settling times for each pair of goal and setting. Only moves that the goal judges are counted.
/// @param question a question with at least one goal
std::vector<GoalTimes> goal_times(const Question& question, const measures::PointSummary& point);
/// The settling times of the goal and setting with the largest GoalTimes::time_ratio, that is, the slowest
/// ones.
/// @param question a question with at least one goal
GoalTimes slowest_goal_times(const Question& question, const measures::PointSummary& point);

/// The element of `times` for the goal and the setting of the claim.
/// @param times goal_times() of the same point
const GoalTimes& times_of_claim(const std::vector<GoalTimes>& times, const ClaimVerdict& claim);
/// Statistics of the final settling time for the worst claim at a point; without a goal, of the arrival
/// time.
const measures::MeasureStatistics& settling_of(const Question& question, const measures::PointSummary& point);

/// Name of the measure of the goal's settling time, or of a statistic of this measure:
/// "band_settling_time_p95[2]".
/// @param statistic suffix such as "_p95"; empty: the measure itself
std::string name_of_settling(const study::Goal& goal, std::string_view statistic = "");
/// Name of the settling time of the first goal, "band_settling_time[2]"; without a goal "arrival_time".
std::string settling_measure(const Question& question);

/// Names of the settling times of all goals; without a goal "arrival_time".
std::vector<std::string> settling_measures(const Question& question);

/// The quantile of settling_measure() by which points are compared: the 95 % quantile of a goal's settling
/// time, or the median of the arrival time.
statistics::Quantile measures::MeasureStatistics::*settling_quantile(const Question& question);
/// Name of the statistic of settling_quantile() in files: "band_settling_time_p95[2]", "arrival_time_median".
std::string settling_statistic(const Question& question);

/// Numbers by which design points are compared, the most important one first; larger is better. With a goal:
/// number of goals met, standing of the worst claim, and minus the largest proportion of the allowed time
/// (slowest_goal_times()). Without a goal: success rate, and minus the median of the arrival time.
std::vector<double> merits_of(const Question& question, const measures::PointSummary& point);

/// Proportion at a design point of moves that meet the worst claim; without a goal, of trials that succeed.
/// With worlds and a claim: proportion in the worst world, with the lowest bounds of all worlds.
struct QuestionRate {
  double value{statistics::unknown};
  /// Bounds of the proportion. With a goal: one-sided, each with the confidence of the goal. Otherwise: a
  /// two-sided interval.
  statistics::ConfidenceInterval bounds{0.0, 1.0};
  /// Number of successes, and number of all moves or trials that are counted.
  std::int64_t hits{0}, events{0};
};
/// The proportion of successes at a design point with its bounds.
/// @param points number of design points from which the point was chosen
/// @param confidence confidence of the two-sided bounds if the question has no goal
QuestionRate rate_of(const Question& question, const measures::PointSummary& point, std::size_t points = 1,
                     double confidence = statistics::summary_confidence);

/// Number of machines of a design point all of whose moves meet the question.
struct MachinesWithoutFailure {
  /// Number of machines without a failure (or, for machines_meeting_all(), of machines that meet every goal).
  std::int64_t machines{0};
  std::int64_t of{0};  ///< Number of all machines; 0 if the study has no machines.
};
MachinesWithoutFailure machines_without_failure(const Question& question,
                                                const measures::PointSummary& point);

/// The proportion by which a claim is judged in a world: of machines if the claim is about machines,
/// otherwise of moves.
const BoundedProportion& judged_rate(const Question& question, const WorldVerdict& world);
/// Whether the first goal demands a proportion of machines, not only of moves.
inline bool is_of_machines(const Question& question) {
  return question.goal() && question.goal()->machines;
}

/// Number of machines of a point that meet every goal on machines, each in its proportion of moves, under
/// every setting, and number of all machines. Empty if fewer than two claims are on machines.
std::optional<MachinesWithoutFailure> machines_meeting_all(const Question& question,
                                                           const measures::PointSummary& point);

/// Whether QuestionRate describes the worst world, because the question has a goal and worlds.
inline bool is_of_worst_world(const Question& question) {
  return question.worlds > 0 && question.goal();
}

/// Confidence of the bounds by which the question is judged: that of the first goal, or `others` without one.
double confidence_of(const Question& question, double others);

/// Tolerance statement about the success of all machines at a design point. Its bounds account for the choice
/// from `points` points (Bonferroni).
/// @param stopped whether the outcomes decided the number of trials (`stop`)
statistics::SuccessClaim claim_of_chosen(const measures::PointSummary& point, std::size_t points,
                                         bool stopped);

/// Two-sided bounds of the success rate of a point that was chosen from `points` points: Clopper–Pearson, or
/// Korn–Graubard with machines. With `stop` they are the bounds of the confidence sequence; with `stop` and
/// machines, the outer ones of the sequence and Korn–Graubard.
statistics::ConfidenceInterval bounds_of_chosen(const measures::PointSummary& point, std::size_t points,
                                                bool stopped, double confidence);

/// [age] The proportion of machines that meet the question at each age, with one-sided bounds.
///
/// For one goal in one setting these are the bounds of a claim on machines (judge_goal()).
///
/// Several settings: a machine that misses the goal in some setting reaches c good moves in all settings at
/// most as often as in that one. So the machines that meet the goal in all settings are bounded by the fewest
/// good moves of each machine in any setting, in the same way as those that meet it in one setting are
/// bounded by their good moves (statistics::MachineClaim). This holds however the moves in the settings
/// depend on each other.
///
/// Several goals: the lower bound for G goals is 1 − Σ(1 − low of each goal), each at the confidence 1 − (1 −
/// γ)/G. The upper bound is the minimum over the K pairs of goal and setting, each at 1 − (1 − γ)/K
/// (Bonferroni). With worlds all values are those of the worst world.
/// @param counts [goal of the study] counts of the moves (PointSummary::goals)
std::vector<BoundedProportion> machines_at_ages(const Question& question,
                                                const std::vector<measures::CellCounts>& counts);

/// [machine] Life of each machine: the last age up to and including which it meets the question at every age;
/// NaN if it does not meet it at the first age.
/// @param counts [goal of the study] counts of the moves
std::vector<double> lives_of_machines(const Question& question,
                                      const std::vector<measures::CellCounts>& counts);

/// Number and proportion of the machines that meet the question at every age up to a given age.
struct Survival {
  std::int64_t machines{0};  ///< Number of machines that meet the question at every age up to this age.
  /// These machines as a proportion of all machines, with one-sided Clopper–Pearson bounds.
  BoundedProportion living;
};
/// [age] Survival curve: the machines that meet the question at every age up to this one.
/// @param lives [machine] lives_of_machines()
/// @param ages ages in rising order
/// @param confidence confidence of each bound
std::vector<Survival> survival_of(const std::vector<double>& lives, const std::vector<double>& ages,
                                  double confidence);

}  // namespace zerocount::goal
