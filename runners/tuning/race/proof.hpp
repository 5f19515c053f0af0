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

/// One run of a finalist on units that neither the search nor another attempt has seen.
struct Attempt {
  int number{1};            ///< from 1
  std::size_t finalist{0};  ///< of ProofProblem::may_meet
  std::int64_t units{0};
};

/// Attempts at most. The error probability α of the goal's confidence is divided among them, 1/2, 1/4, 1/4,
/// so that the claim of whichever succeeds is false with probability α at most, however the finalists were
/// found.
inline constexpr int max_attempts = 3;

/// The reciprocal of the part of α that this attempt has.
std::size_t correction_of(int attempt);

/// What a goal is about, machines or moves: the proportion that meets it, and the one that it asks for.
inline const goal::BoundedProportion& judged_rate(const study::Goal& goal,
                                                  const goal::WorldVerdict& verdict) {
  return goal.machines ? verdict.machines : verdict.moves;
}
inline double asked_rate(const study::Goal& goal) {
  return goal.machines.value_or(goal.moves);
}

/// The moves that meet each goal, [goal].
using GoalCounts = std::vector<measures::CellCounts>;

/// What an attempt shows.
struct AttemptResult {
  GoalCounts counts;
  goal::Verdict verdict;  ///< With the attempt's part of α.
};

struct ProofProblem {
  std::vector<bool> may_meet;   ///< [finalist] whether it may meet all goals, by the search; the best first
  std::vector<double> margins;  ///< [finalist] Estimate::margin: the larger, the surer it meets them
  /// Units that are expected to decide the goals with this correction, by the results of the search.
  std::function<std::int64_t(std::size_t finalist, std::size_t correction)> first_units;
  /// Units that are expected to decide them, by the results of an attempt.
  std::function<std::int64_t(const GoalCounts&, std::size_t correction)> more_units;
  /// Nothing if the effort ended before the attempt.
  std::function<std::optional<AttemptResult>(const Attempt&)> run;
  /// Whether the last run shows that the finalist does not keep a margin. It is not the answer then.
  std::function<bool(const Attempt&)> rejects;
  std::function<bool()> goes_on;  ///< whether the effort is enough for another attempt
};

/// The last attempt and its result.
struct ProvenFinalist : AttemptResult {
  Attempt attempt;
  bool keeps_margins{true};  ///< ProofProblem::rejects
  bool all_tried{true};      ///< every finalist that may meet the goals was run
};

/// Proves the best finalist or, where it misses the goals, the surest of the others: the best ones were
/// chosen because they look fast on the units of the search, and miss goals at the limit of what is possible.
///
///     finalist = 0
///     for attempt = 1 … max_attempts, while the effort is enough:
///       run the finalist on fresh units; its verdict has the attempt's part of α
///       met: done; missed, or a margin is not kept: of the others that may meet the goals, the one with the
///       largest margin; undecided: again on more units, if more are expected to decide
///
/// @returns the last attempt; nothing if the effort ended before the first one
std::optional<ProvenFinalist> prove(const ProofProblem& problem);

}  // namespace zerocount::tuning
