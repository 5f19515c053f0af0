#include "analysis/law_identification/law_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include "core/failure/failure.hpp"
#include "core/friction/law.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::law_identification {
namespace {

using identification::AngleObservation;
using identification::TestRecord;

/// Lower limit of the noise of readings that are not counts: smaller residuals are rounding errors.
constexpr double min_noise = 1e-6;

double root_mean_square(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
}

/// Measured − modelled angle of every reading that is not masked.
std::vector<double> reading_residuals(const TestRecord& record, const Eigen::VectorXd& path) {
  std::vector<double> residuals;
  for (std::size_t k = 0; k < sample_count(record); ++k) {
    if (is_excluded(record, k)) continue;
    residuals.push_back(record.reading[k] + middle_of_reading(record) - path[static_cast<Eigen::Index>(k)]);
  }
  return residuals;
}

/// A starting point with its best phases.
LawMinimum evaluated(Records records, const LawModel& model, const LawPoint& point) {
  LawMinimum start{{point, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(records.size()))}, 0.0, false};
  if (!can_be_sampled(records, model, point)) {
    start.squares = std::numeric_limits<double>::infinity();
    return start;
  }
  for (std::size_t r = 0; r < records.size(); ++r) {
    const std::vector<double> left = reading_residuals(records[r], law_path(records[r], model, point));
    const Eigen::Map<const Eigen::ArrayXd> values(left.data(), static_cast<Eigen::Index>(left.size()));
    const double mean = values.mean();
    start.at.phase[static_cast<Eigen::Index>(r)] = mean;
    start.squares += (values - mean).square().sum();
  }
  if (!std::isfinite(start.squares)) start.squares = std::numeric_limits<double>::infinity();
  return start;
}

/// The `most` smallest ones, in order.
std::vector<LawMinimum> smallest(std::vector<LawMinimum> minima, std::size_t most) {
  std::stable_sort(minima.begin(), minima.end(), [](const LawMinimum& one, const LawMinimum& other) {
    return one.squares < other.squares;
  });
  minima.resize(std::min(minima.size(), most));
  return minima;
}

/// Steps of a fit that is tried, and of one that is continued to its end.
constexpr int first_steps = 12;
constexpr int last_steps = 60;

/// True if the readings are counts and the residuals are about those of their rounding.
bool is_explained(Records records, const LawMinimum& minimum, const Observations& readings) {
  if (!std::all_of(records.begin(), records.end(), [](const TestRecord& record) { return record.counted; })) {
    return false;
  }
  constexpr double tolerated = 1.2;
  std::size_t count = 0;
  for (const std::vector<AngleObservation>& of_record : readings) count += of_record.size();
  return minimum.squares < tolerated * static_cast<double>(count);
}

/// The minimum, or a smaller one that is found from its neighbours.
LawMinimum with_neighbours(Records records, const LawModel& model, const Observations& readings,
                           LawMinimum best) {
  if (!model.neighbours) return best;
  constexpr int rounds = 4;
  constexpr double better = 0.98;
  for (int round = 0; round < rounds && !is_explained(records, best, readings); ++round) {
    std::vector<LawMinimum> tried;
    for (const LawPoint& other : model.neighbours(best.at.point)) {
      const LawMinimum start = evaluated(records, model, other);
      if (std::isfinite(start.squares))
        tried.push_back(minimise(records, model, readings, start.at, first_steps));
    }
    tried = smallest(std::move(tried), 1);
    if (tried.empty() || !(tried.front().squares < better * best.squares)) break;
    best = minimise(records, model, readings, tried.front().at, last_steps);
  }
  return best;
}

/// The fit to all readings. The time offset is left free in the last steps only: far from a minimum it would
/// make up for a wrong inertia.
LawMinimum fit_all_readings(Records records, const LawModel& model) {
  constexpr std::size_t tried = 6;
  constexpr std::size_t continued = 3;
  LawModel undelayed = model;
  undelayed.free.back() = false;
  std::vector<LawMinimum> starts(model.starts.size());
  oneapi::tbb::parallel_for(std::size_t{0}, starts.size(),
                            [&](std::size_t i) { starts[i] = evaluated(records, model, model.starts[i]); });
  const Observations readings = all_readings(records);
  std::vector<LawMinimum> minima;
  for (const LawMinimum& start : smallest(std::move(starts), tried)) {
    if (!std::isfinite(start.squares)) continue;
    minima.push_back(minimise(records, undelayed, readings, start.at, first_steps));
  }
  minima = smallest(std::move(minima), continued);
  if (minima.empty() || !std::isfinite(minima.front().squares)) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: no starting point of the friction model {} can be simulated along the records, "
                    "the rotor is too fast for their sampling; are the units right?",
                    records.front().name, friction::traits_of(model.law).word));
  }
  constexpr double hopeless = 4.0;
  const double least = minima.front().squares;
  std::erase_if(minima, [&](const LawMinimum& one) { return one.squares > hopeless * least; });
  for (LawMinimum& one : minima) one = minimise(records, undelayed, readings, one.at, last_steps);
  const LawMinimum found =
      with_neighbours(records, undelayed, readings, smallest(std::move(minima), 1).front());
  const LawMinimum delayed = minimise(records, model, readings, found.at, last_steps);
  return std::isfinite(delayed.squares) ? delayed : found;
}

/// Computes the motions and the observations at a point.
void observe_at(Records records, const LawModel& model, const LawUnknowns& at, LawFit& fit) {
  fit.at = at;
  fit.motions.clear();
  fit.noise.clear();
  fit.observations.assign(records.size(), {});
  for (std::size_t r = 0; r < records.size(); ++r) {
    LawMotion motion = law_motion(records[r], model, at.point);
    motion.path.array() += at.phase[static_cast<Eigen::Index>(r)];
    const Eigen::VectorXd readings = readings_of(records[r]);
    fit.noise.push_back(
        records[r].counted
            ? identification::counting_noise(records[r], motion.path, readings)
            : std::max(root_mean_square(reading_residuals(records[r], motion.path)), min_noise));
    identification::observe(records[r], motion.path, readings, fit.noise[r], fit.observations[r]);
    fit.motions.push_back(std::move(motion));
  }
}

/// Normal equations of the linearised model, by a sum over records.
struct LawNormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;

  LawNormalEquations(const LawModel& model, std::size_t records)
      : matrix(Eigen::MatrixXd::Zero(dimension_of(model) + static_cast<Eigen::Index>(records),
                                     dimension_of(model) + static_cast<Eigen::Index>(records))),
        gradient(Eigen::VectorXd::Zero(matrix.rows())) {
    for (Eigen::Index j = 0; j < dimension_of(model); ++j) {
      // A coordinate that is not free keeps its value.
      matrix(j, j) = model.free[static_cast<std::size_t>(j)] ? 1.0 / (prior_spread * prior_spread) : 1.0;
    }
  }

  void add(std::size_t record, const std::vector<AngleObservation>& observations, const Eigen::VectorXd& path,
           const Eigen::MatrixXd& sensitivity) {
    const Eigen::Index dimension = sensitivity.cols();
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(matrix.rows());
    slope[dimension + static_cast<Eigen::Index>(record)] = 1.0;
    for (const AngleObservation& observation : observations) {
      slope.head(dimension) = mean_over(observation, sensitivity);
      const double weight = 1.0 / observation.variance;
      matrix.noalias() += (weight * slope) * slope.transpose();
      gradient += weight * (observation.position - mean_over(observation, path).value()) * slope;
    }
  }
};

/// Residuals over their standard deviations, after a step in the linearised model.
std::vector<double> residuals_after(const std::vector<LawMotion>& motions,
                                    const std::vector<Eigen::VectorXd>& paths,
                                    const Observations& observations, const Eigen::VectorXd& step) {
  std::vector<double> residuals;
  for (std::size_t r = 0; r < observations.size(); ++r) {
    const Eigen::MatrixXd& sensitivity = motions[r].sensitivity;
    for (const AngleObservation& observation : observations[r]) {
      const double modelled =
          mean_over(observation, paths[r]).value() +
          mean_over(observation, sensitivity).dot(step.head(sensitivity.cols()).transpose()) +
          step[sensitivity.cols() + static_cast<Eigen::Index>(r)];
      residuals.push_back((observation.position - modelled) / std::sqrt(observation.variance));
    }
  }
  return residuals;
}

std::vector<Eigen::VectorXd> paths_of(const std::vector<LawMotion>& motions) {
  std::vector<Eigen::VectorXd> paths(motions.size());
  std::transform(motions.begin(), motions.end(), paths.begin(),
                 [](const LawMotion& motion) { return motion.path; });
  return paths;
}

}  // namespace

LawFit fit_law(Records records, const LawModel& model) {
  const LawMinimum rough = fit_all_readings(records, model);
  LawFit fit;
  fit.converged = rough.converged;
  observe_at(records, model, rough.at, fit);
  for (std::size_t r = 0; r < records.size(); ++r) {
    fit.residuals.push_back(reading_residuals(records[r], fit.motions[r].path));
  }
  constexpr int rounds = 3;
  constexpr int steps = 15;
  for (int round = 0; round < rounds; ++round) {
    const LawMinimum finer = minimise(records, model, fit.observations, fit.at, steps);
    if (!std::isfinite(finer.squares)) break;
    observe_at(records, model, finer.at, fit);
  }
  return fit;
}

LawErrors errors_of(Records records, const LawModel& model, const LawFit& fit) {
  constexpr std::size_t replicates = 300;
  LawNormalEquations textbook(model, records.size());
  for (std::size_t r = 0; r < records.size(); ++r) {
    textbook.add(r, fit.observations[r], fit.motions[r].path, fit.motions[r].sensitivity);
  }
  const Eigen::MatrixXd root = numerics::cholesky_factor(textbook.matrix);
  LawErrors result;
  result.errors.resize(replicates, dimension_of(model));
  std::vector<identification::ResidualStatistics> residuals(replicates);
  oneapi::tbb::parallel_for(std::size_t{0}, replicates, [&](std::size_t i) {
    identification::ReplicateNoise random(i);
    const Eigen::VectorXd away = identification::truth_spread *
                                 numerics::solve_transposed_factor(root, random.next(textbook.matrix.rows()));
    LawNormalEquations equations(model, records.size());
    Observations read(records.size());
    std::vector<Eigen::VectorXd> paths = paths_of(fit.motions);
    for (std::size_t r = 0; r < records.size(); ++r) {
      const Eigen::MatrixXd& sensitivity = fit.motions[r].sensitivity;
      paths[r] += sensitivity * away.head(sensitivity.cols());
      paths[r].array() += away[sensitivity.cols() + static_cast<Eigen::Index>(r)];
      const Eigen::VectorXd readings = read_path(records[r], paths[r], fit.noise[r], random);
      identification::observe(records[r], paths[r], readings, fit.noise[r], read[r]);
      equations.add(r, read[r], paths[r], sensitivity);
    }
    for (Eigen::Index j = 0; j < dimension_of(model); ++j) {
      if (model.free[static_cast<std::size_t>(j)]) equations.gradient[j] += random.next() / prior_spread;
    }
    const Eigen::VectorXd error = numerics::solve_positive_definite(equations.matrix, equations.gradient);
    result.errors.row(static_cast<Eigen::Index>(i)) = error.head(dimension_of(model));
    residuals[i] = identification::residual_statistics(residuals_after(fit.motions, paths, read, error));
  });
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(textbook.matrix.rows());
  result.checks =
      identification::check_residuals(identification::residual_statistics(residuals_after(
                                          fit.motions, paths_of(fit.motions), fit.observations, none)),
                                      residuals);
  return result;
}

}  // namespace zerocount::law_identification
