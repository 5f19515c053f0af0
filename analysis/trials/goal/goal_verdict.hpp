#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/trials/goal/standing.hpp"
#include "analysis/trials/measures/move_counts.hpp"
#include "experiments/study/goal.hpp"

/// Judgement of the goals of a study at a design point. All code that judges uses judge_goal() or
/// judge_goals().
namespace zerocount::goal {

enum class Status {
  met,       ///< the lower bound of the proportion reaches what the goal demands
  missed,    ///< the upper bound of the proportion is below what the goal demands
  undecided  ///< Neither is shown: the demanded proportion is between the bounds.
};

/// Text of a status: "met", "missed" or "undecided".
std::string_view text_of(Status status);

/// A proportion with one-sided bounds, each with the confidence of the verdict.
struct BoundedProportion {
  double value{statistics::unknown};
  double low{0.0};
  double high{1.0};
};

/// Rank of a proportion that is not demanded by any goal, to compare it with others of the same kind.
Standing standing_of(const BoundedProportion& proportion);

/// The proportion, lower bound and upper bound that are the smaller ones of `a` and `b`, each on its own.
BoundedProportion lowest(const BoundedProportion& a, const BoundedProportion& b);

/// The proportions and the verdict on a claim (a goal in one setting) in one world, which is one draw of what
/// all machines share.
struct WorldVerdict {
  Status status{Status::undecided};
  /// Proportion of all moves of all machines that meets the goal; bounds by clustered_proportion.hpp.
  BoundedProportion moves;
  /// Proportion of machines that meet the goal in at least the proportion Goal::moves of their moves; bounds
  /// by machine_proportion.hpp. Value NaN and bounds 0 and 1 if the goal does not ask for machines.
  BoundedProportion machines;
  /// Proportion of machines without a miss in as many moves as were observed on each. Value NaN and bounds 0
  /// and 1 if the goal does not ask for machines.
  BoundedProportion without_miss;
  /// Number of observed machines that meet the goal in at least the proportion Goal::moves of their moves; 0
  /// if the goal does not ask for machines.
  std::int64_t machines_meeting{0};
  std::int64_t machines_without_miss{0};  ///< Number of observed machines all of whose moves meet the goal.
};

/// The verdict on a claim, which is one goal in one setting, for all machines that the manifest
/// describes. The goal is judged by Goal::machines, or by Goal::moves if it does not ask for machines. With
/// worlds each proportion, lower bound and upper bound is the lowest over the worlds.
///
/// The goal is met if it is met in every world, each at the confidence γ. A claim that must hold in every
/// part needs no correction for the number of parts (intersection–union test; Berger, Technometrics 24 (1982)
/// 295). The goal is missed if it is shown to be missed in one world, so the upper bounds have the confidence
/// 1 − (1 − γ)/worlds (Bonferroni).
struct ClaimVerdict : WorldVerdict {
  std::size_t goal{0};                 ///< Index of the goal in the list of judged goals.
  std::size_t setting{0};              ///< Index of the setting (condition at an age); 0 without settings.
  std::vector<WorldVerdict> worlds{};  ///< [world] Verdict on the claim in each world; empty without worlds.
  /// Proportion of moves in which the load meets a goal of the motor, in the setting with the lowest
  /// proportion (`load_setting`). Empty unless the moves of the load are counted (Goal::beside_load).
  std::optional<BoundedProportion> of_load{};
  std::size_t load_setting{0};
  Standing standing{};
};

/// The proportion by which the goal is judged, with its bounds: of machines if the goal is about machines, of
/// moves otherwise.
inline const BoundedProportion& judged_rate(const study::Goal& goal, const WorldVerdict& verdict) {
  return goal.machines ? verdict.machines : verdict.moves;
}

/// The verdict on several claims, all of which must be met. It is the verdict on the worst claim (Standing).
/// Claims rank missed, undecided, met. Ties go to the claim whose lower bound has the smallest margin to the
/// proportion demanded, as a difference of logits. The upper bounds allow for the number of claims
/// (Bonferroni).
struct Verdict : ClaimVerdict {
  std::vector<ClaimVerdict> claims{};  ///< Verdicts on the single claims: [goal, setting], flattened.
};

/// The verdicts on each goal in each setting, and the verdict on all of them together.
/// @param counts [goal] counts of the moves
/// @param points number of design points from which the point was chosen by its trials; 1 if it was chosen
/// before. The bounds have the confidence 1 − (1 − γ)/points (Bonferroni).
/// @param parts number of parts in each of which all these claims must be met
Verdict judge_goals(std::span<const study::Goal> goals, std::span<const measures::CellCounts> counts,
                    std::size_t points, std::size_t parts = 1);
inline Verdict judge_goal(const study::Goal& goal, const measures::CellCounts& counts, std::size_t points,
                          std::size_t parts = 1) {
  return judge_goals({&goal, 1}, {&counts, 1}, points, parts);
}
/// The verdict on one goal from the moves of one world (a draw of what all machines share).
/// @param points number of design points from which the point was chosen; 1 if it was chosen before
/// @param parts number of claims that must all be met
ClaimVerdict judge_goal(const study::Goal& goal, const measures::MoveCounts& counts, std::size_t points,
                        std::size_t parts = 1);

/// The worst of the verdict's claims on the goal with the index `goal` or, for worst_where(), of the claims
/// that `is_asked` selects. The verdict must have such a claim.
const ClaimVerdict& worst_of_goal(const Verdict& verdict, std::size_t goal);
const ClaimVerdict& worst_where(const Verdict& verdict,
                                const std::function<bool(const ClaimVerdict&)>& is_asked);

/// Number by which statuses are ranked, the worst one first: 0 for missed, 1 for undecided, 2 for met.
int rank_of(Status status);
/// Whether the claim `one` is worse than `other`, by their standing (Standing).
inline bool is_worse(const ClaimVerdict& one, const ClaimVerdict& other) {
  return one.standing < other.standing;
}

/// Indices of the worlds by rising proportion that meets the goal, the worst world first. The proportion is
/// of machines if the goal asks for them, otherwise of moves. Worlds without trials come last.
std::vector<std::size_t> worst_worlds_first(const study::Goal& goal, const ClaimVerdict& verdict);

/// Indices of the worlds whose verdict has this status, rising.
std::vector<std::size_t> worlds_that(Status status, const ClaimVerdict& verdict);

/// Size of a study that decides the goal with a stated probability.
struct Needs {
  std::int64_t machines{0};  ///< Number of machines; 0 for a study without machines.
  /// Number of trials per design point; 0 if no study of up to 10⁹ trials is large enough.
  std::int64_t trials{0};
};

/// Default probability with which a study of the size that needs_of() returns is decided.
inline constexpr double probability_of_needs = 0.9;

/// Studies large enough to decide the verdict on all goals in all settings with at least this
/// probability. The chances follow from the observed counts (goal_needs.cpp). The goals and settings may
/// depend on each other in any way, because
///
///   P(decided) ≥ max(1 − Σ P(a claim is undecided), max P(a claim is missed)).
///
/// Without machines the result is one study, the smallest. With machines it is the study with the fewest
/// machines, at most 10⁵, and as many trials on each machine as observed. For goals on machines there follow
/// studies with twice, four times … as many trials on each machine, as long as these save machines. Empty if
/// no study is large enough.
/// @param counts [goal]
/// @param points as for judge_goals()
std::vector<Needs> deciding_studies(std::span<const study::Goal> goals,
                                    std::span<const measures::CellCounts> counts, std::size_t points,
                                    double probability = probability_of_needs);

/// The study with the fewest trials.
/// @param studies at least one study
const Needs& cheapest(std::span<const Needs> studies);

/// The study with the fewest trials among those that decide all goals with this probability; see
/// deciding_studies() for the parameters.
Needs needs_of(std::span<const study::Goal> goals, std::span<const measures::CellCounts> counts,
               std::size_t points, double probability = probability_of_needs);
inline Needs needs_of(const study::Goal& goal, const measures::CellCounts& counts, std::size_t points,
                      double probability = probability_of_needs) {
  return needs_of({&goal, 1}, {&counts, 1}, points, probability);
}

/// A goal with the number of moves per trial that it judges.
struct AskedGoal {
  study::Goal goal;
  std::int64_t moves{1};
};

/// Grouping of the trials of a study by machines, worlds and settings.
struct StudyShape {
  bool on_machines{false};  ///< Whether trials share machines.
  /// Number of worlds (draws of what all machines share); the goals must be met in each. 0: the study has
  /// none.
  std::int64_t worlds{0};
  /// Number of settings (conditions at ages); the goals must be met in each. 1 without settings.
  std::int64_t settings{1};
};

/// The smallest studies that can meet the goals, if no move misses them. With machines: for several numbers
/// of trials on each machine, the fewest machines that suffice. Without machines: one study. Empty if no
/// study of up to 10⁹ trials or 10⁵ machines can meet them.
/// @param points number of design points from which the best is chosen
std::vector<Needs> smallest_studies(std::span<const AskedGoal> goals, const StudyShape& shape,
                                    std::size_t points);
/// The smallest studies that can meet one goal in one setting, if no move misses it.
/// @param on_machines whether trials share machines
/// @param moves number of moves per trial that the goal judges
/// @param points number of design points from which the best is chosen
inline std::vector<Needs> smallest_studies(const study::Goal& goal, bool on_machines, std::int64_t moves,
                                           std::size_t points, std::int64_t worlds = 0) {
  const AskedGoal asked{goal, moves};
  return smallest_studies({&asked, 1}, {on_machines, worlds}, points);
}

}  // namespace zerocount::goal
