#pragma once

#include <cstdint>

#include "analysis/statistics/proportion.hpp"

namespace zerocount {

/// Bounds of a proportion that hold at all sample sizes at once: with at least the stated probability, the
/// true proportion lies within the bounds of *every* n, so one may look as often as one likes and stop when
/// the bounds are narrow enough. (The bounds of Clopper and Pearson or Wilson hold for an n fixed
/// beforehand.)
///
/// With s successes of n, the bounds are the p that the mixture martingale with the prior Beta(½, ½) does not
/// reject:
///
///   B(s + ½, n − s + ½) / B(½, ½) / (pˢ·(1 − p)ⁿ⁻ˢ) ≤ 1/(1 − confidence),
///
/// which by Ville's inequality fails with probability 1 − confidence at most, for any n whatever. Sources:
/// Robbins, Statistical methods related to the law of the iterated logarithm (1970); Howard, Ramdas,
/// McAuliffe and Sekhon, Time-uniform, nonparametric, nonasymptotic confidence sequences (2021), section 3.
///
/// low is 0 where successes = 0, high is 1 where successes = trials, and the interval is [0, 1] where
/// trials = 0.
ConfidenceInterval confidence_sequence_bounds(std::int64_t successes, std::int64_t trials, double confidence);

/// How many trials, a multiple of `block` and at most `most`, the anytime bounds will need to be as narrow as
/// ± `halfwidth` if `successes` of `trials` go on in the same proportion.
std::int64_t projected_trials(std::int64_t successes, std::int64_t trials, double halfwidth,
                              double confidence, std::int64_t block, std::int64_t most);

}  // namespace zerocount
