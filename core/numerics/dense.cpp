#include "core/numerics/dense.hpp"

#include <limits>

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

namespace zerocount::numerics {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(a, false).eigenvalues();
}

Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& a) {
  return a.exp();
}

Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& a) {
  const Eigen::LLT<Eigen::MatrixXd> decomposition(a);
  if (decomposition.info() != Eigen::Success)
    return Eigen::MatrixXd::Constant(a.rows(), a.cols(), std::numeric_limits<double>::quiet_NaN());
  return decomposition.matrixL();
}

Eigen::MatrixXd solve_positive_definite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.llt().solve(b);
}

Eigen::MatrixXd inverse_of_positive_definite(const Eigen::MatrixXd& a) {
  return solve_positive_definite(a, Eigen::MatrixXd::Identity(a.rows(), a.cols()));
}

Eigen::VectorXd solve_transposed_factor(const Eigen::MatrixXd& factor, const Eigen::VectorXd& b) {
  return factor.transpose().triangularView<Eigen::Upper>().solve(b);
}

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a) {
  return least_squares(a, Eigen::MatrixXd::Identity(a.rows(), a.rows()));
}

Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a * b;
}

Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.transpose() * b;
}

}  // namespace zerocount::numerics
