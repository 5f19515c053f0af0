#pragma once

#include <cstdint>
#include <span>

#include "analysis/basis/statistics/proportion.hpp"

/// Exact tests of a baseline against a current sample: of the proportions of failed trials, and of ranks.
/// Effects and alternatives are for the worse: more failures, or larger values, than in the baseline.
namespace zerocount::two_samples {

/// Numbers of failures in pairs of trials (one trial of the baseline, one of the current file with the same
/// random numbers).
struct PairedFailures {
  std::int64_t pairs{0};
  std::int64_t only_current{0};   ///< Number of pairs that failed only in the current file.
  std::int64_t only_baseline{0};  ///< Number of pairs that failed only in the baseline.
};

/// Numbers of failures and trials in two independent samples, baseline and current file.
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

/// Bounds of the difference of two paired proportions, λ = (b − c)/n, each by itself with `confidence`, where
/// b pairs failed only in the current file and c only in the baseline, of n pairs: where the score statistic
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

/// Bounds of the difference of two independent proportions, each by itself with `confidence`, from the Wilson
/// bounds (l, u) of both: with d = p₂ − p₁,
///
///   low = d − √((p₂ − l₂)² + (u₁ − p₁)²), high = d + √((u₂ − p₂)² + (p₁ − l₁)²).
///
/// Source: Newcombe, Statistics in Medicine 17 (1998), 873, method 10.
statistics::ConfidenceInterval newcombe(const FailureCounts& failures, double confidence);

/// Wilcoxon's signed-rank test: the probability of a sum of the ranks of the positive differences as large or
/// larger, where each difference is as likely to have the other sign. Differences of 0 are left out; those of
/// equal size share their mean rank. 1 where none is left.
///
/// Exact with up to 200 differences that are not 0, ties or not (the distribution over all signs, by adding
/// one rank after the other); beyond that by the normal distribution, with the variance ¼Σ rank² and half a
/// rank of continuity. Sources: Wilcoxon, Biometrics Bulletin 1 (1945), 80; Streitberg and Röhmel, EDV in
/// Medizin und Biologie 18 (1987), 12.
double signed_rank(std::span<const double> differences);

/// One-sided two-sample Smirnov test: with D = max over x of F₁(x) − F₂(x), of the empirical distributions of
/// the baseline (1) and the current sample (2), the probability of a D as large or larger where all
/// arrangements of the pooled values are equally likely.
///
/// Exact, and so for samples with ties too, while the sizes' product is at most 4·10⁶: the arrangements are
/// paths over a lattice, which are checked only where a group of equal values ends. Beyond that Smirnov's
/// limit exp(−2D²·n₁n₂/(n₁ + n₂)), which is too large rather than too small. 1 where a sample is empty.
/// Sources: Smirnov (1939); Hodges, Arkiv för Matematik 3 (1958), 469; for ties Schröer and Trenkler,
/// Computational Statistics & Data Analysis 20 (1995), 185.
double smirnov(std::span<const double> baseline, std::span<const double> current);

}  // namespace zerocount::two_samples
