#pragma once

#include <cstdint>

namespace zerocount {

/// A closed interval.
struct ConfidenceInterval {
  double low{0.0};
  double high{0.0};
};

/// The confidence of the bounds that a summary states where no other is asked for, and of all that a results
/// file holds.
inline constexpr double summary_confidence = 0.95;

/// @throws Failure (bad_input) unless 0 < confidence < 1.
void require_confidence(double confidence);

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

/// The largest p of which a proportion is at least, with the stated confidence: the one-sided Clopper–Pearson
/// bound, the p for which `successes` or more of `trials` have the probability 1 − confidence. 0 where
/// successes = 0.
///
/// With it stands a tolerance statement after Wilks (1941), "at least the share p of all succeed": without a
/// failure p = (1 − confidence)^(1/n), so that the failures are at most 1 − p ≈ −ln(1 − confidence)/n, 3/n at
/// 95 % (the rule of three; Hanley and Lippman-Hand 1983).
double proportion_at_least(std::int64_t successes, std::int64_t trials, double confidence);

/// The smallest p of which a proportion is at most, with the stated confidence: 1 less proportion_at_least of
/// the others, without the rounding of that where it is small.
double proportion_at_most(std::int64_t successes, std::int64_t trials, double confidence);

/// Wilson score interval of a proportion: with z the normal quantile of (1 + confidence)/2 and p = k/n,
///
///   (p + z²/2n ± z·√(p(1 − p)/n + z²/4n²)) / (1 + z²/n).
///
/// Shorter than Clopper–Pearson, and covers with the stated probability on average only. The same edge cases:
/// exactly 0, 1 and [0, 1]. Source: Wilson (1927).
ConfidenceInterval wilson(std::int64_t successes, std::int64_t trials,
                          double confidence = summary_confidence);

}  // namespace zerocount
