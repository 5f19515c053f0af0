#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/sensitivity/bounded_number.hpp"

namespace zerocount::sensitivity {

/// Partial rank correlations of y with each column of x, [column] (PRCC; Iman, Shortencarier & Johnson 1985):
/// the correlation of what is left of the ranks of the column and of y when the part linear in the ranks of
/// all other columns is taken from both. With P the inverse of the correlations of the ranks of all columns
/// and y, −P_jy/√(P_jj·P_yy).
///
/// The bounds are fisher_bounds() with s² = Σ ψ_i²/(n(n − k − 2)), ψ = uv − ρ(u² + v²)/2, u and v the two
/// remainders, each over its root mean square; this takes the ranks as they are.
///
/// NaN for a column whose ranks are a linear combination of those before it, and for all where y is constant
/// or there are fewer than k + 10 rows.
/// @param x n × k, finite, no column constant. @param y n values.
std::vector<BoundedNumber> partial_rank_correlations(const Eigen::MatrixXd& x, std::span<const double> y,
                                                     double confidence);

}  // namespace zerocount::sensitivity
