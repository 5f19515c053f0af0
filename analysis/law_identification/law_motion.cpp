#include "analysis/law_identification/law_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <ceres/cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <oneapi/tbb/parallel_for.h>

#include "analysis/identification/record_motion.hpp"
#include "core/plant/plant.hpp"

namespace zerocount::law_identification {
namespace {

using identification::AngleObservation;
using identification::TestRecord;

/// Largest distance of a coordinate from its start: a factor of 1000.
constexpr double max_distance = 6.9;

/// Adds compliance (in units of the readings/(N m)) times the torque that acted until each reading.
void add_twist(const TestRecord& record, double compliance, double offset, Eigen::VectorXd& path) {
  const double delay = record.delay_fraction + offset;
  const auto last = static_cast<double>(record.torque.size() - 1);
  for (Eigen::Index k = 0; k < path.size(); ++k) {
    const double interval = std::ceil(static_cast<double>(k) - delay) - 1.0;
    if (interval < 0.0) continue;  // the torque is 0 before the first sample
    const motion::TorqueCourse& torque = record.torque[static_cast<std::size_t>(std::min(interval, last))];
    path[k] += compliance * motion::course_after(torque, record.sample_time).now;
  }
}

/// Ceres cost function of one parameter block: the coordinates, then the phases.
class LawResiduals : public ceres::CostFunction {
 public:
  LawResiduals(Records records, const LawModel& model, const Observations& observations, LawPoint start)
      : records_(records), model_(model), observations_(observations), start_(std::move(start)) {
    std::size_t rows = model.free.size();
    for (const std::vector<AngleObservation>& of_record : observations) rows += of_record.size();
    set_num_residuals(static_cast<int>(rows));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(model.free.size() + records.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Index dimension = dimension_of(model_);
    const LawPoint point = Eigen::Map<const Eigen::VectorXd>(parameters[0], dimension);
    if (!within_reach(point)) return false;
    const bool with_slopes = jacobians != nullptr && jacobians[0] != nullptr;
    Eigen::Map<RowMajor> slopes(with_slopes ? jacobians[0] : nullptr, with_slopes ? num_residuals() : 0,
                                dimension + static_cast<Eigen::Index>(records_.size()));
    slopes.setZero();
    Eigen::Index row = 0;
    for (std::size_t r = 0; r < records_.size(); ++r) {
      const LawMotion motion = with_slopes ? law_motion(records_[r], model_, point)
                                           : LawMotion{law_path(records_[r], model_, point), {}};
      if (!motion.path.allFinite() || !motion.sensitivity.allFinite()) return false;
      const Eigen::Index phase = dimension + static_cast<Eigen::Index>(r);
      for (const AngleObservation& observation : observations_[r]) {
        const double scale = 1.0 / std::sqrt(observation.variance);
        const double modelled = mean_over(observation, motion.path).value() + parameters[0][phase];
        residuals[row] = scale * (modelled - observation.position);
        if (with_slopes) {
          slopes.row(row).head(dimension) = scale * mean_over(observation, motion.sensitivity);
          slopes(row, phase) = scale;
        }
        ++row;
      }
    }
    for (Eigen::Index j = 0; j < dimension; ++j, ++row) {
      const double scale = model_.free[static_cast<std::size_t>(j)] ? 1.0 / prior_spread : 0.0;
      residuals[row] = scale * (point[j] - start_[j]);
      if (with_slopes) slopes(row, j) = scale;
    }
    return true;
  }

 private:
  bool within_reach(const LawPoint& point) const {
    const Eigen::Index offset = point.size() - 1;
    return can_be_sampled(records_, model_, point) &&
           (point - start_).head(offset).cwiseAbs().maxCoeff() <= max_distance &&
           std::abs(point[offset]) <= identification::max_time_offset;
  }

  Records records_;
  const LawModel& model_;
  const Observations& observations_;
  LawPoint start_;
};

}  // namespace

bool can_be_sampled(Records records, const LawModel& model, const LawPoint& point) {
  constexpr double max_rate = 20.0;  // in 1/sampling interval
  double interval = std::numeric_limits<double>::infinity();
  for (const TestRecord& record : records) interval = std::min(interval, record.sample_time);
  return fastest_rate(model.parameters_at(point)) * interval <= max_rate;
}

Eigen::VectorXd law_path(const TestRecord& record, const LawModel& model, const LawPoint& point) {
  const LawParameters parameters = model.parameters_at(point);
  constexpr double rest = 1e-6;  // of a reading
  plant::Plant plant(parameters.plant, parameters.friction, record.start,
                     {identification::motion_tolerance * record.unit, rest * record.unit});
  const double offset = point[point.size() - 1];
  Eigen::VectorXd path = identification::sampled_path(record, std::move(plant), offset).angle;
  if (model.series_compliance) add_twist(record, model.series_compliance(point) / record.unit, offset, path);
  return path;
}

LawMotion law_motion(const TestRecord& record, const LawModel& model, const LawPoint& point) {
  LawMotion motion{law_path(record, model, point), {}};
  motion.sensitivity.setZero(motion.path.size(), dimension_of(model));
  oneapi::tbb::parallel_for(Eigen::Index{0}, dimension_of(model), [&](Eigen::Index j) {
    if (!model.free[static_cast<std::size_t>(j)]) return;
    LawPoint moved = point;
    moved[j] += identification::difference_step;
    motion.sensitivity.col(j) = (law_path(record, model, moved) - motion.path) / (moved[j] - point[j]);
  });
  return motion;
}

Observations all_readings(Records records) {
  constexpr double variance = 1.0 / 12.0;
  Observations observations;
  for (const TestRecord& record : records) {
    std::vector<AngleObservation>& of_record = observations.emplace_back();
    for (std::size_t k = 0; k < sample_count(record); ++k) {
      if (is_excluded(record, k)) continue;
      of_record.push_back({k, k, record.reading[k] + middle_of_reading(record), variance});
    }
  }
  return observations;
}

LawMinimum minimise(Records records, const LawModel& model, const Observations& observations,
                    const LawUnknowns& start, int steps) {
  const Eigen::Index dimension = dimension_of(model);
  Eigen::VectorXd unknowns(dimension + start.phase.size());
  unknowns << start.point, start.phase;
  ceres::Problem problem;
  problem.AddResidualBlock(new LawResiduals(records, model, observations, start.point), nullptr,
                           unknowns.data());
  std::vector<int> kept;
  for (std::size_t j = 0; j < model.free.size(); ++j) {
    if (!model.free[j]) kept.push_back(static_cast<int>(j));
  }
  if (!kept.empty()) {
    problem.SetManifold(unknowns.data(), new ceres::SubsetManifold(static_cast<int>(unknowns.size()), kept));
  }
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = steps;
  options.max_num_consecutive_invalid_steps = steps;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return {start, std::numeric_limits<double>::infinity(), false};
  return {{unknowns.head(dimension), unknowns.tail(start.phase.size())},
          2.0 * summary.final_cost,
          summary.termination_type == ceres::CONVERGENCE};
}

}  // namespace zerocount::law_identification
