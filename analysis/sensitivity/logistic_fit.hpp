#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/sensitivity/bounded_number.hpp"

namespace zerocount::sensitivity {

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
