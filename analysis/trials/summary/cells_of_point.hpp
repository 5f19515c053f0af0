#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/basis/document/description.hpp"
#include "analysis/trials/goal/goal_verdict.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "analysis/trials/worlds/world_statistics.hpp"

/// The verdicts and proportions of a design point for each goal, in each setting (condition at an age) and at
/// each age.
namespace zerocount::summary {

/// A table entry: a subset of the trials of a design point (for one goal, setting or age) with its verdict. A
/// setting is a condition at an age. Bounds are one-sided, each with the confidence of the goal; without a
/// goal, of the summary. If the study has worlds (draws of what all machines share), the proportions are
/// those of the worst world.
struct CellOfPoint {
  /// Name of the goal; of several goals, of the worst one. Empty if the study names no goals.
  std::optional<std::string> goal{};
  /// Name of the setting (condition at an age) of the trials; empty if there is none or there are several.
  std::optional<std::string> setting{};
  /// The worst setting (condition at an age), if the cell combines several. Rate, verdict and settling time
  /// hold in this setting. Empty if the cell has a single setting.
  std::optional<std::string> worst_setting{};
  double age{0.0};  ///< Age of the machines, in the unit of Question::ages; 0 if the study has no ages.
  std::int64_t trials{0};
  std::int64_t success{0};   ///< Number of trials in which all moves ended at zero error.
  std::int64_t goal_met{0};  ///< Number of trials in which all judged moves meet the goals.
  /// Moves that the goal judges, and the number of those that meet it; only for a cell of one goal
  /// (CellsBy::claim).
  std::int64_t moves{0}, met{0};
  /// Proportion of moves that meet the worst goal in the worst setting. Without a goal: proportion of
  /// trials that succeed in the worst setting.
  goal::BoundedProportion rate{};
  goal::BoundedProportion
      judged{};  ///< Proportion of machines, moves or trials; see goal::noun_of_judged_rate().
  /// Proportion of machines that meet the goal; empty if the goal is not about machines, except for ages.
  std::optional<goal::BoundedProportion> machines{};
  /// Proportion of machines that meet the goal at every age up to this one; only for a cell of an age
  /// (CellsBy::age).
  std::optional<goal::BoundedProportion> living{};
  /// 95 % quantile of the settling time for the worst goal and setting, s; empty: not reached within the
  /// hold.
  std::optional<double> settling_time_p95{};
  /// Longest time that the goal allows a move, s from its start; only for a cell of one goal
  /// (CellsBy::claim).
  double within{0.0};
  /// Status of the goal by the worst claim (goal and setting): met, missed or undecided.
  goal::Status status{goal::Status::undecided};
};

/// The property by which the cells of a table differ: goal and setting (claim), setting, or age.
enum class CellsBy { claim, setting, age };

/// The claims on a design point (a goal that must be met in a setting), one cell for each goal and setting;
/// empty without a goal. The bounds are those of verdict_on().
/// @param points number of points from which the point was chosen
std::vector<CellOfPoint> claims_of_point(const StudySummary& summary, std::int64_t point,
                                         std::size_t points = 1);

/// [setting] The cells of a design point, one for each setting (condition at an age). Empty without settings,
/// and for a point without judged trials. The upper bounds divide the error probability by the number of
/// settings (Bonferroni), so a single missed setting shows that the goal is missed.
std::vector<CellOfPoint> settings_of_point(const StudySummary& summary, std::int64_t point,
                                           std::size_t points = 1);

/// [age] The cells of a design point, one for each age of the machines; empty without ages, and for a point
/// without judged trials.
std::vector<CellOfPoint> ages_of_point(const StudySummary& summary, std::int64_t point,
                                       std::size_t points = 1);

document::Description<CellOfPoint> cell_description(const goal::Question& question, CellsBy by);

/// Index of the cell whose CellOfPoint::judged (proportion with bounds) is the worst.
/// @param cells at least one, from a study without a goal
std::size_t worst_cell(const std::vector<CellOfPoint>& cells);

/// The highest age up to which the goal is met at every age, in the unit of ages; empty if it is not met at
/// the first age.
/// @param ages [age] cells of ages_of_point()
std::optional<double> met_until(const std::vector<CellOfPoint>& ages);
/// The lowest age at which the goal is shown to be missed, in the unit of ages; empty if there is none.
std::optional<double> missed_from(const std::vector<CellOfPoint>& ages);

/// Sentence on the ages: "the goal is met up to 100000 cycles, and missed from 1000000 cycles on"; empty
/// without a goal or ages.
std::string ages_sentence(const goal::Question& question, const std::vector<CellOfPoint>& ages);

/// Prefix for numbers that average over all trials: "on average over the worlds and conditions: "; empty if
/// the study has neither worlds (draws of what all machines share) nor settings.
std::string averaged_over(const StudySummary& summary);

/// The results of a design point for each world, a draw of what all machines share and nobody knows; empty if
/// the study has no worlds, or a world has no trials yet.
/// @param chosen_from number of points from which the point was chosen
std::optional<worlds::PointWorlds> worlds_of_point(const StudySummary& summary, std::int64_t point,
                                                   std::size_t chosen_from = 1);

/// Parameters that differ between the worlds (draws of what all machines share) at a design point, and
/// quantities derived from them.
/// @param summary summary of a study with worlds
inline const std::vector<worlds::WorldInput>& world_inputs_of(const StudySummary& summary,
                                                              std::int64_t point) {
  return summary.world_inputs[static_cast<std::size_t>(point)];
}

/// Sentence on the worlds (draws of what all machines share) that miss the goal: "5 of 30 worlds fall short
/// of the goal: where friction.alpha > 1.4 1/s (5 of these 5, and 1 of the other 25; by chance with
/// probability 0.0025); what separates them need not be the cause". The sentence also names other quantities
/// that separate the same worlds, and explains derived quantities.
std::string bad_worlds_sentence(const worlds::PointWorlds& point,
                                const std::vector<worlds::WorldInput>& inputs,
                                const goal::Question& question);

/// The results in each world (draw of what all machines share) at a design point, with the parameters that
/// differ between worlds.
struct WorldsAtPoint {
  const worlds::PointWorlds& point;
  const std::vector<worlds::WorldInput>& inputs;
  const goal::Question& question;
};

/// The output items of WorldsAtPoint: proportions and verdicts by world, the bad worlds, and the rule that
/// separates them. People are shown the proportions by which the study is judged.
document::Description<WorldsAtPoint> worlds_description(const goal::Question& question);

}  // namespace zerocount::summary
