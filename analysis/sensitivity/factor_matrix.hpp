#pragma once

#include <vector>

#include <Eigen/Core>

namespace zerocount::sensitivity {

/// The columns of x less their means, over their standard deviations (divisor n).
/// @param x none of its columns is constant.
Eigen::MatrixXd standardised(const Eigen::MatrixXd& x);

/// Marks the columns that are not linear combinations of earlier columns, [column]. The residual of a
/// regression on the earlier columns must have at least 10⁻⁸ of the column's variance.
/// @param x standardised.
std::vector<bool> independent_columns(const Eigen::MatrixXd& x);

/// The columns of x that are marked.
Eigen::MatrixXd marked_columns(const Eigen::MatrixXd& x, const std::vector<bool>& marks);

}  // namespace zerocount::sensitivity
