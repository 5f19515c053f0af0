#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/goal/standing.hpp"
#include "analysis/measures/goal_counts.hpp"
#include "analysis/statistics/unknown.hpp"
#include "experiments/study/goal.hpp"

/// The goal of a study at a design point. Everything that judges asks judge_goal().
namespace zerocount::goal {

enum class Status {
  met,       ///< the lower bound reaches the goal
  missed,    ///< the upper bound is below it
  undecided  ///< neither
};

/// "met", "missed", "undecided".
std::string_view text_of(Status status);

/// A proportion with one-sided bounds, each with the confidence of the verdict.
struct BoundedProportion {
  double value{statistics::unknown};
  double low{0.0};
  double high{1.0};
};

/// The standing of a proportion of which nothing is claimed, among others of the same kind.
Standing standing_of(const BoundedProportion& proportion);

/// The lowest of the proportions, of their lower bounds, and of their upper bounds.
BoundedProportion lowest(const BoundedProportion& a, const BoundedProportion& b);

/// The moves, or machines, of one world that meet the goal.
struct WorldVerdict {
  Status status{Status::undecided};
  BoundedProportion moves;  ///< of all moves of all axes that meet the goal (clustered_proportion.hpp)
  BoundedProportion
      machines;  ///< of axes that meet it in Goal::moves of their moves (machine_proportion.hpp);
                 ///< NaN, 0 and 1 where the goal does not ask for machines
  BoundedProportion without_miss;    ///< of all axes, in as many moves; where the goal asks for machines
  std::int64_t machines_meeting{0};  ///< machines that meet it in Goal::moves of their moves, as observed
  std::int64_t machines_without_miss{0};  ///< machines all of whose moves meet the goal
};

/// The verdict on a claim, one goal under one condition, for all axes that the manifest describes; by
/// Goal::machines, or by Goal::moves where the goal does not ask for machines. With worlds the proportions
/// are those of the worst world: the lowest of all, and of the bounds. A goal is met if it is met in every
/// world, each at the confidence γ: that a claim must hold in every part needs no correction for their number
/// (intersection–union test; Berger, Technometrics 24 (1982) 295). It is missed if it is shown to be missed
/// in one: the upper bounds have the confidence 1 − (1 − γ)/worlds (Bonferroni).
struct ClaimVerdict : WorldVerdict {
  std::size_t goal{0};
  std::size_t condition{0};            ///< 0 without conditions
  std::vector<WorldVerdict> worlds{};  ///< [world]; empty without worlds
  /// Moves of the load that meet a goal of the motor, under the condition where they are the fewest.
  std::optional<BoundedProportion> of_load{};
  std::size_t load_condition{0};
  Standing standing{};
};

/// The verdict on several claims, all of which must be met, as that of the worst (Standing): a missed one
/// before an undecided one before one that is met; among equals the one whose lower bound is least above what
/// it asks for, as the difference of the logits. The upper bounds allow for the number of claims
/// (Bonferroni).
struct Verdict : ClaimVerdict {
  std::vector<ClaimVerdict> claims{};  ///< [goal, condition] each
};

/// The verdict on each goal under each condition. @param counts [goal]
/// @param points number of design points from which the point was chosen by its trials; 1 if it was chosen
/// before. The bounds have the confidence 1 − (1 − γ)/points (Bonferroni). @param parts as many times these
/// claims must be met
Verdict judge_goals(std::span<const study::Goal> goals, std::span<const measures::CellCounts> counts,
                    std::size_t points, std::size_t parts = 1);
inline Verdict judge_goal(const study::Goal& goal, const measures::CellCounts& counts, std::size_t points,
                          std::size_t parts = 1) {
  return judge_goals({&goal, 1}, {&counts, 1}, points, parts);
}
/// The verdict on one claim, by moves of one world. @param parts claims that must be met
ClaimVerdict judge_goal(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points,
                        std::size_t parts = 1);

/// The worst of the claims on one goal, or of the claims in another group. The verdict has such a claim.
const ClaimVerdict& worst_of_goal(const Verdict& verdict, std::size_t goal);
const ClaimVerdict& worst_where(const Verdict& verdict,
                                const std::function<bool(const ClaimVerdict&)>& is_asked);

/// From the worst status, missed, to the best: 0, 1, 2.
int rank_of(Status status);
/// Whether the first claim has the smaller standing.
inline bool is_worse(const ClaimVerdict& one, const ClaimVerdict& other) {
  return one.standing < other.standing;
}

/// The worlds in order of their proportions, the worst first: of machines that meet the goal where it asks
/// for them, else of moves.
std::vector<std::size_t> worst_worlds_first(const study::Goal& goal, const ClaimVerdict& verdict);

/// The worlds of which the verdict says this, in order.
std::vector<std::size_t> worlds_that(Status status, const ClaimVerdict& verdict);

/// Study size that decides the goal with a stated probability.
struct Needs {
  std::int64_t machines{0};  ///< 0 without machines
  std::int64_t trials{0};    ///< per design point; 0 if no study of up to 10⁹ trials is large enough
};

/// Probability with which a study of the size of needs_of() is decided, unless another is asked for.
inline constexpr double probability_of_needs = 0.9;

/// Studies of which the verdict on all goals under all conditions is decided with this probability, at least,
/// by what these counts leave likely (goal_needs.cpp), whatever goals and conditions have in common:
///
///   P(decided) ≥ max(1 − Σ P(a claim is undecided), max P(a claim is missed)).
///
/// Without machines one study, the smallest; with machines the fewest machines, at most 10⁵, with trials on
/// each as observed, and for goals on machines with twice, four times … as many, as long as these save
/// machines. Empty if none is large enough. @param counts [goal] @param points, as of judge_goal()
std::vector<Needs> deciding_studies(std::span<const study::Goal> goals,
                                    std::span<const measures::CellCounts> counts, std::size_t points,
                                    double probability = probability_of_needs);

/// The study with the fewest trials. @param studies at least one
const Needs& cheapest(std::span<const Needs> studies);

/// The cheapest of deciding_studies().
Needs needs_of(std::span<const study::Goal> goals, std::span<const measures::CellCounts> counts,
               std::size_t points, double probability = probability_of_needs);
inline Needs needs_of(const study::Goal& goal, const measures::CellCounts& counts, std::size_t points,
                      double probability = probability_of_needs) {
  return needs_of({&goal, 1}, {&counts, 1}, points, probability);
}

/// A goal, and the number of moves of a trial that it asks.
struct AskedGoal {
  study::Goal goal;
  std::int64_t moves{1};
};

/// The machines and worlds that the trials of a study share.
struct StudyShape {
  bool on_machines{false};
  std::int64_t worlds{0};      ///< in each of which the goals must be met; 0: none
  std::int64_t conditions{1};  ///< under each of which they must be met
};

/// The smallest studies that can meet the goals, if no move misses them: with machines the fewest machines
/// for several numbers of trials on each, without them one study. Empty if none of up to 10⁹ trials, or 10⁵
/// machines, can. @param points that the best is chosen from
std::vector<Needs> smallest_studies(std::span<const AskedGoal> goals, const StudyShape& shape,
                                    std::size_t points);
/// The same of one goal under one condition. @param moves of a trial
inline std::vector<Needs> smallest_studies(const study::Goal& goal, bool on_machines, std::int64_t moves,
                                           std::size_t points, std::int64_t worlds = 0) {
  const AskedGoal asked{goal, moves};
  return smallest_studies({&asked, 1}, {on_machines, worlds}, points);
}

}  // namespace zerocount::goal
