#pragma once

#include <cstdint>
#include <span>

#include "analysis/statistics/proportion.hpp"

namespace zerocount::statistics {

/// Bounds of the mean μ of independent non-negative numbers X of one distribution that is not known. They
/// hold with the stated probability for *all* n at once, so that sampling may stop when they are narrow
/// enough.
///
/// A player who bets on X > m multiplies his capital by 1 + λ(X − m), 0 ≤ λ < 1/m. If μ ≤ m, the expected
/// factor is at most 1, and by Ville's inequality the capital exceeds 2/(1 − confidence) with at most half
/// the error probability. `low` is the smallest m at which it has not. The capital is divided among fixed λ·m
/// from 0.001 to 0.9. For `high` the player bets on X < m, and the factor is 1 − λ(X − m) with λ < 1/cap.
/// Source: Waudby-Smith and Ramdas, Estimating means of bounded random variables by betting, J. R. Stat. Soc.
/// B 86 (2024), section 4.
///
/// `low` holds whatever the distribution. `high` is a bound of the mean of min(X, cap), and of μ where no X
/// exceeds `cap`.
/// @param positive the values above 0 @param n of all values, n ≥ positive.size()
/// @param cap above 0 @param confidence of both bounds together
ConfidenceInterval betting_bounds(std::span<const double> positive, std::int64_t n, double cap,
                                  double confidence);

}  // namespace zerocount::statistics
