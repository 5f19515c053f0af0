#pragma once

#include <vector>

#include <Eigen/Core>

namespace zerocount::sensitivity {

/// The columns of x less their means, over their standard deviations (divisor n).
/// @param x none of its columns is constant.
Eigen::MatrixXd standardised(const Eigen::MatrixXd& x);

/// Which columns add something to those before them, [column]: those whose part that is not a linear
/// combination of the earlier ones has at least 10⁻⁸ of their variance.
/// @param x standardised.
std::vector<bool> independent_columns(const Eigen::MatrixXd& x);

/// The columns of x that are marked.
Eigen::MatrixXd marked_columns(const Eigen::MatrixXd& x, const std::vector<bool>& marks);

}  // namespace zerocount::sensitivity
