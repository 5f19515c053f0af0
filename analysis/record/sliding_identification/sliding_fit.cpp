#include "analysis/record/sliding_identification/sliding_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <ceres/cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>

#include "analysis/record/fit/record.hpp"
#include "analysis/record/fit/solver.hpp"
#include "analysis/record/sliding_identification/torque_balance.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sliding_identification {
namespace {

constexpr double tiny = std::numeric_limits<double>::min();

std::vector<FittedWindow> windows_of(std::span<const SlidingRecord> records) {
  std::vector<FittedWindow> windows;
  for (const SlidingRecord& record : records) {
    for (const Window& window : record.windows) {
      windows.push_back({&record, &window, {record.position[window.first], record.velocity[window.first]}});
    }
  }
  return windows;
}

/// Minimises the sum of squares of the residuals over the parameters and the windows' initial states, and
/// stores both in the fit.
/// @returns the minimum
double solve(SlidingFit& fit) {
  ceres::Problem problem;
  for (FittedWindow& fitted : fit.windows) {
    problem.AddResidualBlock(window_residuals(*fitted.record, *fitted.window).release(), nullptr,
                             fit.point.data(), fitted.start.data());
  }
  std::vector<int> known;
  const int size = problem.ParameterBlockSize(fit.point.data());
  for (int j = 0; j < size; ++j) {
    if (!fit.free[static_cast<std::size_t>(j)]) known.push_back(j);
  }
  problem.SetManifold(fit.point.data(), new ceres::SubsetManifold(size, known));
  fit::SearchSetting search;
  search.max_steps = 60;
  search.tolerance = 1e-9;
  search.trust_region = 1e12;  // Gauss–Newton steps, damped where they fail
  search.many_blocks = true;
  const fit::SearchResult found = fit::search_least_squares(problem, search);
  if (!found.found) {
    const SlidingRecord& record = *fit.windows.front().record;
    fit::refuse(record.axis, record.name,
                "the simulated motion cannot be fitted to the positions; expected torque and position in the "
                "units that --column gives");
  }
  return found.squares;
}

/// Contribution of one or more windows to the estimating equations (information matrix and score), after
/// elimination of the windows' initial states.
struct Score {
  SlidingMatrix information{SlidingMatrix::Zero()};
  SlidingPoint score{SlidingPoint::Zero()};

  void operator+=(const Score& other) {
    information += other.information;
    score += other.score;
  }
};

Score score_of(const FittedWindow& fitted, const SlidingPoint& point) {
  auto [residual, slopes, by_start] = slopes_of(fitted, point);
  const Eigen::Index size = slopes.cols();
  slopes -= numerics::product(by_start, numerics::least_squares(by_start, slopes));
  Score score;
  score.information.topLeftCorner(size, size) = numerics::transposed_product(slopes, slopes);
  score.score.head(size) = -slopes.transpose() * residual;
  return score;
}

/// [parameter] Scale 1/√information of each free parameter, which makes them comparable; 0 for parameters
/// that are not free.
SlidingPoint scale_of(const Score& total, const FreeParameters& free) {
  SlidingPoint scale = total.information.diagonal().cwiseMax(tiny).cwiseSqrt().cwiseInverse();
  for (std::size_t j = 0; j < sliding_dimension; ++j) {
    if (!free[j]) scale[static_cast<Eigen::Index>(j)] = 0.0;
  }
  return scale;
}

SlidingMatrix scaled(const SlidingPoint& scale, const SlidingMatrix& matrix) {
  return scale.asDiagonal() * matrix * scale.asDiagonal();
}

/// Jackknife covariance of the scaled parameters from fits that each leave out one cluster of samples: (G −
/// 1)/G·Σδ_g·δ_gᵀ with δ_g = (B − B_g)⁻¹·s_g and G clusters.
SlidingMatrix jackknife(const SlidingPoint& scale, const Score& total, const std::vector<Score>& clusters) {
  const auto groups = static_cast<double>(clusters.size());
  SlidingMatrix sum = SlidingMatrix::Zero();
  for (const Score& cluster : clusters) {
    const SlidingPoint change = numerics::least_squares(
        scaled(scale, total.information - cluster.information), scale.cwiseProduct(cluster.score));
    sum += change * change.transpose();
  }
  return (groups - 1.0) / groups * sum;
}

/// Enlarges the variance of each parameter in `covariance` to that in `other` if this is larger; the
/// correlations stay.
SlidingMatrix enlarged(const SlidingMatrix& covariance, const SlidingMatrix& other) {
  const SlidingPoint ratio = other.diagonal().cwiseQuotient(covariance.diagonal().cwiseMax(tiny));
  return scaled(ratio.cwiseMax(1.0).cwiseSqrt(), covariance);
}

}  // namespace

SlidingPoint starting_point(std::span<const SlidingRecord> records, bool both_directions) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(balance_terms, balance_terms);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(balance_terms);
  for (const SlidingRecord& record : records) {
    const std::size_t reach = balance_reach(record);
    for (const Window& stroke : record.strokes) {
      for (std::size_t k = stroke.first; k <= stroke.last; ++k) {
        if (k < reach || k + reach >= record.time.size()) continue;
        TorqueBalance balance = torque_balance(record, k, stroke.direction);
        if (!both_directions) balance.terms[offset_term] = 0.0;
        normal += balance.terms * balance.terms.transpose();
        right += balance.terms * balance.torque;
      }
    }
  }
  const Eigen::VectorXd found = numerics::least_squares(normal, right);
  if (!(found[0] > 0.0)) {
    fit::refuse(records.front().axis, records.front().name,
                found[direction_term] > 0.0
                    ? "shows no sliding: it accelerates against the $torque, as on a spring; material tests "
                      "within the pre-sliding range are identified without --sliding"
                    : "the axis accelerates against the torque; is one of them of the wrong sign? --column "
                      "turns it with the factor -1");
  }
  SlidingPoint point = SlidingPoint::Zero();
  point.head<4>() << std::log(found[0]), found[1], found[2], found[3];
  return point;
}

SlidingFit fit_sliding(std::span<const SlidingRecord> records, const SlidingPoint& start,
                       const FreeParameters& free, const std::vector<PositionWave>& waves) {
  SlidingFit fit;
  fit.waves = waves;
  fit.point = start;
  fit.free = free;
  fit.windows = windows_of(records);
  const double squares = solve(fit);
  Score total;
  std::vector<Score> by_window;
  std::vector<Score> by_stroke;
  double unexplained = 0.0;
  for (const FittedWindow& fitted : fit.windows) {
    const Score score = score_of(fitted, fit.point);
    total += score;
    by_window.push_back(score);
    if (fitted.window->first == fitted.record->strokes[fitted.window->stroke].first) by_stroke.emplace_back();
    by_stroke.back() += score;
    // A step of this window's offset alone.
    fit.unexplained.push_back(score.score[offset_torque] /
                              std::max(score.information(offset_torque, offset_torque), tiny));
    unexplained += fit.unexplained.back() * fit.unexplained.back();
    fit.samples += samples_of(*fitted.window);
  }
  const auto windows = static_cast<double>(fit.windows.size());
  const auto samples = static_cast<double>(fit.samples);
  fit.misfit = std::sqrt(squares / samples);
  fit.unexplained_torque = std::sqrt(unexplained / windows);
  const SlidingPoint scale = scale_of(total, free);
  const auto parameters = static_cast<double>(std::count(free.begin(), free.end(), true));
  const double variance = squares / std::max(1.0, samples - 2.0 * windows - parameters);  // of a residual
  SlidingMatrix covariance = variance * numerics::pseudo_inverse(scaled(scale, total.information));
  covariance = enlarged(covariance, jackknife(scale, total, by_window));
  if (by_stroke.size() >= min_independent_strokes)
    covariance = enlarged(covariance, jackknife(scale, total, by_stroke));
  fit.covariance = scaled(scale, covariance);
  return fit;
}

WindowSlopes slopes_of(const FittedWindow& fitted, const SlidingPoint& point) {
  const auto residuals = window_residuals(*fitted.record, *fitted.window);
  WindowSlopes slopes;
  slopes.residual.resize(residuals->num_residuals());
  slopes.by_point.resize(slopes.residual.size(), residuals->parameter_block_sizes().front());
  slopes.by_start.resize(slopes.residual.size(), 2);
  const std::array parameters{point.data(), fitted.start.data()};
  std::array jacobians{slopes.by_point.data(), slopes.by_start.data()};
  residuals->Evaluate(parameters.data(), slopes.residual.data(), jacobians.data());
  return slopes;
}

double stribeck_gain(const SlidingFit& fit, double velocity) {
  SlidingPoint point = fit.point;
  point[stribeck_excess] = 0.0;
  point[log_stribeck_velocity] = std::log(velocity);
  Score total;
  for (const FittedWindow& fitted : fit.windows) total += score_of(fitted, point);
  FreeParameters free = fit.free;
  free[stribeck_excess] = true;
  const SlidingPoint scale = scale_of(total, free);
  const SlidingPoint right = scale.cwiseProduct(total.score);
  const SlidingPoint step = numerics::least_squares(scaled(scale, total.information), right);
  return step[stribeck_excess] > 0.0 ? right.dot(step) : 0.0;
}

}  // namespace zerocount::sliding_identification
