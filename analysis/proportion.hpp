#pragma once

#include <cstdint>

namespace zerocount {

/// A closed interval.
struct ConfidenceInterval {
  double low{0.0};
  double high{0.0};
};

/// The confidence of every bound that a summary states.
inline constexpr double summary_confidence = 0.95;

/// k successes of n: k/n, NaN where n is 0.
double rate(std::int64_t successes, std::int64_t trials);

/// Clopper–Pearson interval of a proportion: the p that neither one-sided binomial test at (1 − confidence)/2
/// rejects.
///
/// Covers the true proportion with at least the stated probability, whatever it is. low is 0 where successes
/// = 0, high is 1 where successes = trials, and the interval is [0, 1] where trials = 0. Source: Clopper and
/// Pearson (1934).
ConfidenceInterval clopper_pearson(std::int64_t successes, std::int64_t trials,
                                   double confidence = summary_confidence);

/// Wilson score interval of a proportion: with z the normal quantile of (1 + confidence)/2 and p = k/n,
///
///   (p + z²/2n ± z·√(p(1 − p)/n + z²/4n²)) / (1 + z²/n).
///
/// Shorter than Clopper–Pearson, and covers with the stated probability on average only. The same edge cases:
/// exactly 0, 1 and [0, 1]. Source: Wilson (1927).
ConfidenceInterval wilson(std::int64_t successes, std::int64_t trials,
                          double confidence = summary_confidence);

}  // namespace zerocount
