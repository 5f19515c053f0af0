#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/trials/goal/goal_verdict.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "experiments/study/grouping.hpp"
#include "experiments/study/study.hpp"

/// Choice of the design point that all outputs of a study report on, and the verdict on this point.
namespace zerocount::summary {

/// Indices of the design points that have trials, the best first. They are ranked by goal::merits_of(). Ties
/// go to the point with fewer swept parameters that differ from 0 or "none", then to the first. Points of an
/// open-loop study keep their order.
std::vector<std::int64_t> points_by_merit(const StudySummary& summary);

/// A swept number that is at the end of its range. Better values may lie beyond the end.
struct EndOfRange {
  std::size_t axis{0};  ///< Index of the swept parameter in StudySummary::axes.
  bool lowest{false};   ///< True at the lowest value of the range, false at the highest.
};

/// The value of the swept parameter with the index `end.axis` at the design point.
double value_at(const StudySummary& summary, const EndOfRange& end, std::int64_t point);

/// The design point that was chosen as the best or named by the user, and its competitors.
struct ChosenPoint {
  std::int64_t point{0};
  /// Number of points from which it was chosen: those with trials; 1 for a point that the user named
  /// beforehand.
  std::int64_t chosen_from{1};
  /// Index of the best of the other points; empty if there is none.
  std::optional<std::int64_t> runner_up{};
  /// Indices of other points that are not shown to be worse, in their order.
  std::vector<std::int64_t> as_good{};
  /// Swept numbers whose value at the best point is at an end of their range. The value 0 is not an end,
  /// because a gain cannot be lower.
  std::vector<EndOfRange> ends{};
};

/// Chooses the best design point or, if `point` is given, takes that one.
///
/// Another point is shown to be worse if the one-sided 95 % lower bound of the difference of the two
/// proportions (of successes, or of moves or machines in the goal) is above zero. With machines this is
/// Student's bound for the differences of each machine's proportions; both points have the same machines.
/// Without machines the trials are treated as independent, with one success and one failure added to each
/// point (Agresti and Caffo, Amer. Statist. 54 (2000) 280); the trials in fact share random numbers, so they
/// differ less. With worlds and a goal, a point is shown to be worse if the upper bound of its worst world is
/// below the lower bound of the best point's worst world.
ChosenPoint choose_point(const StudySummary& summary, std::optional<std::int64_t> point = {});

/// Name of the chosen design point: "best of 8 points: 3 (kp=400)", or only the name of the point if it was
/// not chosen from several.
std::string name_of_chosen(const StudySummary& summary, const ChosenPoint& chosen);

/// One sentence with the bound that the trials of the chosen point give for the success of all machines. The
/// bound accounts for the choice of the point by these trials.
std::string claim_of_chosen_point(const StudySummary& summary, const ChosenPoint& chosen);

/// Remarks beside the verdict on the chosen point: points that are as good, and swept ranges at whose ends it
/// lies. Whole lines, or empty.
std::string competition_text(const StudySummary& summary, const ChosenPoint& chosen);

/// The swept parameters whose values differ between points or that have a distribution, without "case".
std::vector<const study::SweepAxis*> varying_parameters(std::span<const study::SweepAxis> axes);

/// The shortest end of the dotted path of a swept parameter that no other swept parameter has: "ki", or
/// "coarse.kp" if another path ends in "kp".
std::string short_name(std::span<const study::SweepAxis> axes, const study::SweepAxis& axis);

/// [point] Labels of the design points for tables: the paths in the labels of a grid are shortened to their
/// ends, as in "kp=400 ki=8e4".
std::vector<std::string> short_labels(std::vector<std::string> labels,
                                      std::span<const study::SweepAxis> axes);

/// [point] Names of the design points: number and short label, "3 (kp=400 ki=8e4)". Only the label if it does
/// not name swept values, such as the label of a case.
std::vector<std::string> point_names(const StudySummary& summary);

/// A design point judged by the goal of its study.
struct JudgedPoint {
  ChosenPoint chosen;
  goal::Verdict verdict;  ///< Verdict; the bounds account for the choice of the point (Bonferroni).
  /// Number of trials or machines that would decide the goal; set if the verdict is undecided.
  std::optional<goal::Needs> needs{};
};

/// Judges the chosen point by the goal.
/// @param summary summary of a study with a goal
JudgedPoint judge_point(const StudySummary& summary, const ChosenPoint& chosen);

/// Headline on the chosen point: "best of 8 points: 3 (kp=400): the goal is met".
std::string judgement_headline(const StudySummary& summary, const JudgedPoint& judged);

/// The reasons for the verdict, one line each: its bounds, the study size that would decide it, and the
/// competitors of the point.
std::string judgement_details(const StudySummary& summary, const JudgedPoint& judged);

/// The judgement as a paragraph: the goal, judgement_headline() and judgement_details().
std::string judgement_text(const StudySummary& summary, const JudgedPoint& judged);

/// Numbers of moves that miss and that meet a goal, each with the number of those in which the converter
/// clipped the torque.
struct SaturatedMoves {
  /// Moves that miss the goal, and the number of those in which the converter clipped the torque.
  std::int64_t missed{0}, missed_saturated{0};
  /// Moves that meet the goal, and the number of those in which the converter clipped the torque.
  std::int64_t met{0}, met_saturated{0};

  double of_missed() const { return static_cast<double>(missed_saturated) / static_cast<double>(missed); }
  double of_met() const { return static_cast<double>(met_saturated) / static_cast<double>(met); }
};

/// A goal of a study at one design point in one setting (condition at an age).
struct JudgedClaim {
  std::int64_t point;
  std::size_t goal;
  std::size_t setting;
};

/// Counts the moves that miss and that meet the goal of the claim, each with the number of moves in which the
/// converter clipped the torque. Empty if the file does not keep every trial.
std::optional<SaturatedMoves> saturated_moves(const std::filesystem::path& path, const study::Study& study,
                                              const JudgedClaim& claim);

/// Sentence on the clipping of the torque: "of the 80 moves that miss the goal 78 saturate (of the 20 others
/// 1): …". Empty unless at least half of the moves that miss the goal saturate, and this proportion exceeds
/// that of the other moves by at least 0.1.
std::string saturation_sentence(const SaturatedMoves& moves);

}  // namespace zerocount::summary
