#pragma once

#include <span>

#include "analysis/sensitivity/bounded_number.hpp"

namespace zerocount::sensitivity {

/// First-order Sobol' index of a factor from any sample of independent trials, the proportion of the variance
/// of y that the mean of y given x has:
///
///   S = 1 − E/V,   V the variance of y,   E the mean over all trials of the variance of y about m(x).
///
/// m is a straight line within each of K = ⌊n^(2/3)/2⌋ classes of neighbours in x with as many trials each
/// (values that are equal stay together); of at most K distinct values each is a class with its mean. The
/// variance of a class about m has the divisor trials − coefficients, so that what m follows by chance does
/// not count; a class without more trials than coefficients takes the mean of the others. For classes with
/// means only this is the correlation ratio (Pearson 1905) less its expectation (Kelley 1935), which counts
/// the slope within a class as noise, most in the tail of a skewed factor. With n^(2/3)/2 classes a step or a
/// kink of m is lost in less than the bounds.
///
/// The bounds are those of ln(E/V) ± t·s. With r² the square of a trial about m, by its class's divisor,
///
///   n²s² = Σ ψ² + 2(p − 1),   ψ = r²/E − (y − μ)²/V less its mean,
///
/// ψ the influence function and 2(p − 1) the variance that fitting p coefficients adds, by which S varies
/// where x has no influence. t is Student's quantile of (1 + confidence)/2 with e/2 − 1 degrees of freedom,
/// ½ at least, e = (Σψ²)²/Σψ⁴ being how many trials carry s: of skewed values the largest few, which tell
/// little of those not seen, so that the bounds may leave all open. The lower bound is at most that of
/// ln(E/V) + (χ² − (p − 1))/n, χ² the quantile with p − 1 degrees of freedom. Where it is not above 0, s is
/// too small because S is: the upper bound is then at least the larger h with, z the normal quantile,
///
///   (h − S)² = z²·[4h(1 − h)/n + 2(p − 1)/n²].
///
/// Value and bounds are held in [0, 1] (clamped_index). NaN where x or y is constant, or there are fewer than
/// 20 trials. x and y have the same length.
BoundedNumber given_data_first_order(std::span<const double> x, std::span<const double> y, double confidence);

}  // namespace zerocount::sensitivity
