#pragma once

#include <span>

/// Rank tests of numbers, against the alternative that the current ones are larger.
namespace zerocount::two_samples {

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
