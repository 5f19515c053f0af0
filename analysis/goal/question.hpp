#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/measures/goal_counts.hpp"
#include "analysis/measures/point_statistics.hpp"
#include "analysis/statistics/clusters/tolerance.hpp"
#include "analysis/statistics/proportion.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/study.hpp"

/// The question of a study: the goals of its manifest, or success if it has none. All code that judges
/// trials, machines, worlds and design points takes its criteria, and the words for them, from here.
namespace zerocount::goal {

/// One criterion that moves must meet: a goal, or success.
struct JudgedPart {
  std::size_t number{0};               ///< Index of the goal in Study::goals; 0 for success.
  std::optional<study::Goal> claim{};  ///< The goal, a claim about all machines; empty for success.
  measures::CountedGoal counted{};     ///< the moves that meet it
};

/// The criteria by which a study is judged. All parts must be met: one for each goal of the study, or one
/// for success.
struct Question {
  std::vector<JudgedPart> parts{JudgedPart{}};
  std::int64_t worlds{0};      ///< Number of worlds; the criteria must be met in each. 0: no worlds.
  bool stopped{false};         ///< the outcomes decided the number of trials (`stop`)
  study::Settings settings{};  ///< Conditions and ages; the criteria must be met in each setting.
  /// study::of_closing_mass(): " of the motor", the mass whose zero counts are success.
  std::string_view of_mass{};

  /// The first goal; empty if the study is judged by success.
  const std::optional<study::Goal>& claim() const { return parts.front().claim; }
  const measures::CountedGoal& counted() const { return parts.front().counted; }
};

Question question_of(const study::Study& study);
/// " under condition loaded", " at loaded, 100000 cycles"; empty without settings.
std::string under_text(const Question& question, std::size_t setting);

/// Whether the study has several goals.
inline bool has_several(const Question& question) {
  return question.parts.size() > 1;
}
/// Whether the goals have names: they stand in `goals`, which may hold a single goal.
inline bool has_names(const Question& question) {
  return question.claim() && !question.claim()->name.empty();
}
/// The question with only the part of this number, to judge a point by its worst goal (Verdict::goal).
Question only(const Question& question, std::size_t number);
/// @throws Failure (bad_input) if the study has no goal. @param path path of the manifest or file
/// @param others what the user may give instead of a goal: ", or --success"
void require_claim(const study::Study& study, std::string_view path, std::string_view others = "");
/// @throws Failure (bad_input) if the study applies torque levels, whose moves have no targets. @param path
/// path of the manifest or file
void require_targets(const study::Study& study, std::string_view path);
/// The question with success in place of its goals.
inline Question success(const Question& question) {
  Question without = question;
  without.parts = {JudgedPart{}};
  return without;
}

/// The words of answers about the question. With a claim, answers count moves; otherwise they count trials,
/// because a trial succeeds as a whole. On an axis with two masses, "zero counts" names the mass whose
/// encoder is read.
struct QuestionWords {
  std::string_view subject;       ///< "goal", "success"
  std::string_view title;         ///< Title of figures: "Moves in the goal", "Success".
  std::string_view events;        ///< Noun for what is counted: "moves", "trials".
  std::string meeting;            ///< "moves that meet the goal", "trials that end at zero counts"
  std::string meet;               ///< Predicate of moves: "meet the goal", "end at zero counts".
  std::string_view head;          ///< Column head of the rate: "moves in goal", "zero-count".
  std::string_view rate;          ///< "rate of moves in goal", "success rate"
  std::string_view hits;          ///< "moves in goal", "successes"
  std::string_view settles;       ///< Predicate of a move: "settles in the goal's band", "arrives".
  std::string_view failed;        ///< Predicate of a trial: "missed the goal", "failed".
  std::string_view succeeded;     ///< Predicate of what succeeded: "met the goal", "succeeded".
  std::string_view failure;       ///< "miss", "failure"
  std::string_view failing;       ///< Noun for trials: "trials that miss the goal", "failed trials".
  std::string_view trial_rate;    ///< "rate of trials in goal", "success rate"
  std::string_view machine_head;  ///< Column head: "machines w/o miss", "machines w/o failure".
  std::string machine_meaning;    ///< "proportion of machines all of whose moves meet the goal" …
  std::string_view falls_short;  ///< Predicate of worlds: "fall short of the goal by their observed rates" …
};
const QuestionWords& words_of(const Question& question);
/// Words for trials that succeed: "succeed", with two masses "end at zero counts of the motor".
std::string success_words(const Question& question);

/// Whether a trial with these moves meets the question: all of them do.
bool meets(const Question& question, std::span<const trial::MoveOutcome> moves);

/// When the slowest of the moves is within the goal's band for good, or has arrived, s; infinite if never.
double settling_time(const Question& question, std::span<const trial::MoveOutcome> moves);

/// Rank of a trial among others; the larger value, compared in order of the array, is worse. With a claim:
/// number of moves that miss a goal, settling_time(), severity of the outcome, |final error| in counts.
/// Without one: severity, |final error|, settling_time(), 0.
using Badness = std::array<double, 4>;
Badness badness_of(const Question& question, std::span<const trial::MoveOutcome> moves);

/// The verdict on all claims at a point. @param points as for judge_goals()
Verdict verdict_on(const Question& question, const measures::PointSummary& point, std::size_t points = 1);

/// deciding_studies() and needs_of() for all claims at a point.
std::vector<Needs> deciding_studies(const Question& question, const measures::PointSummary& point,
                                    std::size_t points);
Needs needs_of(const Question& question, const measures::PointSummary& point, std::size_t points);

/// Counts of the moves of a point that are judged, and of those that meet the worst claim. Without a claim:
/// counts of the trials, each as one move, and of those that succeed.
measures::MoveCounts counts_of(const Question& question, const measures::PointSummary& point);

/// The final settling times of the moves that one goal judges: from when on the error stays within its band
/// or tolerance.
struct GoalTimes {
  std::size_t part{0};     ///< Index in Question::parts.
  std::size_t setting{0};  ///< 0 without settings
  const measures::MeasureStatistics* statistics{nullptr};
  double allowed{statistics::unknown};  ///< Longest time allowed to a judged move, s from its start.
  /// 95 % quantile of settling time / allowed time; infinite if it is never reached.
  double time_ratio{statistics::unknown};
};
/// Settling times for each pair of goal and setting. Only moves that the goal judges are counted.
/// @param question with a claim
std::vector<GoalTimes> goal_times(const Question& question, const measures::PointSummary& point);
/// The settling times with the largest GoalTimes::time_ratio. @param question with a claim
GoalTimes slowest_goal_times(const Question& question, const measures::PointSummary& point);

/// The element of `times` for the goal and the setting of the claim. @param times goal_times() of the same
/// point
const GoalTimes& times_of_claim(const std::vector<GoalTimes>& times, const ClaimVerdict& claim);
/// Statistics of the final settling time for the worst claim at a point; without a claim, of the arrival
/// time.
const measures::MeasureStatistics& settling_of(const Question& question, const measures::PointSummary& point);

/// Name of the measure of the goal's settling time, or of a statistic of this measure:
/// "band_settling_time_p95[2]". @param statistic suffix such as "_p95"; empty: the measure itself
std::string name_of_settling(const study::Goal& goal, std::string_view statistic = "");
/// Name of the settling time of the first goal, "band_settling_time[2]"; without a goal "arrival_time".
std::string settling_measure(const Question& question);

/// Names of the settling times of all goals; without a goal "arrival_time".
std::vector<std::string> settling_measures(const Question& question);

/// The quantile of settling_measure() by which points are compared: the 95 % quantile of a goal's settling
/// time, or the median of the arrival time.
statistics::Quantile measures::MeasureStatistics::*settling_quantile(const Question& question);
/// Name in files of settling_quantile(): "band_settling_time_p95[2]", "arrival_time_median".
std::string settling_statistic(const Question& question);

/// Numbers by which design points are compared, the most important one first; larger is better. With a claim:
/// number of goals met, standing of the worst claim, and minus the largest proportion of the allowed time
/// (slowest_goal_times()). Without a claim: success rate, and minus the median of the arrival time.
std::vector<double> merits_of(const Question& question, const measures::PointSummary& point);

/// Proportion at a design point of moves that meet the worst claim; without a claim, of trials that succeed.
/// With worlds and a claim: proportion in the worst world, with the lowest bounds of all worlds.
struct QuestionRate {
  double value{statistics::unknown};
  /// Bounds of the proportion. With a claim: one-sided, each with the confidence of the claim. Otherwise: a
  /// two-sided interval.
  statistics::ConfidenceInterval bounds{0.0, 1.0};
  std::int64_t hits{0}, events{0};  ///< number of successes, and of all that are counted
};
/// @param points number of design points from which the point was chosen
/// @param confidence confidence of the two-sided bounds without a claim
QuestionRate rate_of(const Question& question, const measures::PointSummary& point, std::size_t points = 1,
                     double confidence = statistics::summary_confidence);

/// Machines of a point all of whose moves meet the question.
struct MachinesWithoutFailure {
  std::int64_t machines{0};  ///< Number of machines that qualify.
  std::int64_t of{0};        ///< Number of all machines; 0 without machines.
};
MachinesWithoutFailure machines_without_failure(const Question& question,
                                                const measures::PointSummary& point);

/// The proportion by which a claim is judged in a world: of machines if the claim is about machines,
/// otherwise of moves.
const BoundedProportion& judged_rate(const Question& question, const WorldVerdict& world);
/// Noun for what judged_rate() counts, in a column head and in a sentence: "machines in goal" and "machines
/// that meet the goal", or QuestionWords::head and ::meeting.
std::string_view judged_head(const Question& question);
std::string_view judged_meeting(const Question& question);
/// Whether the first goal is about machines.
inline bool is_of_machines(const Question& question) {
  return question.claim() && question.claim()->machines;
}

/// Number of machines of a point that meet every goal on machines, each in its proportion of moves, under
/// every setting, and number of all machines. Empty if fewer than two claims are on machines.
std::optional<MachinesWithoutFailure> machines_meeting_all(const Question& question,
                                                           const measures::PointSummary& point);

/// Whether QuestionRate describes the worst world.
inline bool is_of_worst_world(const Question& question) {
  return question.worlds > 0 && question.claim();
}

/// Confidence of the bounds by which the question is judged: that of the first goal, or `others` without one.
double confidence_of(const Question& question, double others);

/// The claim on the success of a point. Its bounds account for the choice from `points` points (Bonferroni).
/// @param stopped whether the outcomes decided the number of trials (`stop`)
statistics::SuccessClaim claim_of_chosen(const measures::PointSummary& point, std::size_t points,
                                         bool stopped);

/// Two-sided bounds of the success rate of a point that was chosen from `points` points: Clopper–Pearson, or
/// Korn–Graubard with machines. With `stop` they are the bounds of the confidence sequence; with `stop` and
/// machines, the outer ones of the sequence and Korn–Graubard.
statistics::ConfidenceInterval bounds_of_chosen(const measures::PointSummary& point, std::size_t points,
                                                bool stopped, double confidence);

/// [age] the proportion of machines that meet the question at the age, with one-sided bounds.
///
/// For one goal in one setting these are the bounds of a claim on machines (judge_goal()).
///
/// Several settings: a machine that misses the goal in some setting reaches c good moves in all
/// settings at most as often as in that one. So the machines that meet the goal in all settings are
/// bounded by the fewest good moves of each machine in any setting, in the same way as those that meet
/// it in one setting are bounded by their good moves (statistics::MachineClaim). This holds however the
/// moves in the settings depend on each other.
///
/// Several goals: the lower bound for G goals is 1 − Σ(1 − low of each goal), each at the confidence
/// 1 − (1 − γ)/G. The upper bound is the minimum over the K pairs of goal and setting, each at
/// 1 − (1 − γ)/K (Bonferroni). With worlds all values are those of the worst world.
/// @param counts [goal of the study] (PointSummary::goals)
std::vector<BoundedProportion> machines_at_ages(const Question& question,
                                                const std::vector<measures::CellCounts>& counts);

/// [machine] the life of the machine: the last age up to and including which it meets the question at every
/// age; NaN if it does not meet it at the first age.
std::vector<double> lives_of_machines(const Question& question,
                                      const std::vector<measures::CellCounts>& counts);

/// The machines that meet the question at every age up to a given age.
struct Survival {
  std::int64_t machines{0};  ///< Number of these machines.
  BoundedProportion living;  ///< Proportion of all machines, with one-sided Clopper–Pearson bounds.
};
/// [age] the survival curve of these lives. @param confidence confidence of each bound
std::vector<Survival> survival_of(const std::vector<double>& lives, const std::vector<double>& ages,
                                  double confidence);

}  // namespace zerocount::goal
