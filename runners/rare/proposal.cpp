#include "runners/rare/proposal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Core>

#include "core/numerics/dense.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::rare {
namespace {

constexpr std::size_t max_components = 8;
constexpr int max_iterations = 25;
constexpr std::size_t max_points = 1500;  // to which a mixture is fitted

Eigen::VectorXd vector_of(std::span<const double> z) {
  return Eigen::VectorXd::Map(z.data(), std::ssize(z));
}

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The square matrix whose elements are stored row by row.
Eigen::MatrixXd matrix_of(std::span<const double> rows) {
  const auto size = static_cast<Eigen::Index>(std::lround(std::sqrt(static_cast<double>(rows.size()))));
  return Eigen::Map<const RowMatrix>(rows.data(), size, size);
}

/// Inverse L⁻¹ of a lower triangular `size` × `size` matrix L, both stored row by row.
std::vector<double> inverse_of_factor(std::span<const double> factor, std::size_t size) {
  std::vector<double> inverse(factor.size(), 0.0);
  for (std::size_t column = 0; column < size; ++column) {
    for (std::size_t i = column; i < size; ++i) {
      double sum = i == column ? 1.0 : 0.0;
      for (std::size_t j = column; j < i; ++j) sum -= factor[i * size + j] * inverse[j * size + column];
      inverse[i * size + column] = sum / factor[i * size + i];
    }
  }
  return inverse;
}

NormalComponent component_of(double weight, const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance) {
  const RowMatrix factor = numerics::cholesky_factor(covariance);
  return normal_component(weight, {mean.begin(), mean.end()}, {factor.data(), factor.data() + factor.size()});
}

/// [column] Natural logarithm of the component's normal density at each column of `z`, without the factor
/// (2π)^(−d/2).
Eigen::VectorXd log_densities(const NormalComponent& component, const Eigen::MatrixXd& z) {
  const Eigen::MatrixXd white =
      numerics::product(matrix_of(component.inverse_factor), z.colwise() - vector_of(component.mean));
  return -0.5 * white.colwise().squaredNorm().transpose().array() - component.log_determinant;
}

/// Natural logarithm of the component's normal density at one point, without the factor (2π)^(−d/2).
double log_density(const NormalComponent& component, std::span<const double> z) {
  const std::size_t size = z.size();
  double squares = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    double white = 0.0;
    for (std::size_t j = 0; j <= i; ++j)
      white += component.inverse_factor[i * size + j] * (z[j] - component.mean[j]);
    squares += white * white;
  }
  return -0.5 * squares - component.log_determinant;
}

/// ln Σ exp(xᵢ), computed without overflow.
double log_sum(std::span<const double> x) {
  const double largest = std::ranges::max(x);
  double sum = 0.0;
  for (const double one : x) sum += numerics::exp(one - largest);
  return largest + numerics::log(sum);
}

/// Points to which a mixture of normal distributions is fitted, as columns of a matrix.
struct FittedPoints {
  Eigen::MatrixXd z;        ///< [coordinate, point] Coordinates of the points, one column per point.
  Eigen::VectorXd weights;  ///< [point] Weights of the points. They sum to the effective sample size.
};

/// Normal component fitted to points with the weights `weights`. The component's own weight in the mixture is
/// the sum of `weights` divided by the sum of points.weights. Its covariance is that of the weighted points,
/// mixed with d + 2 points of the standard normal distribution, so that it is never singular.
NormalComponent component_of(const FittedPoints& points, const Eigen::VectorXd& weights) {
  const double sum = weights.sum();
  const Eigen::VectorXd mean = numerics::product(points.z, weights) / sum;
  const Eigen::MatrixXd centred = points.z.colwise() - mean;
  const Eigen::MatrixXd weighted = centred * weights.asDiagonal();
  const double added = static_cast<double>(mean.size()) + 2.0;
  const Eigen::MatrixXd covariance = (numerics::product(weighted, centred.transpose()) +
                                      added * Eigen::MatrixXd::Identity(mean.size(), mean.size())) /
                                     (sum + added);
  return component_of(sum / points.weights.sum(), mean, covariance);
}

/// A mixture of normal distributions during its fit to points by expectation and maximisation.
struct Fit {
  std::vector<NormalComponent> components;
  /// Mean log-likelihood of the points under the mixture, per unit of weight.
  double log_likelihood{-std::numeric_limits<double>::infinity()};
};

/// Indices of `count` points far from each other, which are the first means of the components (k-means++,
/// Arthur and Vassilvitskii 2007).
std::vector<Eigen::Index> first_centres(const FittedPoints& points, std::size_t count,
                                        NumberSource& numbers) {
  Eigen::VectorXd distance = Eigen::VectorXd::Ones(points.weights.size());
  std::vector<Eigen::Index> centres;
  while (centres.size() < count) {
    const Eigen::VectorXd chances = distance.cwiseProduct(points.weights);
    double place = numbers.uniform() * chances.sum();
    Eigen::Index chosen = 0;
    for (; chosen + 1 < chances.size(); ++chosen) {
      place -= chances[chosen];
      if (place < 0.0) break;
    }
    const Eigen::VectorXd centre = points.z.col(chosen);
    const Eigen::VectorXd squares = (points.z.colwise() - centre).colwise().squaredNorm().transpose();
    distance = centres.empty() ? squares : Eigen::VectorXd(distance.cwiseMin(squares));
    centres.push_back(chosen);
  }
  return centres;
}

/// [component] Weight of each point times the probability that it belongs to the component (expectation
/// step). Sets the mean log-likelihood of `fit`.
std::vector<Eigen::VectorXd> weights_in(const FittedPoints& points, Fit& fit) {
  std::vector<Eigen::VectorXd> in_component;
  for (const NormalComponent& component : fit.components)
    in_component.emplace_back(log_densities(component, points.z).array() + numerics::log(component.weight));
  double sum = 0.0;
  std::vector<double> logs(fit.components.size());
  for (Eigen::Index i = 0; i < points.weights.size(); ++i) {
    for (std::size_t k = 0; k < logs.size(); ++k) logs[k] = in_component[k][i];
    const double all = log_sum(logs);
    for (std::size_t k = 0; k < logs.size(); ++k)
      in_component[k][i] = points.weights[i] * numerics::exp(logs[k] - all);
    sum += points.weights[i] * all;
  }
  fit.log_likelihood = sum / points.weights.sum();
  return in_component;
}

Fit fit_of(const FittedPoints& points, std::size_t count, NumberSource& numbers) {
  Fit fit{{component_of(points, points.weights)}};
  std::vector<Eigen::VectorXd> weights = weights_in(points, fit);
  if (count == 1) return fit;
  const NormalComponent whole = fit.components.front();
  fit = {};
  for (const Eigen::Index centre : first_centres(points, count, numbers)) {
    fit.components.push_back(whole);
    fit.components.back().weight = 1.0 / static_cast<double>(count);
    const Eigen::VectorXd mean = points.z.col(centre);
    fit.components.back().mean = {mean.begin(), mean.end()};
  }
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const double before = fit.log_likelihood;
    weights = weights_in(points, fit);
    if (fit.log_likelihood < before + 1e-3) break;
    const double least = 1e-3 * points.weights.sum();
    fit.components.clear();
    double sum = 0.0;
    for (const Eigen::VectorXd& in_component : weights) {
      if (in_component.sum() < least) continue;
      fit.components.push_back(component_of(points, in_component));
      sum += fit.components.back().weight;
    }
    for (NormalComponent& one : fit.components) one.weight /= sum;
  }
  return fit;
}

/// The component with its covariance S enlarged to S + 1.25·S·(I + S)⁻³, so that the proposal covers the
/// tails.
NormalComponent widened(const NormalComponent& component) {
  const Eigen::MatrixXd factor = matrix_of(component.factor);
  const Eigen::MatrixXd covariance = numerics::product(factor, factor.transpose());
  const Eigen::MatrixXd inverse = numerics::inverse_of_positive_definite(
      covariance + Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
  const Eigen::MatrixXd cube = numerics::product(inverse, numerics::product(inverse, inverse));
  const Eigen::MatrixXd added = 1.25 * numerics::product(covariance, cube);
  return component_of(component.weight, vector_of(component.mean),
                      covariance + 0.5 * (added + added.transpose()));
}

/// The points as columns of a matrix. If there are more than a fit takes, a sample of them, drawn by their
/// weights.
FittedPoints fitted_points(const WeightedPoints& points, NumberSource& numbers) {
  const double effective = effective_size(points.weights);
  const std::size_t size = points.z.size();
  const bool all = size <= max_points;
  std::vector<double> places;  // of the points drawn, in the cumulative weights
  for (std::size_t i = 0; !all && i < max_points; ++i) places.push_back(numbers.uniform());
  std::ranges::sort(places);
  const double sum = std::accumulate(points.weights.begin(), points.weights.end(), 0.0);
  const auto count = static_cast<Eigen::Index>(all ? size : max_points);
  FittedPoints fitted{Eigen::MatrixXd(std::ssize(points.z.front()), count), Eigen::VectorXd(count)};
  double passed = 0.0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < size; ++i) {
    passed += points.weights[i] / sum;
    if (all) {
      fitted.z.col(static_cast<Eigen::Index>(i)) = vector_of(points.z[i]);
      fitted.weights[static_cast<Eigen::Index>(i)] = points.weights[i] / sum * effective;
    }
    for (; next < places.size() && (places[next] < passed || i + 1 == size); ++next) {
      fitted.z.col(static_cast<Eigen::Index>(next)) = vector_of(points.z[i]);
      fitted.weights[static_cast<Eigen::Index>(next)] = effective / static_cast<double>(max_points);
    }
  }
  return fitted;
}

/// Density at `z` of the mixture of pinned values (the trials' own distribution, given that a discrete draw
/// has one value), divided by the density of the trials' own distribution.
double density_of_pinned(const TrialSpace& space, const Proposal& proposal, std::span<const double> z) {
  double density = 0.0;
  for (const PinnedValue& one : proposal.values) {
    if (randomness::value_at(space.discrete[one.draw], z) == one.value)
      density += one.weight / one.probability;
  }
  return density;
}

/// Chooses an element with a probability proportional to its weight.
/// @param place uniform random number from 0 to the sum of the weights; the element is returned in whose
/// interval of the cumulative weights it lies
template <class Weighted>
const Weighted& chosen_by(const std::vector<Weighted>& all, double place) {
  std::size_t chosen = 0;
  for (; chosen + 1 < all.size(); ++chosen) {
    place -= all[chosen].weight;
    if (place < 0.0) break;
  }
  return all[chosen];
}

}  // namespace

NormalComponent normal_component(double weight, std::vector<double> mean, std::vector<double> factor) {
  NormalComponent component{weight, std::move(mean), std::move(factor), {}, 0.0};
  const std::size_t size = component.mean.size();
  component.inverse_factor = inverse_of_factor(component.factor, size);
  for (std::size_t i = 0; i < size; ++i)
    component.log_determinant += numerics::log(component.factor[i * size + i]);
  return component;
}

double density_ratio(std::span<const NormalComponent> components, std::span<const double> z) {
  double standard = 0.0;
  for (const double x : z) standard += 0.5 * x * x;
  double density = 0.0;
  for (const NormalComponent& component : components)
    density += component.weight * numerics::exp(log_density(component, z) + standard);
  return density;
}

std::vector<double> draw(const NormalComponent& component, NumberSource& numbers) {
  const std::size_t size = component.mean.size();
  const std::vector<double> z = numbers.normals(size);
  std::vector<double> point = component.mean;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j <= i; ++j) point[i] += component.factor[i * size + j] * z[j];
  }
  return point;
}

double effective_size(std::span<const double> weights) {
  double sum = 0.0;
  double squares = 0.0;
  for (const double weight : weights) {
    sum += weight;
    squares += weight * weight;
  }
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

NormalComponent fitted_normal(const WeightedPoints& points, NumberSource& numbers) {
  return widened(fit_of(fitted_points(points, numbers), 1, numbers).components.front());
}

std::vector<NormalComponent> fitted_mixture(const WeightedPoints& points, NumberSource& numbers) {
  const FittedPoints fitted = fitted_points(points, numbers);
  const double effective = fitted.weights.sum();
  const auto size = static_cast<double>(fitted.z.rows());
  const double parameters = 1.0 + size + 0.5 * size * (size + 1.0);
  Fit best;
  double best_criterion = std::numeric_limits<double>::infinity();
  for (std::size_t count = 1; count <= max_components; ++count) {
    Fit fit = fit_of(fitted, count, numbers);
    const double criterion =
        -2.0 * effective * fit.log_likelihood +
        parameters * static_cast<double>(count) * numerics::log(std::max(effective, 2.0));
    if (criterion >= best_criterion) break;
    best_criterion = criterion;
    best = std::move(fit);
  }
  std::vector<NormalComponent> widened_ones;
  for (const NormalComponent& component : best.components) widened_ones.push_back(widened(component));
  return widened_ones;
}

TrialSpace trial_space(std::size_t coordinates, std::vector<randomness::DiscreteDraw> discrete) {
  TrialSpace space{coordinates, std::move(discrete)};
  for (const randomness::DiscreteDraw& draw : space.discrete) {
    if (!draw.ordered && draw.direction.size() == 1) space.unordered.push_back(draw.direction.front().first);
  }
  std::ranges::sort(space.unordered);
  return space;
}

std::vector<PinnedValue> pinned_values(const TrialSpace& space, std::size_t draw) {
  const randomness::DiscreteDraw& drawn = space.discrete[draw];
  std::vector<PinnedValue> values;
  for (std::int64_t value = 0; value < drawn.values(); ++value) values.push_back({draw, value});
  for (std::int64_t row = 0; row < drawn.rows; ++row)
    values[static_cast<std::size_t>(randomness::value_of_row(drawn, row))].rows.push_back(row);
  for (PinnedValue& one : values)
    one.probability = static_cast<double>(one.rows.size()) / static_cast<double>(drawn.rows);
  return values;
}

std::vector<double> proposal_coordinates(const TrialSpace& space, std::span<const double> z) {
  std::vector<double> part;
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (!std::ranges::binary_search(space.unordered, i)) part.push_back(z[i]);
  }
  return part;
}

bool is_pinned(const TrialSpace& space, const Proposal& proposal, std::span<const double> z) {
  return density_of_pinned(space, proposal, z) > 0.0;
}

double likelihood_ratio(const TrialSpace& space, const Proposal& proposal, std::span<const double> z) {
  double learned = proposal.pinned * density_of_pinned(space, proposal, z);
  if (!proposal.components.empty())
    learned += (1.0 - proposal.pinned) * density_ratio(proposal.components, proposal_coordinates(space, z));
  return 1.0 / (proposal.natural + (1.0 - proposal.natural) * learned);
}

double max_ratio_of_pinned(const Proposal& proposal) {
  double ratio = 0.0;
  for (const PinnedValue& one : proposal.values)
    ratio = std::max(ratio, 1.0 / (proposal.natural + (1.0 - proposal.natural) * proposal.pinned *
                                                          one.weight / one.probability));
  return ratio;
}

DrawnPoint draw(const TrialSpace& space, const Proposal& proposal, NumberSource& numbers) {
  const double choice = numbers.uniform();
  if (choice < proposal.natural || proposal.is_natural()) return {numbers.normals(space.coordinates), true};
  const double place = (choice - proposal.natural) / (1.0 - proposal.natural);
  if (place < proposal.pinned || proposal.components.empty())
    return {draw_pinned(space, chosen_by(proposal.values, place / proposal.pinned), numbers)};
  const NormalComponent& component =
      chosen_by(proposal.components, (place - proposal.pinned) / (1.0 - proposal.pinned));
  const std::vector<double> changed = draw(component, numbers);
  std::vector<double> z;
  std::size_t next = 0;
  for (std::size_t i = 0; i < space.coordinates; ++i)
    z.push_back(std::ranges::binary_search(space.unordered, i) ? numbers.normal() : changed[next++]);
  return {std::move(z)};
}

std::vector<double> draw_pinned(const TrialSpace& space, const PinnedValue& pinned, NumberSource& numbers) {
  std::vector<double> z = numbers.normals(space.coordinates);
  const auto row = static_cast<std::size_t>(numbers.uniform() * static_cast<double>(pinned.rows.size()));
  randomness::move_to_row(space.discrete[pinned.draw], pinned.rows[std::min(row, pinned.rows.size() - 1)],
                          numbers.uniform(), z);
  return z;
}

}  // namespace zerocount::rare
