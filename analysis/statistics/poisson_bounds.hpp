#pragma once

#include "analysis/statistics/proportion.hpp"

namespace zerocount::statistics {

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
