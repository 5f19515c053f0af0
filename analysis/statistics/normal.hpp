#pragma once

/// The standard normal distribution.
namespace zerocount::statistics {

/// Quantile at the probability p in (0, 1).
double normal_quantile(double p);

/// P(Z > z).
double normal_upper_tail(double z);

/// z = quantile at (1 + confidence)/2, so that P(|Z| ≤ z) = confidence.
/// @throws Failure (bad_input) for a confidence outside (0, 1).
double two_sided_normal_quantile(double confidence);

}  // namespace zerocount::statistics
