#include "analysis/sliding_identification/sliding_fit.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <ceres/cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sliding_identification {
namespace {

using Covariance = Eigen::Matrix<double, sliding_dimension, sliding_dimension>;

/// A window of a record, and its initial state: position and velocity.
struct FittedWindow {
  const SlidingRecord* record;
  const Window* window;
  std::array<double, 2> start;
};

/// Residuals of a window in units of the readings' resolution.
class WindowResiduals : public ceres::CostFunction {
 public:
  explicit WindowResiduals(const FittedWindow& fitted) : fitted_(fitted) {
    set_num_residuals(static_cast<int>(samples_of(*fitted.window)));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(sliding_dimension));
    mutable_parameter_block_sizes()->push_back(2);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const SlidingPoint point = Eigen::Map<const SlidingPoint>(parameters[0]);
    const SlidingRecord& record = *fitted_.record;
    const WindowMotion motion =
        window_motion(record, *fitted_.window, point, parameters[1][0], parameters[1][1]);
    if (!motion.position.allFinite()) return false;
    const double scale = 1.0 / record.resolution;
    const Eigen::Index samples = motion.position.size();
    for (Eigen::Index i = 0; i < samples; ++i) {
      residuals[i] =
          scale * (motion.position[i] - record.position[fitted_.window->first + static_cast<std::size_t>(i)]);
    }
    if (jacobians == nullptr) return true;
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    if (jacobians[0] != nullptr) {
      Eigen::Map<Rows>(jacobians[0], samples, sliding_dimension) =
          scale * motion.slopes.leftCols<sliding_dimension>();
    }
    if (jacobians[1] != nullptr)
      Eigen::Map<Rows>(jacobians[1], samples, 2) = scale * motion.slopes.rightCols<2>();
    return true;
  }

 private:
  const FittedWindow& fitted_;
};

std::vector<FittedWindow> windows_of(std::span<const SlidingRecord> records) {
  std::vector<FittedWindow> windows;
  for (const SlidingRecord& record : records) {
    for (const Window& window : record.windows) {
      windows.push_back({&record, &window, {record.position[window.first], record.velocity[window.first]}});
    }
  }
  return windows;
}

std::vector<int> known_of(const FreeParameters& free) {
  std::vector<int> known;
  for (std::size_t j = 0; j < sliding_dimension; ++j) {
    if (!free[j]) known.push_back(static_cast<int>(j));
  }
  return known;
}

double solve(std::vector<FittedWindow>& windows, SlidingPoint& point, const FreeParameters& free) {
  ceres::Problem problem;
  for (FittedWindow& window : windows) {
    problem.AddResidualBlock(new WindowResiduals(window), nullptr, point.data(), window.start.data());
  }
  if (const std::vector<int> known = known_of(free); !known.empty()) {
    problem.SetManifold(point.data(), new ceres::SubsetManifold(static_cast<int>(sliding_dimension), known));
  }
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 60;
  options.initial_trust_region_radius = 1e12;  // Gauss–Newton steps, damped where they fail
  options.function_tolerance = 1e-9;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: the simulated motion cannot be fitted to the positions; expected torque and "
                    "position in the units that --column gives",
                    windows.front().record->name));
  }
  return 2.0 * summary.final_cost;
}

/// Columns of a matrix beyond what the columns of another explain.
Eigen::MatrixXd beyond(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& local) {
  return columns - numerics::product(local, numerics::least_squares(local, columns));
}

/// Contribution of one window to the estimating equations, its initial state eliminated.
struct WindowScore {
  std::pair<const SlidingRecord*, std::size_t> stroke;
  Covariance information;
  SlidingPoint score;
  double unexplained_torque;
};

WindowScore score_of(const FittedWindow& fitted, const SlidingPoint& point) {
  const SlidingRecord& record = *fitted.record;
  const WindowMotion motion = window_motion(record, *fitted.window, point, fitted.start[0], fitted.start[1]);
  const Eigen::Index samples = motion.position.size();
  Eigen::VectorXd residual(samples);
  Eigen::VectorXd parabola(samples);  // the path under a torque that is 1 too large
  for (Eigen::Index i = 0; i < samples; ++i) {
    const std::size_t k = fitted.window->first + static_cast<std::size_t>(i);
    residual[i] = (record.position[k] - motion.position[i]) / record.resolution;
  }
  const Eigen::MatrixXd local = motion.slopes.rightCols<2>() / record.resolution;
  const Eigen::MatrixXd slopes =
      beyond(motion.slopes.leftCols<sliding_dimension>() / record.resolution, local);
  parabola = -slopes.col(offset_torque);
  return {{fitted.record, fitted.window->stroke},
          numerics::transposed_product(slopes, slopes),
          slopes.transpose() * residual,
          parabola.dot(residual) / std::max(parabola.squaredNorm(), std::numeric_limits<double>::min())};
}

/// Information and score of a cluster: of a window, or of the windows of a stroke.
struct ClusterScore {
  Covariance information{Covariance::Zero()};
  SlidingPoint score{SlidingPoint::Zero()};
};

/// The free parameters, each times the root of its information, which makes them comparable.
struct ScaledParameters {
  std::vector<Eigen::Index> index;
  Eigen::VectorXd scale;

  ScaledParameters(const Covariance& information, const FreeParameters& free) {
    for (std::size_t j = 0; j < sliding_dimension; ++j) {
      if (free[j]) index.push_back(static_cast<Eigen::Index>(j));
    }
    scale.resize(static_cast<Eigen::Index>(index.size()));
    for (Eigen::Index i = 0; i < scale.size(); ++i) {
      const double own = information(index[static_cast<std::size_t>(i)], index[static_cast<std::size_t>(i)]);
      scale[i] = 1.0 / std::sqrt(std::max(own, std::numeric_limits<double>::min()));
    }
  }

  Eigen::MatrixXd scaled(const Covariance& matrix) const {
    return scale.asDiagonal() * Eigen::MatrixXd(matrix(index, index)) * scale.asDiagonal();
  }
  Eigen::VectorXd scaled(const SlidingPoint& vector) const {
    return scale.cwiseProduct(Eigen::VectorXd(vector(index)));
  }
  Covariance restored(const Eigen::MatrixXd& matrix) const {
    Covariance all = Covariance::Zero();
    all(index, index) = scale.asDiagonal() * matrix * scale.asDiagonal();
    return all;
  }
};

/// Variance of the fits without one cluster each: (G − 1)/G·Σδ_g·δ_gᵀ with δ_g = (B − B_g)⁻¹·s_g.
Eigen::MatrixXd jackknife(const ScaledParameters& parameters, const Covariance& information,
                          const std::vector<ClusterScore>& clusters) {
  const auto groups = static_cast<double>(clusters.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(parameters.scale.size(), parameters.scale.size());
  for (const ClusterScore& cluster : clusters) {
    const Eigen::MatrixXd others = parameters.scaled(Covariance(information - cluster.information));
    const Eigen::VectorXd change = numerics::least_squares(others, parameters.scaled(cluster.score));
    sum += change * change.transpose();
  }
  return (groups - 1.0) / groups * sum;
}

/// Enlarges a covariance to the larger variance of each parameter; correlations stay.
Eigen::MatrixXd enlarged(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& other) {
  const Eigen::VectorXd factor =
      (other.diagonal().cwiseQuotient(covariance.diagonal().cwiseMax(std::numeric_limits<double>::min())))
          .cwiseMax(1.0)
          .cwiseSqrt();
  return factor.asDiagonal() * covariance * factor.asDiagonal();
}

}  // namespace

SlidingPoint starting_point(std::span<const SlidingRecord> records, bool both_directions) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(4, 4);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(4);
  for (const SlidingRecord& record : records) {
    const std::size_t h = record.smoothing;
    for (const Window& window : record.windows) {
      for (std::size_t k = window.first; k <= window.last; ++k) {
        if (k < 2 * h || k + 2 * h >= record.time.size()) continue;
        const double acceleration =
            (record.velocity[k + h] - record.velocity[k - h]) / (record.time[k + h] - record.time[k - h]);
        double torque = 0.0;  // mean over the samples that the acceleration is from
        for (std::size_t i = k - 2 * h; i < k + 2 * h; ++i) torque += record.torque[i].now;
        const Eigen::Vector4d row(acceleration, window.direction, record.velocity[k],
                                  both_directions ? 1.0 : 0.0);
        normal += row * row.transpose();
        right += row * (torque / static_cast<double>(4 * h));
      }
    }
  }
  const Eigen::VectorXd found = numerics::least_squares(normal, right);
  if (!(found[0] > 0.0)) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: the axis accelerates against the torque; is one of them of the wrong sign? "
                    "--column turns it with the factor -1",
                    records.front().name));
  }
  SlidingPoint point;
  point << std::log(found[0]), found[1], found[2], found[3], 0.0, 0.0;
  return point;
}

SlidingFit fit_sliding(std::span<const SlidingRecord> records, const SlidingPoint& start,
                       const FreeParameters& free) {
  std::vector<FittedWindow> windows = windows_of(records);
  SlidingFit fit;
  fit.point = start;
  fit.free = free;
  fit.squares = solve(windows, fit.point, free);
  Covariance information = Covariance::Zero();
  std::vector<ClusterScore> by_window;
  by_window.reserve(windows.size());
  fit.starts.reserve(windows.size());
  std::map<std::pair<const SlidingRecord*, std::size_t>, ClusterScore> strokes;
  double unexplained = 0.0;
  for (const FittedWindow& window : windows) {
    const WindowScore score = score_of(window, fit.point);
    information += score.information;
    by_window.push_back({score.information, score.score});
    ClusterScore& stroke = strokes[score.stroke];
    stroke.information += score.information;
    stroke.score += score.score;
    unexplained += score.unexplained_torque * score.unexplained_torque;
    fit.samples += samples_of(*window.window);
    fit.starts.push_back(window.start);
  }
  std::vector<ClusterScore> by_stroke;
  by_stroke.reserve(strokes.size());
  for (const auto& [stroke, score] : strokes) by_stroke.push_back(score);
  fit.windows = windows.size();
  fit.strokes = by_stroke.size();
  fit.unexplained_torque = std::sqrt(unexplained / static_cast<double>(windows.size()));
  const ScaledParameters parameters(information, free);
  const double freedom =
      std::max(1.0, static_cast<double>(fit.samples) - 2.0 * static_cast<double>(fit.windows) -
                        static_cast<double>(parameters.index.size()));
  const Eigen::MatrixXd independent =
      fit.squares / freedom * numerics::pseudo_inverse(parameters.scaled(information));
  Eigen::MatrixXd covariance = enlarged(independent, jackknife(parameters, information, by_window));
  constexpr std::size_t min_strokes = 12;  // with fewer the variance between strokes is known too badly
  if (fit.strokes >= min_strokes) {
    covariance = enlarged(covariance, jackknife(parameters, information, by_stroke));
  }
  fit.covariance = parameters.restored(covariance);
  return fit;
}

double stribeck_gain(std::span<const SlidingRecord> records, const SlidingFit& fit, double velocity) {
  SlidingPoint point = fit.point;
  point[stribeck_excess] = 0.0;
  point[log_stribeck_velocity] = std::log(velocity);
  std::vector<FittedWindow> windows = windows_of(records);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(sliding_dimension, sliding_dimension);
  Eigen::VectorXd total = Eigen::VectorXd::Zero(sliding_dimension);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    windows[i].start = fit.starts[i];
    const WindowScore score = score_of(windows[i], point);
    information += score.information;
    total += score.score;
  }
  for (Eigen::Index j = 0; j < total.size(); ++j) {
    if (fit.free[static_cast<std::size_t>(j)] || j == static_cast<Eigen::Index>(stribeck_excess)) continue;
    information.row(j).setZero();
    information.col(j).setZero();
    total[j] = 0.0;
  }
  const Eigen::VectorXd scale =
      information.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt();
  const Eigen::MatrixXd scaled =
      scale.cwiseInverse().asDiagonal() * information * scale.cwiseInverse().asDiagonal();
  const Eigen::VectorXd right = total.cwiseQuotient(scale);
  const Eigen::VectorXd step = numerics::least_squares(scaled, right);
  return step[stribeck_excess] > 0.0 ? right.dot(step) : 0.0;
}

}  // namespace zerocount::sliding_identification
