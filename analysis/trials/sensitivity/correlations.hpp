#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/trials/sensitivity/sobol_indices.hpp"

namespace zerocount::sensitivity {

/// The linearly independent columns of a matrix x: those that are not linear combinations of columns further
/// left, and nothing else.
struct IndependentColumns {
  /// Standardised columns: minus their means, over their standard deviations (divisor n).
  Eigen::MatrixXd values;
  std::vector<std::size_t> places;  ///< [column of `values`] Index of the same column in x.
};

/// Selects the linearly independent columns of x. A column is independent if at least 10⁻⁸ of its variance
/// remains after its regression on the columns further left.
/// @param x none of its columns is constant.
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

/// The bounds atanh ρ ± q·s/(1 − ρ²) transformed back to correlations. If ρ is 1 or −1, both bounds are ρ.
/// @param standard_error s, the standard error of ρ.
BoundedNumber fisher_bounds(double correlation, double standard_error, double confidence);

/// Whether all `values` are equal; true if there are none.
bool is_constant(std::span<const double> values);

/// [column] Partial rank correlation of y with the column of x (PRCC; Iman, Shortencarier & Johnson 1985). It
/// is the correlation of the residuals of two linear regressions on the ranks of all other columns: of the
/// ranks of the column, and of the ranks of y. With P the inverse of the correlation matrix of the ranks of
/// all columns and y, it is −P_jy/√(P_jj·P_yy).
///
/// The bounds are fisher_bounds() with s² = Σ ψ_i²/(n(n − k − 2)), ψ = uv − ρ(u² + v²)/2, where u and v are
/// the two residuals, each over its root mean square. They ignore the errors of the ranks.
///
/// NaN for a column whose ranks are a linear combination of those before it, and for all where y is constant
/// or there are fewer than k + 10 rows.
/// @param x n × k, finite, no column constant.
/// @param y n values.
std::vector<BoundedNumber> partial_rank_correlations(const Eigen::MatrixXd& x, std::span<const double> y,
                                                     double confidence);

/// Result of a logistic regression: how the probability of a yes depends on the factors.
struct LogisticFit {
  enum class Status {
    fitted,
    /// A combination of the factors separates yes from no, so the best coefficients are infinite.
    separated,
    /// All trials have the same answer, or fewer than ten trials exceed the number of coefficients.
    too_few
  };
  Status status{Status::too_few};
  BoundedNumber intercept;
  /// [column] Change of the log odds per standard deviation of the column. NaN for a column that is a linear
  /// combination of the columns before it, and for all columns unless the status is fitted.
  std::vector<BoundedNumber> slopes;
};

/// Fits ln(p/(1 − p)) = b₀ + Σ b_j z_j, where z_j are the standardised columns of x, by maximum likelihood
/// with iteratively reweighted least squares (McCullagh & Nelder, Generalized Linear Models, section 4.4).
/// The bounds are Wald's, b ± q·s with s² from the inverse of ZᵀWZ. If yes and no are separated, completely
/// or except for trials on the border, the likelihood has no finite maximum (Albert & Anderson 1984), and the
/// steps do not become smaller.
/// @param x n × k, finite, no column constant.
/// @param yes n values, 0 or 1.
LogisticFit logistic_fit(const Eigen::MatrixXd& x, const Eigen::VectorXd& yes, double confidence);

}  // namespace zerocount::sensitivity
