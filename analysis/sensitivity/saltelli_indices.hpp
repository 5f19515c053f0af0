#pragma once

#include <cstdint>
#include <vector>

#include "analysis/sensitivity/bounded_number.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount {

/// The output of the trials of a saltelli design with k factors and N rows, finite (see
/// experiments/designs/saltelli.hpp).
struct SaltelliSample {
  std::vector<double> a;               ///< [row] of A
  std::vector<double> b;               ///< [row] of B
  std::vector<std::vector<double>> c;  ///< [factor][row] of A with this factor from B
};

/// Sobol' indices of one factor, dimensionless.
struct SobolIndices {
  BoundedNumber first_order;
  BoundedNumber total;
};

/// How often rows are drawn again for bounds of this confidence: so often that 25 lie beyond each bound, and
/// 1000 times at least.
std::int64_t bootstrap_replicates(double confidence);

/// First-order and total Sobol' indices, [factor]. With m and V the mean and the variance (divisor 2N) of the
/// 2N numbers in the two columns named,
///
///   T_j = 1/(2N) Σ (a_r − c_jr)² / V(a, c_j)
///   S_j = [1/N Σ b_r·c_jr − m(b, c_j)² − λ_j·(1/N Σ a_r·b_r − 1/N² Σ a_r Σ b_r)] / V(b, c_j).
///
/// T_j is Jansen's (1999; Saltelli et al. 2010, table 2 (f)) with the variance of Janon, Klein, Lagnoux,
/// Nodet & Prieur (2014), by which 1 − T_j is a correlation. S_j is theirs, less a control variate whose
/// expectation is 0 because A and B are independent: with λ_j = 0 it is best where the factor is nearly all,
/// with λ_j = 1 that of Saltelli et al. (2010, table 2 (b)), best where it is nearly nothing. λ_j is the
/// regression coefficient of b·c_j − S_j(b² + c_j²)/2 on a·b, all less their means (Glynn & Szechtman 2002),
/// of the sample given. S_j is 0 where c_j is a.
///
/// The bounds are percentiles of these numbers over samples of N rows that are drawn anew from the rows, with
/// replacement (Archer, Saltelli & Sobol' 1997). Of more than 4096 rows, 4096 groups of neighbouring ones are
/// drawn. NaN where A and B have no variance or there are fewer than two rows.
/// @param randomness the rows are drawn from: the same gives the same bounds.
std::vector<SobolIndices> saltelli_indices(const SaltelliSample& sample, double confidence,
                                           const RandomStream& randomness);

}  // namespace zerocount
