#pragma once

#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/sums/moments.hpp"

namespace zerocount::statistics {

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
