#include "analysis/record_fit/reading_replicates.hpp"

#include <cmath>

#include "analysis/parallel/parallel.hpp"
#include "core/numerics/dense.hpp"
#include "core/random/random_numbers.hpp"
#include "core/random/variates.hpp"

namespace zerocount::record_fit {
ReplicateNoise::ReplicateNoise(std::size_t replicate) : replicate_(replicate) {}

double ReplicateNoise::next() {
  // An arbitrary but constant key, so that results are reproducible.
  constexpr random::RandomStream stream{{0x1d3a71f1U, 0xca710bb5U}, 0};
  return random::standard_normal(random::random_bits(stream, replicate_, draw_++));
}

Eigen::VectorXd ReplicateNoise::next(Eigen::Index size) {
  return Eigen::VectorXd::NullaryExpr(size, [this] { return next(); });
}

Eigen::VectorXd read_path(const TestRecord& record, const Eigen::VectorXd& path, double noise,
                          ReplicateNoise& random) {
  Eigen::VectorXd readings = path;
  if (noise > 0.0) readings += noise * random.next(path.size());
  if (record.counted) readings = readings.array().floor();
  return readings;
}

ResidualStatistics residual_statistics(const std::vector<double>& residuals) {
  ResidualStatistics statistics;
  statistics.observations = residuals.size();
  for (const double residual : residuals) statistics.squares += residual * residual;
  if (residuals.empty()) return statistics;
  statistics.runs = 1.0;
  for (std::size_t i = 1; i < residuals.size(); ++i) {
    if (std::signbit(residuals[i]) != std::signbit(residuals[i - 1])) statistics.runs += 1.0;
  }
  if (statistics.squares == 0.0) return statistics;
  for (std::size_t lag = 1; lag < residuals.size() / 4; ++lag) {
    double product = 0.0;
    for (std::size_t i = lag; i < residuals.size(); ++i) product += residuals[i] * residuals[i - lag];
    if (product <= 0.0) break;
    statistics.correlation_length += 2.0 * product / statistics.squares;
  }
  return statistics;
}

namespace {

/// As residuals_of(), with other paths than the model's.
std::vector<double> residuals_along(const FittedModel& model, const std::vector<Eigen::VectorXd>& paths,
                                    const Observations& observations, const Eigen::VectorXd& step) {
  std::vector<double> residuals;
  for (std::size_t r = 0; r < observations.size(); ++r) {
    const Eigen::MatrixXd& sensitivity = model.motions[r].sensitivity;
    for (const AngleObservation& observation : observations[r]) {
      double modelled = mean_over(observation, paths[r]).value();
      if (step.size() > 0) {
        modelled += (mean_over(observation, sensitivity) * step.head(sensitivity.cols())).value() +
                    step[sensitivity.cols() + static_cast<Eigen::Index>(r)];
      }
      residuals.push_back((observation.position - modelled) / std::sqrt(observation.variance));
    }
  }
  return residuals;
}

}  // namespace

std::vector<double> residuals_of(const FittedModel& model, const Observations& observations,
                                 const Eigen::VectorXd& step) {
  std::vector<Eigen::VectorXd> paths;
  for (const RecordMotion& motion : model.motions) paths.push_back(motion.path);
  return residuals_along(model, paths, observations, step);
}

ReadingReplicates replicate_readings(Records records, const FittedModel& model, const FitSetting& setting,
                                     const std::vector<double>& noise, std::size_t replicates,
                                     std::size_t first) {
  const Observations observations = observations_along(records, model, noise);
  const Eigen::MatrixXd matrix = normal_equations(model, observations, setting).matrix;
  const Eigen::MatrixXd root = numerics::cholesky_factor(matrix);

  const Eigen::Index dimension = dimension_of(setting.model);
  ReadingReplicates result;
  result.errors.resize(static_cast<Eigen::Index>(replicates), matrix.rows());
  result.residuals.resize(replicates);
  parallel::for_each_index(replicates, [&](std::size_t i) {
    ReplicateNoise random(first + i);
    // The textbook covariance is matrix⁻¹. With matrix = L·Lᵀ, L⁻ᵀz has this covariance.
    const Eigen::VectorXd away =
        truth_spread * numerics::solve_transposed_factor(root, random.next(matrix.rows()));
    NormalEquationsSum sum(records.size(), setting);
    Observations read(records.size());
    std::vector<Eigen::VectorXd> paths;
    for (std::size_t r = 0; r < records.size(); ++r) {
      const RecordMotion& motion = model.motions[r];
      Eigen::VectorXd& path = paths.emplace_back(motion.path);
      path.noalias() += motion.sensitivity * away.head(dimension);
      path.array() += away[dimension + static_cast<Eigen::Index>(r)];
      const Eigen::VectorXd readings = read_path(records[r], path, noise[r], random);
      observe(records[r], path, readings, noise[r], read[r]);
      sum.add(r, read[r], path, motion.sensitivity);
    }
    NormalEquations equations = sum.with_prior(setting.prior);
    // The error of the prior is drawn too: coordinates that only the prior determines keep its uncertainty.
    for (Eigen::Index j = 0; j < dimension; ++j) {
      if (setting.free[static_cast<std::size_t>(j)])
        equations.gradient[j] += random.next() / setting.prior_spread;
    }
    const Eigen::VectorXd error = numerics::solve_positive_definite(equations.matrix, equations.gradient);
    result.errors.row(static_cast<Eigen::Index>(i)) = error;
    result.residuals[i] = residual_statistics(residuals_along(model, paths, read, error));
  });
  return result;
}

}  // namespace zerocount::record_fit
