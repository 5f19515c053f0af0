#pragma once

/// Functions of the normal distribution whose results have the same bits on every processor.
namespace zerocount::numerics {

/// Quantile of the normal distribution at the probability p in (0, 1).
/// @throws std::exception (of Boost.Math) for another p, and for arguments that are not finite.
double normal_quantile(double p, double mean = 0.0, double standard_deviation = 1.0);

/// Cumulative probability P(Z ≤ z) of a standard normal random number Z.
double normal_probability(double z);

}  // namespace zerocount::numerics
