#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "experiments/study/study.hpp"
#include "runners/trials/effort.hpp"
#include "runners/trials/variant.hpp"
#include "runners/tuning/machine_runs/machine_runner.hpp"

/// A tuned study at ages that its manifest need not name, on machines that its search did not use: the age at
/// which the values lose each of their claims.
namespace zerocount::tuning {

/// Claims of a verdict on machines of one age.
struct AgeVerdict {
  double age{0.0};
  std::vector<goal::ClaimVerdict> claims;  ///< All pairs of goal and manifest setting, goal by goal.
};

/// Number of trials of a machine at one age.
/// @param trials_each trials of the machine at all ages together
std::int64_t trials_at_one_age(const study::Study& study, std::int64_t trials_each);

/// Text such as " of goal 'small' under condition cold". It names the goal only if there are several, and the
/// setting only if there are any.
std::string text_of(const study::Study& study, const ClaimPlace& claim);

/// Ages at which a claim is lost. They assume that a machine which misses a claim goes on missing it at older
/// ages. They are the first such ages among those that were tried, with a resolution of 10 %. The tried ages
/// depend on the results.
struct LostClaim {
  ClaimPlace claim;  ///< Goal and setting; the setting is an index in without_ages(Study::settings).
  /// Youngest age at which fewer machines, or moves, than asked for meet the goal. Nothing if the goal is met
  /// up to the oldest tried age.
  std::optional<double> lost{};
  /// Bounds of the age at which the claim is lost: up to and including `met_until` the goal is shown to be
  /// met, from `missed_from` on it is shown to be missed. Each bound holds with the confidence of the goal.
  /// At the true age of loss, whatever it is, a verdict is wrong with probability at most 1 − confidence, and
  /// the bound errs only if that verdict is wrong.
  std::optional<double> met_until{}, missed_from{};
};

/// Result of lost_ages().
struct LostAges {
  std::vector<LostClaim> claims;  ///< One entry for each claim, in the order of AgeVerdict::claims.
  std::vector<AgeVerdict> tried;  ///< Verdicts on the tried ages, in ascending order of age.
  std::string refusal{};          ///< Why no older age was tried; empty if none was needed.
  std::int64_t machines{0};       ///< Number of machines; all ages use the same machines.
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

/// Approximate number of ages that lost_ages() simulates.
std::int64_t points_of_lost_ages(const study::Study& study);

}  // namespace zerocount::tuning
