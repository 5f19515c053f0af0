#pragma once

#include <cstdint>

/// Distributions of Boost.Math, whose templates take seconds to compile, as plain functions. All are
/// dimensionless. They throw std::domain_error for arguments outside their domains.
namespace zerocount::statistics {

/// The t with P(T ≤ t) = p, 0 < p < 1, and P(T > t), for Student's T. The degrees of freedom need not be
/// whole.
double student_t_quantile(double degrees_of_freedom, double p);
double student_t_upper_tail(double degrees_of_freedom, double t);

/// The x with P(X ≤ x) = p, 0 < p < 1, for X distributed as χ².
double chi_squared_quantile(double degrees_of_freedom, double p);

/// P(B ≤ k) and P(B > k), 0 ≤ k ≤ trials, for the number B of successes, each of the probability `success`.
double binomial_cdf(std::int64_t trials, double success, std::int64_t k);
double binomial_upper_tail(std::int64_t trials, double success, std::int64_t k);

/// P(X ≥ k), k > 0, for the number X of failures in a sample of `drawn` from `total` trials with `failures`.
double hypergeometric_at_least(std::int64_t failures, std::int64_t drawn, std::int64_t total, std::int64_t k);

/// Quantile at the probability p in (0, 1).
double normal_quantile(double p);

/// P(Z > z).
double normal_upper_tail(double z);

/// z = quantile at (1 + confidence)/2, so that P(|Z| ≤ z) = confidence.
/// @throws Failure (bad_input) for a confidence outside (0, 1).
double two_sided_normal_quantile(double confidence);

}  // namespace zerocount::statistics
