#pragma once

#include <cstdint>

#include "analysis/statistics/proportion.hpp"

/// Tests of a proportion of trials that fail something, in a baseline and in what is compared with it.
/// Effects and alternatives are for the worse: more failures than in the baseline.
namespace zerocount::two_samples {

/// Failures of both, trial by trial.
struct PairedFailures {
  std::int64_t pairs{0};
  std::int64_t only_current{0};   ///< pairs that failed in the current file alone
  std::int64_t only_baseline{0};  ///< pairs that failed in the baseline alone
};

/// Failures of two independent samples.
struct FailureCounts {
  std::int64_t baseline_failures{0};
  std::int64_t baseline_trials{0};
  std::int64_t current_failures{0};
  std::int64_t current_trials{0};
};

/// Exact one-sided McNemar test: of the b + c pairs that differ, the probability that b or more go to the
/// worse where either way is as likely, P(X ≥ b), X binomial(b + c, ½). 1 where no pair differs. Source:
/// McNemar, Psychometrika 12 (1947), 153; exact form as in Fay, R Journal 2 (2010), 53.
double mcnemar(const PairedFailures& failures);

/// Bounds of the difference of the two proportions, λ = (b − c)/n, each by itself with `confidence`: where
/// the score statistic
///
///   Z(λ) = (b − c − nλ)/√(n(2q + λ(1 − λ))),
///
/// q the likeliest proportion of the pairs that only the baseline failed, given λ, is ∓ the normal quantile.
/// Source: Tango, Statistics in Medicine 17 (1998), 891, equations (6), (10).
statistics::ConfidenceInterval tango(const PairedFailures& failures, double confidence);

/// Fisher's exact one-sided test: given the sum of failures, the probability of as many or more in the
/// current sample where both have the same proportion (hypergeometric). Source: Fisher, Journal of the Royal
/// Statistical Society 98 (1935), 39.
double fisher(const FailureCounts& failures);

/// Bounds of the difference of the two proportions, each by itself with `confidence`, from the Wilson bounds
/// (l, u) of both: with d = p₂ − p₁,
///
///   low = d − √((p₂ − l₂)² + (u₁ − p₁)²), high = d + √((u₂ − p₂)² + (p₁ − l₁)²).
///
/// Source: Newcombe, Statistics in Medicine 17 (1998), 873, method 10.
statistics::ConfidenceInterval newcombe(const FailureCounts& failures, double confidence);

}  // namespace zerocount::two_samples
