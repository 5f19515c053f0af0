
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/parallel/parallel.hpp"
#include "analysis/sensitivity/factor_matrix.hpp"
#include "analysis/sensitivity/rank_correlation.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sensitivity {
namespace {

Eigen::MatrixXd ranks_of_columns(const Eigen::MatrixXd& x) {
  Eigen::MatrixXd ranks(x.rows(), x.cols());
  parallel::for_each_index(static_cast<std::size_t>(x.cols()), [&](std::size_t i) {
    const auto j = static_cast<Eigen::Index>(i);
    const std::vector<double> f = mid_distribution({x.col(j).data(), static_cast<std::size_t>(x.rows())});
    ranks.col(j) = Eigen::VectorXd::Map(f.data(), x.rows());
  });
  return ranks;
}

Eigen::VectorXd ranks_of(std::span<const double> y) {
  const std::vector<double> g = mid_distribution(y);
  Eigen::VectorXd ranks = Eigen::VectorXd::Map(g.data(), static_cast<Eigen::Index>(g.size()));
  return ranks.array() - ranks.mean();
}

// Of what is left of the column, and of y; `freedom` is n − k − 2.
BoundedNumber correlation_of_remainders(const Eigen::VectorXd& of_column, const Eigen::VectorXd& of_y,
                                        double freedom, double confidence) {
  const double n = static_cast<double>(of_y.size());
  // Where the other columns explain the ranks of y wholly, nothing but rounding is left of them.
  if (of_y.squaredNorm() < 1e-20 * n) return {};
  const Eigen::ArrayXd u = of_column.array() / std::sqrt(of_column.squaredNorm() / n);
  const Eigen::ArrayXd v = of_y.array() / std::sqrt(of_y.squaredNorm() / n);
  const double correlation = std::clamp((u * v).mean(), -1.0, 1.0);
  const double squares = (u * v - 0.5 * correlation * (u.square() + v.square())).square().sum();
  return fisher_bounds(correlation, std::sqrt(squares / (n * freedom)), confidence);
}

}  // namespace

std::vector<BoundedNumber> partial_rank_correlations(const Eigen::MatrixXd& x, std::span<const double> y,
                                                     double confidence) {
  constexpr Eigen::Index min_beyond_columns = 10;
  std::vector<BoundedNumber> correlations(static_cast<std::size_t>(x.cols()));
  if (x.cols() == 0 || x.rows() < x.cols() + min_beyond_columns) return correlations;
  const Eigen::VectorXd ranks_y = ranks_of(y);
  if (ranks_y.squaredNorm() == 0.0) return correlations;
  const Eigen::MatrixXd all = standardised(ranks_of_columns(x));
  const std::vector<bool> independent = independent_columns(all);
  const Eigen::MatrixXd ranks = marked_columns(all, independent);

  // With Q the inverse of XᵀX, what is left of column j is X·Q_j/Q_jj, and of y when all columns but j are
  // taken from it, the remainder of the full regression plus its part along that.
  const Eigen::MatrixXd inverse =
      numerics::inverse_of_positive_definite(numerics::transposed_product(ranks, ranks));
  const Eigen::VectorXd slopes = inverse * (ranks.transpose() * ranks_y);
  const Eigen::VectorXd remainder = ranks_y - ranks * slopes;
  const auto freedom = static_cast<double>(ranks.rows() - ranks.cols() - 2);
  Eigen::Index next = 0;
  for (std::size_t j = 0; j < correlations.size(); ++j) {
    if (!independent[j]) continue;
    const Eigen::VectorXd of_column = ranks * inverse.col(next) / inverse(next, next);
    correlations[j] =
        correlation_of_remainders(of_column, remainder + slopes(next) * of_column, freedom, confidence);
    ++next;
  }
  return correlations;
}

}  // namespace zerocount::sensitivity
