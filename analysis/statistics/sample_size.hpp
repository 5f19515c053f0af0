#pragma once

#include <cstdint>

/// Planning: the number of trials that a claim needs.
namespace zerocount::statistics {

/// The minimum number n of trials so that at most `failures` failures show a success rate of at least
/// `success` with the stated confidence: P(B ≤ failures) ≤ 1 − confidence for B binomial (n, 1 − success).
/// Without a failure n = ⌈ln(1 − confidence)/ln(success)⌉ (Wilks 1941).
/// @throws Failure (bad_input) for a proportion or confidence outside (0, 1), a negative number of failures,
/// or a claim that needs more than 10¹² trials.
std::int64_t trials_for_claim(double success, double confidence, std::int64_t failures);

/// Power of a plan: the probability of at most `failures` failures in `trials` trials with the success
/// probability `true_success`.
double chance_of_claim(std::int64_t trials, std::int64_t failures, double true_success);

/// A plan: run `trials` trials, and make the claim if at most `failures` fail.
struct ClaimPlan {
  std::int64_t failures{0};
  std::int64_t trials{0};
};

/// The plan with the fewest trials whose power is at least `power` for the success probability
/// `true_success`.
/// @throws Failure (bad_input) if true_success ≤ success: no number of trials is enough.
ClaimPlan plan_with_power(double success, double confidence, double true_success, double power);

/// The minimum number of trials for which the Clopper–Pearson interval has at most this half-width if the
/// proportion `rate` of them succeeds. A rate of ½ is the worst case.
/// @throws Failure (bad_input) for a half-width outside (0, ½), or a rate or confidence outside (0, 1).
std::int64_t trials_for_halfwidth(double halfwidth, double confidence, double rate);

}  // namespace zerocount::statistics
