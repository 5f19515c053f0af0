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

/// Numbers of trials that give bounds of a success rate the same half-width and confidence, for two ways to
/// fix the number: beforehand, or by looking at the outcomes.
struct SequentialCost {
  double rate{0.0};       ///< Assumed proportion of trials that succeed.
  std::int64_t fixed{0};  ///< Number of trials if it is decided beforehand, see trials_for_halfwidth().
  /// Expected number of trials if sampling stops by the outcomes (confidence sequence), see
  /// projected_trials().
  std::int64_t sequential{0};

  double ratio() const { return static_cast<double>(sequential) / static_cast<double>(fixed); }
};

/// Computes the numbers of trials for both ways to fix them.
/// @param block number of trials between two looks at the outcomes
/// @throws Failure as trials_for_halfwidth.
SequentialCost sequential_cost(double halfwidth, double confidence, double rate, std::int64_t block = 1);

/// A study of `machines` machines with `trials_per_machine` trials each.
struct MachinePlan {
  std::int64_t machines{0};
  std::int64_t trials_per_machine{0};
};

/// The minimum number of machines, with `trials_per_machine` trials each, for which the Korn–Graubard bounds
/// of a success rate have at most this half-width. With p the rate and s the expected standard deviation of
/// the success probability between machines, one of m trials on each of R machines is equivalent to
///
///   1/deff = 1/(1 + (m − 1)·ρ),   ρ = s²/(p(1 − p)),
///
/// independent trials (Kish). R machines are therefore equivalent to at most R/ρ independent trials, whatever
/// m is.
/// @throws Failure (bad_input) for a half-width or rate outside (0, ½) and (0, 1), a standard deviation that
/// no distribution with this mean has (s² > p(1 − p)), or a plan of more than 10⁹ machines.
std::int64_t machines_for_halfwidth(double halfwidth, double confidence, double rate, double machine_sd,
                                    std::int64_t trials_per_machine);

/// The plan that shows, if no trial fails, that at least the proportion `content` of all machines hold zero
/// in at least the proportion `success` of moves (machine_tolerance()). For trials of one move.
///
/// @param machines 0: 1.5 times the minimum number, which needs far fewer trials on each machine than the
/// minimum
/// @throws Failure (bad_input) for a number outside (0, 1), or fewer machines than the minimum.
MachinePlan plan_tolerance(double content, double success, double confidence, std::int64_t machines = 0);

}  // namespace zerocount::statistics
