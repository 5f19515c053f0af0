#include <algorithm>
#include <cmath>
#include <limits>

#include <ceres/cost_function.h>
#include <ceres/iteration_callback.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <glog/logging.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/record/fit/solver.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::fit {
namespace {

/// One result of better_points(): the point changed by `change`, after one linear step. Its sum of squares is
/// infinite if the point cannot be simulated.
FitResult linear_fit(Records records, const Observations& observations, const FittedModel& model,
                     const FitSetting& setting, const Point& change) {
  FitResult result{model.point, std::numeric_limits<double>::infinity(), false};
  result.point.axis += change;
  if (!is_sampled(records, setting.model, result.point.axis)) return result;
  NormalEquationsSum sum(records.size(), setting);
  for (std::size_t r = 0; r < records.size(); ++r) {
    Eigen::VectorXd path = modelled_path(records[r], setting.model, result.point.axis);
    path.array() += model.point.offset[static_cast<Eigen::Index>(r)];
    if (!path.allFinite()) return result;
    sum.add(r, observations[r], path, model.motions[r].sensitivity);
  }
  const NormalEquations equations = sum.with_prior(result.point.axis);
  const Eigen::VectorXd step = numerics::solve_positive_definite(equations.matrix, equations.gradient);
  const Eigen::Index dimension = dimension_of(setting.model);
  result.point.axis += step.head(dimension);
  result.point.offset += step.tail(step.size() - dimension);
  result.squares = equations.squares - step.dot(equations.gradient);
  return result;
}

}  // namespace

std::vector<FitResult> better_points(Records records, const Observations& observations,
                                     const FittedModel& model, const FitSetting& setting,
                                     const std::vector<Point>& changes) {
  constexpr double chance = 6.0;  // about 95 % of a sum of squares with two degrees of freedom
  std::vector<FitResult> points(changes.size() + 1);  // the last one is that without a change
  parallel::for_each_index(points.size(), [&](std::size_t i) {
    const Point change = i < changes.size() ? changes[i] : Point::Zero(dimension_of(setting.model));
    points[i] = linear_fit(records, observations, model, setting, change);
  });
  const double squares = points.back().squares;
  points.pop_back();
  std::erase_if(points, [&](const FitResult& point) { return !(point.squares < squares - chance); });
  std::stable_sort(points.begin(), points.end(),
                   [](const FitResult& one, const FitResult& other) { return one.squares < other.squares; });
  return points;
}

NormalEquationsSum::NormalEquationsSum(std::size_t records, const FitSetting& setting) : setting_(setting) {
  const Eigen::Index size = dimension_of(setting.model) + static_cast<Eigen::Index>(records);
  sum_.matrix.setZero(size, size);
  sum_.gradient.setZero(size);
}

void NormalEquationsSum::add(std::size_t record, const std::vector<AngleObservation>& observations,
                             const Eigen::VectorXd& path, const Eigen::MatrixXd& sensitivity) {
  const Eigen::Index dimension = dimension_of(setting_.model);
  // A row for each observation: its slopes, 1 for the offset, and the residual, over its standard deviation.
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(observations.size()), dimension + 2);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const AngleObservation& observation = observations[i];
    auto row = rows.row(static_cast<Eigen::Index>(i));
    row.head(dimension) = mean_over(observation, sensitivity);
    row[dimension] = 1.0;
    row[dimension + 1] = observation.position - mean_over(observation, path).value();
    row /= std::sqrt(observation.variance);
  }
  const Eigen::MatrixXd products = numerics::transposed_product(rows, rows);
  const Eigen::Index offset = dimension + static_cast<Eigen::Index>(record);
  sum_.observations += observations.size();
  sum_.squares += products(dimension + 1, dimension + 1);
  sum_.matrix.topLeftCorner(dimension, dimension) += products.topLeftCorner(dimension, dimension);
  sum_.matrix.block(0, offset, dimension, 1) += products.block(0, dimension, dimension, 1);
  sum_.matrix.block(offset, 0, 1, dimension) += products.block(dimension, 0, 1, dimension);
  sum_.matrix(offset, offset) += products(dimension, dimension);
  sum_.gradient.head(dimension) += products.block(0, dimension + 1, dimension, 1);
  sum_.gradient[offset] += products(dimension, dimension + 1);
}

NormalEquations NormalEquationsSum::with_prior(const Point& at) const {
  NormalEquations equations = sum_;
  const double weight = 1.0 / (setting_.prior_spread * setting_.prior_spread);
  for (Eigen::Index j = 0; j < dimension_of(setting_.model); ++j) {
    if (setting_.free[static_cast<std::size_t>(j)]) {
      equations.matrix(j, j) += weight;
      equations.gradient[j] += weight * (setting_.prior[j] - at[j]);
    } else {
      equations.matrix.row(j).setZero();
      equations.matrix.col(j).setZero();
      equations.matrix(j, j) = 1.0;
      equations.gradient[j] = 0.0;
    }
  }
  return equations;
}

}  // namespace zerocount::fit
