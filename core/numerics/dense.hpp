#pragma once

#include <Eigen/Core>

/// Decompositions of dense matrices, as functions. Eigen's own headers for them, <Eigen/Dense> and the like,
/// belong in dense.cpp only: each file that instantiates a decomposition takes the compiler many seconds.
///
/// Sizes are rows × columns. A right-hand side b is one column or several.
namespace zerocount::numerics {

/// Eigenvalues of a square matrix, in no particular order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a);

/// Matrix exponential exp(A) = Σ Aᵏ/k! of a square matrix.
Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& a);

/// Cholesky factor L of a symmetric matrix A = L·Lᵀ, lower triangular; NaN throughout if A is not positive
/// definite.
Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& a);

/// Solution A⁻¹·b of the linear equations A·x = b with a positive definite A, by A = L·Lᵀ.
Eigen::MatrixXd solve_positive_definite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Inverse A⁻¹ of a positive definite matrix A.
Eigen::MatrixXd inverse_of_positive_definite(const Eigen::MatrixXd& a);

/// Solution L⁻ᵀ·b of Lᵀ·x = b, with L a lower triangular factor from cholesky_factor().
Eigen::VectorXd solve_transposed_factor(const Eigen::MatrixXd& factor, const Eigen::VectorXd& b);

/// Least-squares solution: the x of minimal |x| among all x of minimal |A·x − b|, for A of any shape and
/// rank.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The Moore–Penrose inverse of a matrix of any shape and rank.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a);

/// Matrix product A·B.
Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Matrix product Aᵀ·B of the transpose of A and B.
Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace zerocount::numerics
