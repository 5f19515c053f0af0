#pragma once

#include <cstdint>

#include "analysis/statistics/proportion.hpp"

namespace zerocount::statistics {

/// Confidence sequence of a proportion. With at least the stated probability the true proportion lies within
/// the bounds for *all* n at once. The bounds may therefore be evaluated after every trial, and sampling may
/// stop when they are narrow enough. (Clopper–Pearson and Wilson bounds hold only for an n fixed in advance.)
///
/// With s successes of n, the interval contains each p that the mixture martingale with the prior Beta(½, ½)
/// does not reject:
///
///   B(s + ½, n − s + ½) / B(½, ½) / (pˢ·(1 − p)ⁿ⁻ˢ) ≤ 1/(1 − confidence),
///
/// By Ville's inequality the probability that this fails for the true p at any n is at most 1 − confidence.
/// Sources: Robbins, Statistical methods related to the law of the iterated logarithm (1970); Howard, Ramdas,
/// McAuliffe and Sekhon, Time-uniform, nonparametric, nonasymptotic confidence sequences (2021), section 3.
///
/// low is 0 if successes = 0, high is 1 if successes = trials, and the interval is [0, 1] if trials = 0.
ConfidenceInterval confidence_sequence_bounds(std::int64_t successes, std::int64_t trials, double confidence);

/// Expected number of trials at which the confidence sequence has the half-width `halfwidth`, if the
/// proportion of successes stays the same. A multiple of `block`, at most `max_trials`.
std::int64_t projected_trials(std::int64_t successes, std::int64_t trials, double halfwidth,
                              double confidence, std::int64_t block, std::int64_t max_trials);

}  // namespace zerocount::statistics
