#pragma once

#include <span>

#include "analysis/sensitivity/bounded_number.hpp"

namespace zerocount::sensitivity {

/// First-order Sobol' index of a factor from any sample of independent trials, the proportion of the variance
/// of y that the mean of y given x has. The trials are put into M classes by x: each distinct value of x is
/// one, or, where there are more than M₀ = min(32, ⌊√n⌋) of them, each of M₀ parts of as many trials (values
/// that are equal stay together). With W the sum of the squares about the classes' means and T about the
/// mean,
///
///   S = 1 − (n − 1)/(n − M)·W/T,
///
/// the correlation ratio (Pearson 1905) less its expectation where x has no influence (Kelley 1935); without
/// that correction see Plischke, Borgonovo & Smith 2013. What y varies with x within a class is not seen.
///
/// The bounds are S ± q·s, q the normal quantile of (1 + confidence)/2 and
///
///   n²s² = max(n/(n − M)·Σ ψ_i² − 2(M − 1)(1 − S)², 2(M − 1)(1 − S)²),
///   ψ = [2(m − μ)(y − m) + (m − μ)² − S·(y − μ)²]/V,
///
/// m the mean of the class, μ and V mean and variance of all. ψ is the influence function; the errors of the
/// classes' means, squared standard normals, add 4(M − 1)(1 − S)² to the sum of its squares, and 2(M − 1)(1 −
/// S)² to the true variance of n·S, which at S = 0 is all. The lower bound is replaced by S − (1 − S)(χ² − (M
/// − 1))/n, χ² the quantile of (1 + confidence)/2 with M − 1 degrees of freedom, where that is lower.
///
/// NaN where x or y is constant, or there are fewer than 20 trials or 2M. x and y have the same length.
BoundedNumber given_data_first_order(std::span<const double> x, std::span<const double> y, double confidence);

}  // namespace zerocount::sensitivity
