#include "analysis/sensitivity/logistic_fit.hpp"

#include <cmath>
#include <cstddef>

#include "analysis/sensitivity/factor_matrix.hpp"
#include "analysis/statistics/distributions.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sensitivity {
namespace {

constexpr Eigen::Index min_beyond_coefficients = 10;
constexpr int max_steps = 60;
constexpr int max_halvings = 30;
constexpr double min_step = 1e-10;
// Near the maximum the likelihood cannot tell a step that is right from none.
constexpr double rounding = 1e-12;
// Of the reciprocal condition of ZᵀWZ: below, the weights along some direction have died away.
constexpr double flattest = 1e-13;

double log_likelihood(const Eigen::ArrayXd& predictor, const Eigen::ArrayXd& yes) {
  // ln p or ln(1 − p), neither of which overflows or cancels.
  const Eigen::ArrayXd against = (2.0 * yes - 1.0) * -predictor;
  return -(against.max(0.0) + (-against.abs()).exp().log1p()).sum();
}

struct Curvature {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;
};

Curvature curvature_at(const Eigen::MatrixXd& z, const Eigen::VectorXd& yes, const Eigen::VectorXd& b) {
  const Eigen::ArrayXd p = 1.0 / (1.0 + (-(z * b).array()).exp());
  const Eigen::VectorXd weights = p * (1.0 - p);
  return {z.transpose() * (yes - p.matrix()), numerics::transposed_product(z, weights.asDiagonal() * z)};
}

bool is_flat(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd values = numerics::eigenvalues(information).real();
  return !(values.minCoeff() > flattest * static_cast<double>(information.rows()) * values.maxCoeff());
}

// The coefficients of the greatest likelihood; empty where the steps do not end.
Eigen::VectorXd max_likelihood(const Eigen::MatrixXd& z, const Eigen::VectorXd& yes) {
  Eigen::VectorXd b = Eigen::VectorXd::Zero(z.cols());
  const double proportion = yes.mean();
  b(0) = std::log(proportion / (1.0 - proportion));
  double likelihood = log_likelihood((z * b).array(), yes.array());
  for (int step = 0; step < max_steps; ++step) {
    const Curvature curvature = curvature_at(z, yes, b);
    if (is_flat(curvature.information)) return {};
    Eigen::VectorXd change = numerics::solve_positive_definite(curvature.information, curvature.gradient);
    if (change.lpNorm<Eigen::Infinity>() < min_step * (1.0 + b.lpNorm<Eigen::Infinity>())) return b;
    double reached = log_likelihood((z * (b + change)).array(), yes.array());
    for (int halving = 0;
         halving < max_halvings && !(reached >= likelihood - rounding * std::abs(likelihood)); ++halving) {
      change *= 0.5;
      reached = log_likelihood((z * (b + change)).array(), yes.array());
    }
    b += change;
    likelihood = reached;
  }
  return {};
}

}  // namespace

LogisticFit logistic_fit(const Eigen::MatrixXd& x, const Eigen::VectorXd& yes, double confidence) {
  LogisticFit fit;
  fit.slopes.resize(static_cast<std::size_t>(x.cols()));
  const double proportion = yes.size() > 0 ? yes.mean() : 0.0;
  if (x.cols() == 0 || !(proportion > 0.0 && proportion < 1.0) ||
      x.rows() < x.cols() + 1 + min_beyond_coefficients) {
    return fit;
  }
  const Eigen::MatrixXd all = standardised(x);
  const std::vector<bool> independent = independent_columns(all);
  const Eigen::MatrixXd columns = marked_columns(all, independent);
  Eigen::MatrixXd z(columns.rows(), columns.cols() + 1);
  z << Eigen::VectorXd::Ones(columns.rows()), columns;

  const Eigen::VectorXd b = max_likelihood(z, yes);
  fit.status = b.size() > 0 ? LogisticFit::Status::fitted : LogisticFit::Status::separated;
  if (fit.status == LogisticFit::Status::separated) return fit;
  const Eigen::MatrixXd information = curvature_at(z, yes, b).information;
  const Eigen::MatrixXd covariance = numerics::inverse_of_positive_definite(information);
  const double quantile = statistics::two_sided_normal_quantile(confidence);
  const auto bounded = [&](Eigen::Index i) {
    const double half = quantile * std::sqrt(covariance(i, i));
    return BoundedNumber{b(i), b(i) - half, b(i) + half};
  };
  fit.intercept = bounded(0);
  Eigen::Index next = 1;
  for (std::size_t j = 0; j < independent.size(); ++j) {
    if (independent[j]) fit.slopes[j] = bounded(next++);
  }
  return fit;
}

}  // namespace zerocount::sensitivity
