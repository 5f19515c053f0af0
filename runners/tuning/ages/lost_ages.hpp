#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "experiments/study/study.hpp"
#include "runners/trials/effort.hpp"
#include "runners/trials/variant.hpp"
#include "runners/tuning/units/unit_runner.hpp"

/// A tuned study at ages that its manifest need not name, on machines that its search did not use: the age at
/// which the values lose each of their claims.
namespace zerocount::tuning {

/// What machines of one age do: the claims of a verdict on the age alone.
struct AgeVerdict {
  double age{0.0};
  std::vector<goal::ClaimVerdict> claims;  ///< goal by goal, each under every condition of the manifest
};

/// Trials of a unit at one age, of those that it has at all ages together.
std::int64_t trials_at_one_age(const study::Study& study, std::int64_t trials_each);

/// " of goal 'small' under condition cold", as far as the study has several goals, and conditions.
std::string text_of(const study::Study& study, const ClaimPlace& claim);

/// A claim over age. The ages assume that a machine which misses a claim goes on missing it: they are the
/// first of those that were tried, to 10 %, and which ones are tried depends on what the machines did.
struct LostClaim {
  ClaimPlace claim;  ///< whatever the age: the condition is one of Study::condition_names
  /// The youngest age at which fewer machines, or moves, than asked for meet the goal; nothing up to the
  /// oldest age that was tried.
  std::optional<double> lost{};
  /// The age up to and including which the goal is shown to be met, and that from which on it is shown to be
  /// missed. Each is a bound of the age at which the claim is lost with the confidence of the goal: at that
  /// age, be it what it may, a verdict is wrong with 1 − confidence at most, and the bound errs only if that
  /// one is.
  std::optional<double> met_until{}, missed_from{};
};

struct LostAges {
  std::vector<LostClaim> claims;  ///< as AgeVerdict::claims
  std::vector<AgeVerdict> tried;  ///< rising ages
  std::string refusal{};          ///< why no older age than the oldest was tried; empty if none was needed
  std::int64_t units{0};          ///< machines, the same at all ages
};

/// Simulates the ages of the study, one between each two of them, then decades beyond the last one, on the
/// same fresh machines with the same draws at every age:
///
///     simulate them in their order, until every claim is shown to be missed, 10⁶ times the last age of the
///       study, or the oldest age at which the values stay in their ranges
///     for each claim, where it is no longer met by its rate, by its lower, and by its upper bound:
///       between the last age before and the first age after it, by geometric means to 10 %
///
/// @param study with ages, of which the values are those of its manifest @param units of one age, under all
/// conditions together
/// @throws trial::Interrupted, trials::Spent
LostAges lost_ages(const study::Study& study, const trials::Replicates& units, trials::Effort effort);

/// Ages that lost_ages() simulates, about.
std::int64_t points_of_lost_ages(const study::Study& study);

}  // namespace zerocount::tuning
