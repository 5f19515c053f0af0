#pragma once

#include <cstdint>

/// Distributions of Boost.Math, whose templates take seconds to compile, as plain functions. All are
/// dimensionless. They throw std::domain_error for arguments outside their domains.
namespace zerocount::statistics {

/// Quantile t with P(T ≤ t) = p, 0 < p < 1, of Student's T distribution and, in the next function, its upper
/// tail P(T > t). The degrees of freedom need not be whole.
double student_t_quantile(double degrees_of_freedom, double p);
double student_t_upper_tail(double degrees_of_freedom, double t);

/// Quantile x with P(X ≤ x) = p, 0 < p < 1, of the χ² distribution.
double chi_squared_quantile(double degrees_of_freedom, double p);

/// Probabilities of the binomial distribution: P(B ≤ k) and, in the next function, P(B > k), 0 ≤ k ≤ trials,
/// for the number B of successes, each of the probability `success`.
double binomial_cdf(std::int64_t trials, double success, std::int64_t k);
double binomial_upper_tail(std::int64_t trials, double success, std::int64_t k);

/// Probability P(X ≥ k), k > 0, of the hypergeometric distribution: X is the number of failures in a sample
/// of `drawn` trials from `total` trials with `failures` failures.
double hypergeometric_at_least(std::int64_t failures, std::int64_t drawn, std::int64_t total, std::int64_t k);

/// Quantile z with P(Z ≤ z) = p, p in (0, 1), of the standard normal distribution.
double normal_quantile(double p);

/// Upper tail probability P(Z > z) of the standard normal distribution.
double normal_upper_tail(double z);

/// Normal quantile at (1 + confidence)/2: the z with P(|Z| ≤ z) = confidence.
/// @throws Failure (bad_input) for a confidence outside (0, 1).
double two_sided_normal_quantile(double confidence);

}  // namespace zerocount::statistics
