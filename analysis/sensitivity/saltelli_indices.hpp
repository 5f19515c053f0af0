#pragma once

#include <cstdint>
#include <vector>

#include "analysis/sensitivity/bounded_number.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::sensitivity {

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
/// of the sample given. S_j is 0 where c_j is a. Values and bounds are held in [0, 1] (clamped_index).
///
/// For an output that is 0 or 1 throughout, the bounds of T_j are those of yes_no_difference. Those of S_j
/// are the wider of the percentiles and 1 less yes_no_difference of B and C_j. For any other output they are
/// percentiles of these numbers over samples of N rows that are drawn anew from the rows, with replacement
/// (Archer, Saltelli & Sobol' 1997), with unseen_index; of more than 4096 rows, 4096 groups of neighbouring
/// ones are drawn. The upper bound of S_j is not above that of T_j, and the lower one of T_j is 0 only where
/// no row differs. NaN where A and B have no variance or there are fewer than two rows, and for a factor
/// where A and C_j have none.
/// An output that is not a yes or no has no bounds where its variance comes from fewer than ten trials of A
/// and B: (Σ (y − m)²)²/Σ (y − m)⁴ < 20.
/// @param randomness the rows are drawn from: the same gives the same bounds.
std::vector<SobolIndices> saltelli_indices(const SaltelliSample& sample, double confidence,
                                           const random::RandomStream& randomness);

}  // namespace zerocount::sensitivity
