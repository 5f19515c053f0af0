#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/trials/goal/goal_verdict.hpp"
#include "analysis/trials/measures/move_counts.hpp"
#include "experiments/study/goal.hpp"

namespace zerocount::tuning {

/// One run of a finalist of the search on machines that neither the search nor another attempt has seen, to
/// prove that its values meet the goals.
struct Attempt {
  int number{1};             ///< Number of the attempt, counted from 1.
  std::size_t finalist{0};   ///< Index of the finalist in ProofProblem::may_meet.
  std::int64_t machines{0};  ///< Number of machines that the attempt simulates.
};

/// Maximum number of attempts to prove a finalist of the search. The error probability α = 1 − confidence is
/// divided among the attempts as 1/2, 1/4, 1/4. So the claim of a successful attempt is false with
/// probability at most α, however the finalists were found.
inline constexpr int max_attempts = 3;

/// Reciprocal of the fraction of the error probability α that the attempt may use: 2 for the first attempt, 4
/// for the others.
/// @param attempt number of the attempt, from 1
std::size_t correction_of(int attempt);

/// [goal] Counts of the moves that each goal judges, and of those that meet it.
using GoalCounts = std::vector<measures::CellCounts>;

/// Result of one attempt to prove a finalist: counts and verdict on the goals.
struct AttemptResult {
  GoalCounts counts;
  goal::Verdict verdict;  ///< Verdict whose bounds use the attempt's fraction of the error probability α.
};

/// Finalists of a search for good values, and the functions with which prove() examines them.
struct ProofProblem {
  /// [finalist] Whether the finalist may meet all goals, judged by the search. The best finalist comes first.
  std::vector<bool> may_meet;
  /// [finalist] RateEstimate::margin, how far the worst rate is above the wanted one. A larger margin makes
  /// success more certain.
  std::vector<double> margins;
  /// Returns the number of machines expected to decide the goals, from the finalist's results in the search.
  /// `correction` is correction_of() of the attempt.
  std::function<std::int64_t(std::size_t finalist, std::size_t correction)> first_machines;
  /// Returns the number of machines expected to decide the goals, from the counts of an earlier attempt.
  /// `correction` is correction_of() of the next attempt.
  std::function<std::int64_t(const GoalCounts&, std::size_t correction)> more_machines;
  /// Runs an attempt on fresh machines. Returns nothing if the effort ended before.
  std::function<std::optional<AttemptResult>(const Attempt&)> run;
  /// Whether the last run of the attempt's finalist shows that it violates a wanted stability margin. Such a
  /// finalist is not the answer.
  std::function<bool(const Attempt&)> rejects;
  std::function<bool()> goes_on;  ///< Whether enough effort (trials and time) is left for another attempt.
};

/// The last attempt to prove a finalist of a search, with its result.
struct ProvenFinalist : AttemptResult {
  Attempt attempt;
  /// Whether the finalist keeps the wanted stability margins; false if ProofProblem::rejects it.
  bool keeps_margins{true};
  bool all_tried{true};  ///< Whether every finalist that may meet the goals was run in an attempt.
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
