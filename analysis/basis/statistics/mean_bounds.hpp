#pragma once

#include <cstdint>
#include <span>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/sums/moments.hpp"

namespace zerocount::statistics {

/// Bounds of the mean μ of independent non-negative numbers X of one distribution that is not known. They
/// hold with the stated probability for *all* n at once, so that sampling may stop when they are narrow
/// enough.
///
/// A player who bets on X > m multiplies his capital by 1 + λ(X − m), 0 ≤ λ < 1/m. If μ ≤ m, the expected
/// factor is at most 1, and by Ville's inequality the capital exceeds 2/(1 − confidence) with at most half
/// the error probability. `low` is the smallest m at which it has not. The capital is divided among fixed λ·m
/// from 0.001 to 0.9. For `high` the player bets on X < m, and the factor is 1 − λ(X − m) with λ < 1/cap.
/// Source: Waudby-Smith and Ramdas, Estimating means of bounded random variables by betting, J. R. Stat. Soc.
/// B 86 (2024), section 4.
///
/// `low` holds whatever the distribution. `high` is a bound of the mean of min(X, cap), and of μ where no X
/// exceeds `cap`.
/// @param positive the values above 0
/// @param n number of all values, including zeros, n ≥ positive.size()
/// @param cap upper limit of the values for `high`, above 0
/// @param confidence confidence of both bounds together
ConfidenceInterval betting_bounds(std::span<const double> positive, std::int64_t n, double cap,
                                  double confidence);

/// Confidence sequence of a proportion. With at least the stated probability the true proportion lies within
/// the bounds for *all* n at once. The bounds may therefore be evaluated after every trial, and sampling may
/// stop when they are narrow enough. (Clopper–Pearson and Wilson bounds hold only for an n fixed in advance.)
///
/// With s successes of n, the interval contains each p that the mixture martingale with the prior Beta(½, ½)
/// does not reject:
///
///   B(s + ½, n − s + ½) / B(½, ½) / (pˢ·(1 − p)ⁿ⁻ˢ) ≤ 1/(1 − confidence),
///
/// The probability that this fails for the true p at any n is at most 1 − confidence (Ville's inequality).
/// Sources: Robbins, Statistical methods related to the law of the iterated logarithm (1970); Howard, Ramdas,
/// McAuliffe and Sekhon, Time-uniform, nonparametric, nonasymptotic confidence sequences (2021), section 3.
///
/// low is 0 if successes = 0, high is 1 if successes = trials, and the interval is [0, 1] if trials = 0.
ConfidenceInterval confidence_sequence_bounds(std::int64_t successes, std::int64_t trials, double confidence);

/// Expected number of trials at which the confidence sequence has the half-width `halfwidth`, if the
/// proportion of successes stays the same. A multiple of `block`, at most `max_trials`.
std::int64_t projected_trials(std::int64_t successes, std::int64_t trials, double halfwidth,
                              double confidence, std::int64_t block, std::int64_t max_trials);

/// Student's t interval of a mean: with t the quantile of (1 + confidence)/2 for n − 1 degrees of freedom,
///
///   mean ± t·sd/√n,   in the values' unit.
///
/// Exact for normally distributed values; for other distributions the coverage approaches the stated
/// probability with growing n. NaN for fewer than two finite values.
/// @throws Failure (bad_input) for a confidence outside (0, 1).
ConfidenceInterval student_t(const Moments& sample, double confidence = summary_confidence);

/// Bounds of the mean of a Poisson distribution after `events` events were counted: the means that neither
/// one-sided test at tail = (1 − confidence)/2 rejects. With γ(a; p) the p-quantile of the gamma distribution
/// of shape a and scale 1,
///
///   low = γ(events; tail), 0 if events is 0,   high = γ(events + 1; 1 − tail).
///
/// The coverage is at least the stated probability. `events` may be fractional: a count scaled for
/// overdispersion. Source: Garwood, Biometrika 28 (1936) 437.
/// @throws Failure (bad_input) for a confidence outside (0, 1) or a negative number.
ConfidenceInterval poisson_bounds(double events, double confidence = summary_confidence);

}  // namespace zerocount::statistics
