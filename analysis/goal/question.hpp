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

/// The question of a study: the goal of its manifest, or success where it has none. All that judges trials,
/// machines, worlds and design points takes from here what they are judged by, and what it is called.
namespace zerocount::goal {

/// One thing that is asked of moves.
struct JudgedPart {
  std::size_t number{0};               ///< of the goal in the study
  std::optional<study::Goal> claim{};  ///< what the manifest claims of all axes; nothing: success, unclaimed
  measures::CountedGoal counted{};     ///< the moves that meet it
};

/// The criteria by which a study is judged. All parts must be met: one for each goal of the study, or one
/// for success.
struct Question {
  std::vector<JudgedPart> parts{JudgedPart{}};
  std::int64_t worlds{0};  ///< in each of which it is asked; 0: the study has no worlds
  bool stopped{false};     ///< the outcomes decided the number of trials (`stop`)
  /// Names of those under each of which it is asked; with ages each condition at each age
  /// (Study::conditions).
  std::vector<std::string> conditions{};
  study::Ages ages{};
  /// study::of_closing_mass(): " of the motor", the mass whose zero counts are success.
  std::string_view of_mass{};

  /// The claim that is judged, the first of several; nothing where success is not claimed.
  const std::optional<study::Goal>& claim() const { return parts.front().claim; }
  const measures::CountedGoal& counted() const { return parts.front().counted; }
};

Question question_of(const study::Study& study);
/// " under condition loaded", " at loaded, 100000 cycles"; empty without conditions.
std::string under_text(const Question& question, std::size_t condition);

/// Whether the study has several goals.
inline bool has_several(const Question& question) {
  return question.parts.size() > 1;
}
/// Whether its goals have names: they stand in `goals`, of which there may be one.
inline bool has_names(const Question& question) {
  return question.claim() && !question.claim()->name.empty();
}
/// Its part with this number alone, to judge a point by its worst goal (Verdict::goal).
Question only(const Question& question, std::size_t number);
/// @throws Failure (bad_input) without a claim. @param path of the manifest or file @param others what may be
/// given in its place: ", or --success"
void require_claim(const study::Study& study, std::string_view path, std::string_view others = "");
/// @throws Failure (bad_input) for a study of torque levels, of which nothing is asked. @param path its name
void require_targets(const study::Study& study, std::string_view path);
/// Success in place of the goal.
inline Question success(const Question& question) {
  Question without = question;
  without.parts = {JudgedPart{}};
  return without;
}

/// How answers speak of the question. With a claim they count moves, else trials: success is of a whole
/// trial. On an axis with two masses, zero counts name the one whose encoder they are of.
struct QuestionWords {
  std::string_view subject;       ///< "goal", "success"
  std::string_view title;         ///< of figures: "Moves in the goal", "Success"
  std::string_view events;        ///< what is counted: "moves", "trials"
  std::string meeting;            ///< "moves that meet the goal", "trials that end at zero counts"
  std::string meet;               ///< Predicate of moves: "meet the goal", "end at zero counts".
  std::string_view head;          ///< of a column of their rate: "moves in goal", "zero-count"
  std::string_view rate;          ///< "rate of moves in goal", "success rate"
  std::string_view hits;          ///< "moves in goal", "successes"
  std::string_view settles;       ///< of a move: "settles in the goal's band", "arrives"
  std::string_view failed;        ///< of a trial: "missed the goal", "failed"
  std::string_view succeeded;     ///< of a point: "met it", "succeeded"
  std::string_view failure;       ///< "miss", "failure"
  std::string_view failing;       ///< trials: "trials that miss the goal", "failed trials"
  std::string_view trial_rate;    ///< "rate of trials in goal", "success rate"
  std::string_view machine_head;  ///< of a column of machines: "machines w/o miss", "machines w/o failure"
  std::string machine_meaning;    ///< "proportion of machines all of whose moves meet the goal" …
  std::string_view falls_short;   ///< of worlds: "fall short of the goal by their observed rates" …
};
const QuestionWords& words_of(const Question& question);
/// Words for trials that succeed: "succeed", with two masses "end at zero counts of the motor".
std::string success_words(const Question& question);

/// Whether a trial with these moves meets the question: all of them do.
bool meets(const Question& question, std::span<const trial::MoveOutcome> moves);

/// When the slowest of the moves is within the goal's band for good, or has arrived, s; infinite if never.
double settling_time(const Question& question, std::span<const trial::MoveOutcome> moves);

/// How badly a trial does: of two trials the one with the larger value (in order of the array) does worse.
/// With a claim: moves that miss it, settling_time(), severity of the outcome, |final error| in counts;
/// without one: severity, |final error|, settling_time().
using Badness = std::array<double, 4>;
Badness badness_of(const Question& question, std::span<const trial::MoveOutcome> moves);

/// The verdict on all claims at a point. @param points as of judge_goals()
Verdict verdict_on(const Question& question, const measures::PointSummary& point, std::size_t points = 1);

/// deciding_studies() and needs_of() of all claims at a point.
std::vector<Needs> deciding_studies(const Question& question, const measures::PointSummary& point,
                                    std::size_t points);
Needs needs_of(const Question& question, const measures::PointSummary& point, std::size_t points);

/// The moves of a point (without a claim its trials, each as one move) that meet the question: those of the
/// worst claim.
measures::MoveCounts counts_of(const Question& question, const measures::PointSummary& point);

/// The settling times of one of the goals: within its band or tolerance for good.
struct GoalTimes {
  std::size_t part{0};       ///< of the question
  std::size_t condition{0};  ///< 0 without conditions
  const measures::MeasureStatistics* statistics{nullptr};
  double allowed{statistics::unknown};  ///< s from the start of a move, the longest of those it asks
  double share{statistics::unknown};  ///< 95 % quantile of time / allowed time; infinite where never reached
};
/// Those of each goal under each condition, of the moves that it asks. @param question with a claim
std::vector<GoalTimes> goal_times(const Question& question, const measures::PointSummary& point);
/// Those with the largest share of the time that their goal allows. @param question with a claim
GoalTimes slowest_goal_times(const Question& question, const measures::PointSummary& point);

/// The settling times of the moves that one claim asks. @param times goal_times() of the point of the claim
const GoalTimes& times_of_claim(const std::vector<GoalTimes>& times, const ClaimVerdict& claim);
/// The statistics of the settling time of a point: of the worst claim, or of the arrival.
const measures::MeasureStatistics& settling_of(const Question& question, const measures::PointSummary& point);

/// The name of the settling time that a goal is about, or of a statistic of it.
std::string name_of_settling(const study::Goal& goal, std::string_view statistic = "");
/// The name of that measure of the first goal: "band_settling_time[2]", "arrival_time".
std::string settling_measure(const Question& question);

/// Its quantile by which points are compared: the 95 % quantile, of the arrival the median.
statistics::Quantile measures::MeasureStatistics::*settling_quantile(const Question& question);
/// The name of this quantile in files: "band_settling_time_p95[2]", "arrival_time_median".
std::string settling_statistic(const Question& question);

/// What a design point is compared by, the most important number first; larger is better. With a claim: goals
/// met, the standing of the worst claim, and minus the largest proportion of the time allowed
/// (slowest_goal_times()).
std::vector<double> merits_of(const Question& question, const measures::PointSummary& point);

/// A rate of a design point: of moves with a claim, otherwise of trials. With worlds and a claim that of the
/// worst world, with bounds of the lowest of all.
struct QuestionRate {
  double value{statistics::unknown};
  statistics::ConfidenceInterval bounds{0.0, 1.0};  ///< with a claim one-sided, with its confidence
  std::int64_t hits{0}, events{0};
};
/// @param points that the point was chosen from @param confidence of the two-sided bounds without a claim
QuestionRate rate_of(const Question& question, const measures::PointSummary& point, std::size_t points = 1,
                     double confidence = statistics::summary_confidence);

/// Machines of a point all of whose moves meet the question.
struct MachinesWithoutFailure {
  std::int64_t machines{0};  ///< those
  std::int64_t of{0};        ///< all machines; 0 without machines
};
MachinesWithoutFailure machines_without_failure(const Question& question,
                                                const measures::PointSummary& point);

/// The rate of a world by which a claim is judged: of machines, or of moves.
const BoundedProportion& judged_rate(const Question& question, const WorldVerdict& world);
/// What it is of, in a head and in a sentence: "machines in goal", "machines that meet the goal", or
/// QuestionWords::head and ::meeting.
std::string_view judged_head(const Question& question);
std::string_view judged_meeting(const Question& question);
/// Whether a claim is of machines.
inline bool is_of_machines(const Question& question) {
  return question.claim() && question.claim()->machines;
}

/// Machines of a point that meet every goal on machines in its proportion of moves under every condition, and
/// all that were judged; nothing where only one claim is on machines.
std::optional<MachinesWithoutFailure> machines_meeting_all(const Question& question,
                                                           const measures::PointSummary& point);

/// Whether rates are those of the worst world.
inline bool is_of_worst_world(const Question& question) {
  return question.worlds > 0 && question.claim();
}

/// The confidence of its bounds: of the claim, or that of all others.
double confidence_of(const Question& question, double others);

/// The claim of a point that was chosen from `points`.
/// @param stopped whether the outcomes decided the number of trials (`stop`)
statistics::SuccessClaim claim_of_chosen(const measures::PointSummary& point, std::size_t points,
                                         bool stopped);

/// Two-sided bounds of the success rate of a point that was chosen from `points`: Clopper–Pearson, with
/// machines Korn–Graubard, with `stop` the confidence sequence, or the outer of the two.
statistics::ConfidenceInterval bounds_of_chosen(const measures::PointSummary& point, std::size_t points,
                                                bool stopped, double confidence);

/// [age] the proportion of machines that meet the question at the age, with one-sided bounds.
///
/// The bounds of one goal under one condition are those of a claim on machines (judge_goal()).
///
/// A machine that misses a goal under some condition shows c or more good moves under all of them no more
/// often than under that one. So the fewest good moves of a machine under any condition bound the machines
/// that meet the goal under all, as its good moves bound those that meet it under one
/// (statistics::MachineClaim), however the moves under the conditions depend on each other. Of G goals the
/// lower bound is 1 − Σ(1 − low of each), each at the confidence 1 − (1 − γ)/G. The upper bound is the least
/// of the K goals and conditions, each at 1 − (1 − γ)/K (Bonferroni). With worlds they are those of the worst
/// of them.
/// @param counts [goal of the study] (PointSummary::goals)
std::vector<BoundedProportion> machines_at_ages(const Question& question,
                                                const std::vector<measures::CellCounts>& counts);

/// [machine] the last age up to and including which it meets the question; NaN if it does not at the first.
std::vector<double> lives_of_machines(const Question& question,
                                      const std::vector<measures::CellCounts>& counts);

/// Machines that meet the question at every age up to one.
struct Survival {
  std::int64_t machines{0};  ///< those
  BoundedProportion living;  ///< of the machines, with one-sided Clopper–Pearson bounds
};
/// [age] the survival curve of these lives. @param confidence of each bound
std::vector<Survival> survival_of(const std::vector<double>& lives, const std::vector<double>& ages,
                                  double confidence);

}  // namespace zerocount::goal
