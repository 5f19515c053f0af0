#pragma once

#include <span>
#include <vector>

#include "analysis/sensitivity/bounded_number.hpp"

namespace zerocount::sensitivity {

/// The empirical mid-distribution function at each value: (number below + ½ number equal, itself included)/n,
/// which is (rank − ½)/n with the mean rank of values that are equal. The mean is exactly ½. The values are
/// finite.
std::vector<double> mid_distribution(std::span<const double> values);

/// Spearman's rank correlation: Pearson's correlation of F and G, the mid-distributions of x and y.
///
/// The bounds are those of atanh ρ ± q·s/(1 − ρ²) with q the normal quantile of (1 + confidence)/2 and s² =
/// Σ ψ_i²/(n(n − 3)), ψ the influence function of ρ, which holds for values that are equal, too: of C =
/// E[F(x)G(y)] − ¼ it is F(x)G(y) + E[m(x, X)G(Y)] + E[F(X)m(y, Y)] − 3(C + ¼) with m(u, v) = 1 where u < v,
/// ½ where u = v, otherwise 0; likewise of the variances of F and G (Hoeffding 1948, "A class of statistics
/// with asymptotically normal distribution", sections 7 and 9).
///
/// NaN where x or y is constant, or there are fewer than ten values. x and y have the same length.
BoundedNumber rank_correlation(std::span<const double> x, std::span<const double> y, double confidence);

/// The bounds of atanh ρ ± q·s/(1 − ρ²), back as correlations; ρ itself where it is 1 or −1.
/// @param standard_error s, of ρ.
BoundedNumber fisher_bounds(double correlation, double standard_error, double confidence);

/// Whether all `values` are equal; true of none.
bool is_constant(std::span<const double> values);

}  // namespace zerocount::sensitivity
