#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/trials/goal/goal_verdict.hpp"
#include "experiments/study/study.hpp"
#include "runners/trials/effort.hpp"
#include "runners/trials/variant.hpp"
#include "runners/tuning/machine_runs/machine_runner.hpp"

/// Simulates a tuned study at ages that its manifest need not name, on machines that its search did not use.
/// Finds the age at which the values lose each of their claims (goal under a condition).
namespace zerocount::tuning {

/// Verdicts on all claims (goals under conditions) at one age, from simulated machines.
struct AgeVerdict {
  double age{0.0};
  /// Verdicts on all pairs of goal and condition of the manifest, goal by goal.
  std::vector<goal::ClaimVerdict> claims;
};

/// Number of trials that a machine runs at one age.
/// @param trials_each number of trials that the machine runs at all ages together
std::int64_t trials_at_one_age(const study::Study& study, std::int64_t trials_each);

/// Text such as " of goal 'small' under condition cold". It names the goal only if there are several, and the
/// condition only if there are any.
std::string text_of(const study::Study& study, const ClaimPlace& claim);

/// Ages at which a claim (a goal under a condition) is no longer met. They assume that a machine which misses
/// a claim goes on missing it at older ages. They are the first such ages among those that were tried, with a
/// resolution of 10 %. The tried ages depend on the results.
struct LostClaim {
  /// Goal and condition of the claim; the setting is an index in without_ages(Study::settings).
  ClaimPlace claim;
  /// Youngest tried age at which the proportion of machines, or of moves, that meet the goal is smaller than
  /// the goal asks for. Nothing if the goal is met up to the oldest tried age.
  std::optional<double> lost{};
  /// Bounds of the age at which the claim is lost: up to and including `met_until` the goal is shown to be
  /// met, from `missed_from` on it is shown to be missed. Each bound holds with the confidence of the goal.
  /// At the true age of loss, whatever it is, a verdict is wrong with probability at most 1 − confidence, and
  /// the bound errs only if that verdict is wrong.
  std::optional<double> met_until{}, missed_from{};
};

/// Result of lost_ages(): the ages at which claims are no longer met, and all verdicts behind them.
struct LostAges {
  /// One entry for each claim (a goal under a condition), in the order of AgeVerdict::claims.
  std::vector<LostClaim> claims;
  std::vector<AgeVerdict> tried;  ///< Verdicts on all claims at the tried ages, in ascending order of age.
  /// Error message of an older age at which the study cannot be simulated, so that no older ages were tried;
  /// empty if there was none.
  std::string refusal{};
  /// Number of machines on which each age was simulated; all ages use the same machines.
  std::int64_t machines{0};
};

/// Simulates the ages of the study, one between each two of them, then decades beyond the last one, on the
/// same fresh machines with the same draws at every age:
///
///     simulate them in their order, until every claim is shown to be missed, 10⁶ times the last age of the
///       study, or the oldest age at which the values stay in their ranges
///     for each claim, where it is no longer met by its rate, by its lower, and by its upper bound:
///       between the last age before and the first age after it, by geometric means to 10 %
///
/// @param study study with ages, at the values of its manifest
/// @param machines machines, and their trials at one age in all settings together
/// @throws trial::Interrupted, trials::Spent
LostAges lost_ages(const study::Study& study, const trials::Replicates& machines, trials::Effort effort);

/// Approximate number of ages that lost_ages() simulates, each on all its machines.
std::int64_t points_of_lost_ages(const study::Study& study);

}  // namespace zerocount::tuning
