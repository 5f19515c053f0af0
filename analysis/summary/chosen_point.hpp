#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/summary/summary.hpp"

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
/// zero: the rate of success, or of the goal. With rigs it is Student's bound for the differences of the
/// rates of each rig, which are the same machines at both points. Without rigs, rates are compared as if
/// their trials were independent, with one success and one failure added to each (Agresti and Caffo, Amer.
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

}  // namespace zerocount::summary
