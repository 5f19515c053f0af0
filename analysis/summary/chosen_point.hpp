#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/summary.hpp"
#include "experiments/study/grouping.hpp"
#include "experiments/study/study.hpp"

/// The design point that all outputs of a study speak of.
namespace zerocount::summary {

/// The points that have trials, the best first: by goal::merits_of(); among equals the one with fewer swept
/// parameters other than 0 or none; then the first. Points of an open-loop study keep their order.
std::vector<std::int64_t> points_by_merit(const StudySummary& summary);

/// The first of them.
std::int64_t best_point(const StudySummary& summary);

/// A swept number at the end of its range: beyond it better values may lie.
struct EndOfRange {
  std::size_t axis{0};  ///< of StudySummary::axes
  bool lowest{false};   ///< otherwise it is the highest
};

/// The value of the parameter at the point.
double value_at(const StudySummary& summary, const EndOfRange& end, std::int64_t point);

/// The chosen point, and its competitors.
struct ChosenPoint {
  std::int64_t point{0};
  std::int64_t chosen_from{1};              ///< points with trials; 1 for a point that was named beforehand
  std::optional<std::int64_t> runner_up{};  ///< the best of the other points
  std::vector<std::int64_t> as_good{};      ///< other points that are not shown to be worse, in their order
  std::vector<EndOfRange> ends{};  ///< where the point is the best; 0 is no end, as gains have no less
};

/// Chooses the best point, or takes `point`.
///
/// Another point is shown to be worse if the one-sided 95 % bound of the difference of their rates is above
/// zero: the rate of success, or of the goal. With machines it is Student's bound for the differences of the
/// rates of each machine, which are the same machines at both points. Without machines, rates are compared as
/// if their trials were independent, with one success and one failure added to each (Agresti and Caffo, Amer.
/// Statist. 54 (2000) 280); trials of the same random numbers differ less. With worlds and a goal, a point
/// is shown to be worse if the upper bound of its worst world is below the lower bound of the other's.
ChosenPoint choose_point(const StudySummary& summary, std::optional<std::int64_t> point = {});

/// "best of 8 points: 3 (kp=400)", or only the name of the point.
std::string name_of_chosen(const StudySummary& summary, const ChosenPoint& chosen);

/// The success of the chosen point, in one sentence: what its trials show of all axes. The bound allows for
/// the choice of the point by these trials.
std::string claim_of_chosen_point(const StudySummary& summary, const ChosenPoint& chosen);

/// What stands beside the verdict on the chosen point: points as good, and ends of swept ranges. Whole lines,
/// or empty.
std::string competition_text(const StudySummary& summary, const ChosenPoint& chosen);

/// The swept parameters with different values at different points, or with a distribution; without "case".
std::vector<const study::SweepAxis*> varying_parameters(std::span<const study::SweepAxis> axes);

/// The end of the dotted path of the axis that no other swept parameter has: "ki", or "coarse.kp" beside a
/// "kp".
std::string short_name(std::span<const study::SweepAxis> axes, const study::SweepAxis& axis);

/// [point] its label as tables show it: the paths in the labels of a grid are shortened to their ends, as in
/// "kp=400 ki=8e4".
std::vector<std::string> short_labels(std::vector<std::string> labels,
                                      std::span<const study::SweepAxis> axes);

/// [point] its number and short label: "3 (kp=400 ki=8e4)". Only the label where it does not name swept
/// values, as that of a case.
std::vector<std::string> point_names(const StudySummary& summary);

/// A design point judged by the goal of its study.
struct JudgedPoint {
  ChosenPoint chosen;  ///< the bounds allow for its choice (Bonferroni)
  goal::Verdict verdict;
  std::optional<goal::Needs> needs{};  ///< of a verdict that is undecided
};

/// @param summary of a study with a goal
JudgedPoint judge_point(const StudySummary& summary, const ChosenPoint& chosen);

/// "best of 8 points: 3 (kp=400): the goal is met".
std::string judgement_headline(const StudySummary& summary, const JudgedPoint& judged);

/// The reasons of the verdict, a line each: its bounds, what would decide it, the competitors of the point.
std::string judgement_details(const StudySummary& summary, const JudgedPoint& judged);

/// The judgement as a paragraph: the goal, judgement_headline() and judgement_details().
std::string judgement_text(const StudySummary& summary, const JudgedPoint& judged);

/// In how many moves that miss a goal, and in how many that meet it, the converter clipped.
struct SaturatedMoves {
  std::int64_t missed{0}, missed_saturated{0};
  std::int64_t met{0}, met_saturated{0};

  double of_missed() const { return static_cast<double>(missed_saturated) / static_cast<double>(missed); }
  double of_met() const { return static_cast<double>(met_saturated) / static_cast<double>(met); }
};

/// A goal of a study at a design point under a condition.
struct JudgedClaim {
  std::int64_t point;
  std::size_t goal;
  std::size_t condition;
};

/// The moves of a results file that the claim is about; nothing where the file does not keep every trial.
std::optional<SaturatedMoves> saturated_moves(const std::filesystem::path& path, const study::Study& study,
                                              const JudgedClaim& claim);

/// "of the 80 moves that miss the goal 78 saturate the converter, of the 20 others 1: …"; empty unless most
/// of the moves that miss it saturate, and more of them than of the others.
std::string saturation_sentence(const SaturatedMoves& moves);

}  // namespace zerocount::summary
