#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/summary.hpp"
#include "analysis/worlds/world_statistics.hpp"

/// What the trials of a design point show of each goal, under each condition and at each age.
namespace zerocount::summary {

/// Some of the trials of a point, and what is judged of them. Bounds are one-sided, each with the confidence
/// of the goal (of the summary without a goal); with worlds the rates are those of the worst world.
struct CellOfPoint {
  std::optional<std::string> goal{};       ///< the only one of the cell, or its worst; none without names
  std::optional<std::string> condition{};  ///< none without conditions, and where the cell has several
  /// The worst condition of the cell, which rate, verdict and settling time are under; none where it has one.
  std::optional<std::string> worst_condition{};
  double age{0.0};  ///< in the unit of Question::ages; 0 without ages
  std::int64_t trials{0};
  std::int64_t success{0};           ///< trials all of whose moves ended at zero error
  std::int64_t goal_met{0};          ///< trials all of whose moves meet the goals
  std::int64_t moves{0}, met{0};     ///< that the goal asks, and of them those that meet it
  goal::BoundedProportion rate{};    ///< of moves of the worst goal and condition; without a goal of
                                     ///< trials that succeed, under the worst condition
  goal::BoundedProportion judged{};  ///< of machines, moves or trials, as judged_head() says
  std::optional<goal::BoundedProportion> machines{};  ///< that meet the goal; none if it is not on machines
  std::optional<goal::BoundedProportion> living{};    ///< machines that meet it at every age up to this one
  std::optional<double>
      settling_time_p95{};  ///< s, of the same goal and condition; none: not within the hold
  double within{0.0};       ///< s from the start, that the goal allows; the longest of its moves
  goal::Status status{goal::Status::undecided};  ///< of the worst goal and condition
};

/// By what cells differ.
enum class CellsBy { claim, condition, age };

/// The claims on a point, by goal and condition; empty without a goal. The bounds are those of verdict_on().
/// @param points that the point was chosen from
std::vector<CellOfPoint> claims_of_point(const StudySummary& summary, std::int64_t point,
                                         std::size_t points = 1);

/// The conditions of a point, [condition], with ages each at each age; empty without conditions, and of a
/// point without judged trials. A goal is missed under a condition where this is shown with the error
/// probability divided by their number, so that one missed condition shows the goal to be missed.
std::vector<CellOfPoint> conditions_of_point(const StudySummary& summary, std::int64_t point,
                                             std::size_t points = 1);

/// The ages of a point, [age]; empty without ages, and of a point without judged trials.
std::vector<CellOfPoint> ages_of_point(const StudySummary& summary, std::int64_t point,
                                       std::size_t points = 1);

document::Description<CellOfPoint> cell_description(const goal::Question& question, CellsBy by);

/// The cell with the smallest standing of the proportion that is judged. @param cells not empty, of a study
/// without a goal
std::size_t worst_cell(const std::vector<CellOfPoint>& cells);

/// The last age up to and including which the goal is met, in the unit of ages; none if not at the first.
std::optional<double> met_until(const std::vector<CellOfPoint>& ages);
/// The first age at which the goal is missed; none where that is not shown.
std::optional<double> missed_from(const std::vector<CellOfPoint>& ages);

/// "the goal is met up to 100000 cycles, and missed from 1000000 cycles on"; without a goal, or ages, empty.
std::string ages_sentence(const goal::Question& question, const std::vector<CellOfPoint>& ages);

/// "on average over the worlds and conditions: ", for what is of all trials; empty where they are all alike.
std::string averaged_over(const StudySummary& summary);

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

/// The worlds at a design point, and what differs between them.
struct WorldsReading {
  const worlds::PointWorlds& point;
  const std::vector<worlds::WorldInput>& inputs;
  const goal::Question& question;
};

/// Rates and verdicts by world, the bad worlds and the rule that tells them apart; people are shown the rates
/// that the study is judged by.
document::Description<WorldsReading> worlds_description(const goal::Question& question);

}  // namespace zerocount::summary
