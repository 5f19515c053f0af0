#include "analysis/trials/sensitivity/correlations.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/distributions.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sensitivity {
namespace {

constexpr std::size_t min_values = 10;

// The values of a sample as ranks.
struct Ranks {
  std::vector<std::size_t> order;  // indices, by ascending value
  std::vector<double> middle;      // [i]: its mid-distribution
};

std::vector<std::size_t> ascending_order(std::span<const double> values) {
  std::vector<std::pair<double, std::size_t>> sorted;
  sorted.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) sorted.emplace_back(values[i], i);
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::size_t> order;
  order.reserve(values.size());
  for (const auto& [value, index] : sorted) order.push_back(index);
  return order;
}

// Calls visit(first, last) for each run of equal values in the order.
template <class Visit>
void visit_ties(std::span<const double> values, const std::vector<std::size_t>& order, const Visit& visit) {
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first + 1;
    while (last < order.size() && values[order[last]] == values[order[first]]) ++last;
    visit(first, last);
    first = last;
  }
}

Ranks ranked(std::span<const double> values) {
  Ranks ranks{ascending_order(values), std::vector<double>(values.size())};
  visit_ties(values, ranks.order, [&](std::size_t first, std::size_t last) {
    const double middle = 0.5 * static_cast<double>(first + last) / static_cast<double>(values.size());
    for (std::size_t place = first; place < last; ++place) ranks.middle[ranks.order[place]] = middle;
  });
  return ranks;
}

// [i]: 1/n Σ_l m(x_i, x_l) weight_l.
std::vector<double> mean_above(const Ranks& x, std::span<const double> weight) {
  std::vector<double> means(weight.size());
  double above = std::accumulate(weight.begin(), weight.end(), 0.0);
  visit_ties(x.middle, x.order, [&](std::size_t first, std::size_t last) {
    double tied = 0.0;
    for (std::size_t place = first; place < last; ++place) tied += weight[x.order[place]];
    above -= tied;
    for (std::size_t place = first; place < last; ++place) {
      means[x.order[place]] = (above + 0.5 * tied) / static_cast<double>(weight.size());
    }
  });
  return means;
}

// E[F·G] − ¼ of two mid-distributions, with its influence function.
struct CoMoment {
  double value{0.0};
  std::vector<double> influence;
};

CoMoment co_moment(const Ranks& x, const Ranks& y) {
  const std::vector<double>& f = x.middle;
  const std::vector<double>& g = y.middle;
  const double n = static_cast<double>(f.size());
  const double product = std::inner_product(f.begin(), f.end(), g.begin(), 0.0) / n;
  const std::vector<double> along_f = mean_above(x, g);
  const std::vector<double> along_g = mean_above(y, f);
  CoMoment moment{product - 0.25, std::vector<double>(f.size())};
  for (std::size_t i = 0; i < f.size(); ++i) {
    moment.influence[i] = f[i] * g[i] + along_f[i] + along_g[i] - 3.0 * product;
  }
  return moment;
}

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

IndependentColumns independent_columns(const Eigen::MatrixXd& x) {
  constexpr double min_variance = 1e-8;
  const Eigen::MatrixXd centred = x.rowwise() - x.colwise().mean();
  const Eigen::RowVectorXd sd = (centred.colwise().squaredNorm() / static_cast<double>(x.rows())).cwiseSqrt();
  const Eigen::MatrixXd all = centred.array().rowwise() / sd.array();
  IndependentColumns found{Eigen::MatrixXd(x.rows(), 0), {}};
  Eigen::MatrixXd directions(x.rows(), 0);
  const auto append = [](Eigen::MatrixXd& columns, const Eigen::VectorXd& column) {
    columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
    columns.rightCols(1) = column;
  };
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    Eigen::VectorXd rest = all.col(j);
    for (int pass = 0; pass < 2; ++pass) rest -= directions * (directions.transpose() * rest);
    if (rest.squaredNorm() < min_variance * all.col(j).squaredNorm()) continue;
    append(directions, rest.normalized());
    append(found.values, all.col(j));
    found.places.push_back(static_cast<std::size_t>(j));
  }
  return found;
}

bool is_constant(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [&](double v) { return v == values.front(); });
}

std::vector<double> mid_distribution(std::span<const double> values) {
  return ranked(values).middle;
}

BoundedNumber fisher_bounds(double correlation, double standard_error, double confidence) {
  const double slope = 1.0 - correlation * correlation;
  if (!(slope > 0.0)) return {correlation, correlation, correlation};
  const double half = statistics::two_sided_normal_quantile(confidence) * standard_error / slope;
  const double middle = std::atanh(correlation);
  return {correlation, std::tanh(middle - half), std::tanh(middle + half)};
}

BoundedNumber rank_correlation(std::span<const double> x, std::span<const double> y, double confidence) {
  if (x.size() < min_values) return {};
  if (is_constant(x) || is_constant(y)) return {};
  const Ranks ranked_x = ranked(x);
  const Ranks ranked_y = ranked(y);
  const CoMoment together = co_moment(ranked_x, ranked_y);
  const CoMoment of_x = co_moment(ranked_x, ranked_x);
  const CoMoment of_y = co_moment(ranked_y, ranked_y);
  const double scale = std::sqrt(of_x.value * of_y.value);
  const double correlation = std::clamp(together.value / scale, -1.0, 1.0);
  double squares = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double influence =
        together.influence[i] / scale -
        0.5 * correlation * (of_x.influence[i] / of_x.value + of_y.influence[i] / of_y.value);
    squares += influence * influence;
  }
  const double n = static_cast<double>(x.size());
  return fisher_bounds(correlation, std::sqrt(squares / (n * (n - 3.0))), confidence);
}

std::vector<BoundedNumber> partial_rank_correlations(const Eigen::MatrixXd& x, std::span<const double> y,
                                                     double confidence) {
  constexpr Eigen::Index min_beyond_columns = 10;
  std::vector<BoundedNumber> correlations(static_cast<std::size_t>(x.cols()));
  if (x.cols() == 0 || x.rows() < x.cols() + min_beyond_columns) return correlations;
  const Eigen::VectorXd ranks_y = ranks_of(y);
  if (ranks_y.squaredNorm() == 0.0) return correlations;
  const auto [ranks, places] = independent_columns(ranks_of_columns(x));

  // With Q the inverse of XᵀX, what is left of column j is X·Q_j/Q_jj, and of y when all columns but j are
  // taken from it, the remainder of the full regression plus its part along that.
  const Eigen::MatrixXd inverse =
      numerics::inverse_of_positive_definite(numerics::transposed_product(ranks, ranks));
  const Eigen::VectorXd slopes = inverse * (ranks.transpose() * ranks_y);
  const Eigen::VectorXd remainder = ranks_y - ranks * slopes;
  const auto freedom = static_cast<double>(ranks.rows() - ranks.cols() - 2);
  for (Eigen::Index j = 0; j < ranks.cols(); ++j) {
    const Eigen::VectorXd of_column = ranks * inverse.col(j) / inverse(j, j);
    correlations[places[static_cast<std::size_t>(j)]] =
        correlation_of_remainders(of_column, remainder + slopes(j) * of_column, freedom, confidence);
  }
  return correlations;
}

LogisticFit logistic_fit(const Eigen::MatrixXd& x, const Eigen::VectorXd& yes, double confidence) {
  LogisticFit fit;
  fit.slopes.resize(static_cast<std::size_t>(x.cols()));
  const double proportion = yes.size() > 0 ? yes.mean() : 0.0;
  if (x.cols() == 0 || !(proportion > 0.0 && proportion < 1.0) ||
      x.rows() < x.cols() + 1 + min_beyond_coefficients) {
    return fit;
  }
  const auto [columns, places] = independent_columns(x);
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
  for (Eigen::Index j = 0; j < columns.cols(); ++j)
    fit.slopes[places[static_cast<std::size_t>(j)]] = bounded(j + 1);
  return fit;
}

}  // namespace zerocount::sensitivity
