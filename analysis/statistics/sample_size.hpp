#pragma once

#include <cstdint>
#include <vector>

/// How many trials a claim needs, before they are run.
namespace zerocount {

/// The fewest trials n with which up to `failures` failures still show that a proportion of at least
/// `success` succeeds, with the stated confidence: P(B ≤ failures) ≤ 1 − confidence for B binomial (n, 1 −
/// success). Without a failure n = ⌈ln(1 − confidence)/ln(success)⌉ (Wilks 1941).
/// @throws Failure (bad_input) for a proportion or confidence outside (0, 1), a negative number of failures,
/// or a claim that needs more than 10¹² trials.
std::int64_t trials_for_claim(double success, double confidence, std::int64_t failures);

/// The chance that `trials` trials have no more than `failures` failures, where the proportion `true_success`
/// succeeds: the power of the plan.
double chance_of_claim(std::int64_t trials, std::int64_t failures, double true_success);

/// A plan: run `trials`, and make the claim where at most `failures` fail.
struct ClaimPlan {
  std::int64_t failures{0};
  std::int64_t trials{0};
};

/// The plan with the fewest failures allowed, and so the fewest trials, whose claim is made with a chance of
/// at least `power` where the proportion `true_success` succeeds.
/// @throws Failure (bad_input) where true_success is not beyond success: no number of trials would do.
ClaimPlan plan_with_power(double success, double confidence, double true_success, double power);

/// The fewest trials for which the Clopper–Pearson interval of a rate has no more than this half-width, where
/// the proportion `rate` of them succeeds; rate ½ is the worst case.
/// @throws Failure (bad_input) for a half-width outside (0, ½), or a rate or confidence outside (0, 1).
std::int64_t trials_for_halfwidth(double halfwidth, double confidence, double rate);

}  // namespace zerocount
