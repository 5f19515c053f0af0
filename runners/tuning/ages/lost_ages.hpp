#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runners/tuning/ages/age_runs.hpp"

/// The age at which tuned values lose each of their claims.
namespace zerocount::tuning {

/// A claim over age. The ages assume that a machine which misses a claim goes on missing it: they are the
/// first of those that were tried, to 10 %, and which ones are tried depends on what the machines did.
struct LostClaim {
  ClaimOfLife claim;
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
  std::vector<LostClaim> claims;  ///< as claims_of_life()
  std::vector<AgeVerdict> tried;  ///< rising ages
  std::string refusal{};          ///< why no older age than the oldest was tried; empty if none was needed
  std::int64_t units{0};          ///< machines, the same at all ages
};

/// The ages of the study, one between each two of them, then decades beyond the last one:
///
///     simulate them in their order, until every claim is shown to be missed, 10⁶ times the last age of the
///       study, or the oldest age at which the values stay in their ranges
///     for each claim, where it is no longer met by its rate, by its lower, and by its upper bound:
///       between the last age before and the first age after it, by geometric means to 10 %
///
/// @param runs on machines that the search did not use
/// @throws trial::Interrupted, trials::Spent
LostAges lost_ages(const AgeRuns& runs, const std::vector<study::FreeParameter>& free, const Values& values);

/// Ages that lost_ages() simulates, about.
std::int64_t points_of_lost_ages(const study::Study& study);

}  // namespace zerocount::tuning
