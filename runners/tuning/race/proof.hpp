#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/measures/goal_counts.hpp"
#include "experiments/study/goal.hpp"

namespace zerocount::tuning {

/// One run of a finalist on machines that neither the search nor another attempt has seen.
struct Attempt {
  int number{1};             ///< Number of the attempt, counted from 1.
  std::size_t finalist{0};   ///< Index in ProofProblem::may_meet.
  std::int64_t machines{0};  ///< Number of machines.
};

/// Maximum number of attempts. The error probability α = 1 − confidence is divided among the attempts as 1/2,
/// 1/4, 1/4. So the claim of a successful attempt is false with probability at most α, however the finalists
/// were found.
inline constexpr int max_attempts = 3;

/// Reciprocal of the fraction of α that the attempt may use: 2 for the first attempt, 4 for the others.
std::size_t correction_of(int attempt);

/// Proportion that the goal judges, with its bounds: of machines if the goal asks for machines, else of
/// moves.
inline const goal::BoundedProportion& judged_rate(const study::Goal& goal,
                                                  const goal::WorldVerdict& verdict) {
  return goal.machines ? verdict.machines : verdict.moves;
}
/// Proportion that the goal asks for: of machines if it names one, else of moves.
inline double asked_rate(const study::Goal& goal) {
  return goal.machines.value_or(goal.moves);
}

/// [goal] Counts of the moves that meet the goal.
using GoalCounts = std::vector<measures::CellCounts>;

/// Result of an attempt.
struct AttemptResult {
  GoalCounts counts;
  goal::Verdict verdict;  ///< Verdict with the attempt's fraction of α.
};

/// Finalists of a search, and the functions with which prove() examines them.
struct ProofProblem {
  /// [finalist] Whether the finalist may meet all goals, judged by the search. The best finalist comes first.
  std::vector<bool> may_meet;
  std::vector<double> margins;  ///< [finalist] Estimate::margin. A larger margin makes success more certain.
  /// Number of machines expected to decide the goals, from the finalist's results in the search. `correction`
  /// is correction_of() of the attempt.
  std::function<std::int64_t(std::size_t finalist, std::size_t correction)> first_machines;
  /// Number of machines expected to decide the goals, from the counts of an earlier attempt.
  std::function<std::int64_t(const GoalCounts&, std::size_t correction)> more_machines;
  /// Runs an attempt. Returns nothing if the effort ended before.
  std::function<std::optional<AttemptResult>(const Attempt&)> run;
  /// Whether the last run shows that the finalist violates a wanted margin. Such a finalist is not the
  /// answer.
  std::function<bool(const Attempt&)> rejects;
  std::function<bool()> goes_on;  ///< Whether the effort is enough for another attempt.
};

/// The last attempt of a proof, with its result.
struct ProvenFinalist : AttemptResult {
  Attempt attempt;
  bool keeps_margins{true};  ///< False if ProofProblem::rejects the finalist.
  bool all_tried{true};      ///< Whether every finalist that may meet the goals was run.
};

/// Proves the best finalist. If it misses the goals, proves the surest of the other finalists: the best ones
/// were chosen because they look fast on the machines of the search, so they may miss goals at the limit of
/// what is possible.
///
///     finalist = 0
///     for attempt = 1 … max_attempts, while the effort is enough:
///       run the finalist on fresh machines; its verdict has the attempt's fraction of α
///       met: done
///       missed, or a margin is not kept: finalist = the one with the largest margin among those that may
///         meet the goals and were not tried
///       undecided: again on more machines, if these are expected to decide
///
/// @returns the last attempt; nothing if the effort ended before the first one
std::optional<ProvenFinalist> prove(const ProofProblem& problem);

}  // namespace zerocount::tuning
