#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/sensitivity/sobol_indices.hpp"

namespace zerocount::sensitivity {

/// Columns that are not linear combinations of those before them.
struct IndependentColumns {
  Eigen::MatrixXd values;           ///< less their means, over their standard deviations (divisor n)
  std::vector<std::size_t> places;  ///< [column] where it stands in x
};

/// Those of x. The residual of a regression on the columns before must have at least 10⁻⁸ of the column's
/// variance. @param x none of its columns is constant.
IndependentColumns independent_columns(const Eigen::MatrixXd& x);

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

/// A logistic regression of a yes or no on factors.
struct LogisticFit {
  enum class Status {
    fitted,
    separated,  ///< a combination of the factors parts yes from no: the best coefficients are infinite
    too_few     ///< all trials say the same, or there are fewer than ten beyond the coefficients
  };
  Status status{Status::too_few};
  BoundedNumber intercept;
  /// [column] change of the log odds over one standard deviation of the column. NaN of a column that is a
  /// linear combination of those before it, and unless the status is fitted.
  std::vector<BoundedNumber> slopes;
};

/// ln(p/(1 − p)) = b₀ + Σ b_j z_j, z_j the columns of x standardised: the maximum of the likelihood, by
/// iteratively reweighted least squares (McCullagh & Nelder, Generalized Linear Models, section 4.4). The
/// bounds are Wald's, b ± q·s with s² from the inverse of ZᵀWZ. Where yes and no are separated, completely or
/// but for trials on the border, there is no maximum at a finite place (Albert & Anderson 1984): the steps
/// then do not become smaller.
/// @param x n × k, finite, no column constant. @param yes n values, 0 or 1.
LogisticFit logistic_fit(const Eigen::MatrixXd& x, const Eigen::VectorXd& yes, double confidence);

}  // namespace zerocount::sensitivity
