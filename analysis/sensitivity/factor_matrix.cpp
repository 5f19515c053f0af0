#include "analysis/sensitivity/factor_matrix.hpp"

#include <algorithm>
#include <cstddef>

namespace zerocount::sensitivity {

Eigen::MatrixXd standardised(const Eigen::MatrixXd& x) {
  const Eigen::MatrixXd centred = x.rowwise() - x.colwise().mean();
  const Eigen::RowVectorXd sd = (centred.colwise().squaredNorm() / static_cast<double>(x.rows())).cwiseSqrt();
  return centred.array().rowwise() / sd.array();
}

std::vector<bool> independent_columns(const Eigen::MatrixXd& x) {
  constexpr double min_variance = 1e-8;
  std::vector<bool> independent(static_cast<std::size_t>(x.cols()), false);
  Eigen::MatrixXd directions(x.rows(), 0);
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    Eigen::VectorXd rest = x.col(j);
    for (int pass = 0; pass < 2; ++pass) rest -= directions * (directions.transpose() * rest);
    if (rest.squaredNorm() < min_variance * x.col(j).squaredNorm()) continue;
    independent[static_cast<std::size_t>(j)] = true;
    directions.conservativeResize(Eigen::NoChange, directions.cols() + 1);
    directions.rightCols(1) = rest.normalized();
  }
  return independent;
}

Eigen::MatrixXd marked_columns(const Eigen::MatrixXd& x, const std::vector<bool>& marks) {
  Eigen::MatrixXd marked(x.rows(), std::count(marks.begin(), marks.end(), true));
  Eigen::Index next = 0;
  for (std::size_t j = 0; j < marks.size(); ++j) {
    if (marks[j]) marked.col(next++) = x.col(static_cast<Eigen::Index>(j));
  }
  return marked;
}

}  // namespace zerocount::sensitivity
