#include "analysis/identification/joint_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <ceres/cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <glog/logging.h>

namespace zerocount::identification {
namespace {

/// Maximum distance (of logarithms) of a coordinate from the prior: a factor of 100. Far beyond, simulations
/// become very slow.
constexpr double max_distance = 4.6;
/// Maximum rate of a rotor's oscillation or damping that a fit may try, in 1/sampling interval.
constexpr double max_rate = 20.0;
/// Maximum distance below the prior for the creep limit: it may vanish, which does not slow the simulation.
constexpr double max_creep_decrease = 14.0;
constexpr double least_exponent = 0.2;
constexpr double max_exponent = 20.0;

/// Turns off the log that Ceres writes to standard error through glog; its summary has the same information.
/// Fatal errors are still printed.
void quieten_log() {
  [[maybe_unused]] static const bool quiet = [] {
    FLAGS_minloglevel = google::GLOG_FATAL;
    return true;
  }();
}

/// The max_rate rate (1/s) of the rotor, which limits the step of a simulation.
double rate_of(const ContactPoint& point, double creep_torque) {
  const ContactParameters contact = contact_at(point, creep_torque);
  const double oscillation = std::sqrt((contact.friction.k1 + contact.friction.k2) / contact.plant.inertia);
  return std::max(oscillation, contact.plant.presliding_damping / contact.plant.inertia);
}

/// Ceres cost function: the residuals of all records and of the prior. Parameter blocks: the contact's
/// coordinates and the offsets.
class JointResiduals : public ceres::CostFunction {
 public:
  JointResiduals(std::span<const TestRecord> records, const Observations& observations,
                 const FitSetting& setting)
      : records_(records), observations_(observations), setting_(setting) {
    std::size_t residuals = coordinate_count;
    for (const std::vector<AngleObservation>& of_record : observations) residuals += of_record.size();
    set_num_residuals(static_cast<int>(residuals));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(coordinate_count));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(records.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const ContactPoint contact = Eigen::Map<const ContactPoint>(parameters[0]);
    if (!within_reach(contact)) return false;
    double* const by_contact = jacobians != nullptr ? jacobians[0] : nullptr;
    double* const by_offset = jacobians != nullptr ? jacobians[1] : nullptr;
    FreeCoordinates none{};
    int row = 0;
    for (std::size_t r = 0; r < records_.size(); ++r) {
      const RecordMotion motion = motion_with_sensitivity(records_[r], contact, setting_.creep_torque,
                                                          by_contact != nullptr ? setting_.free : none);
      if (!motion.path.allFinite() || !motion.sensitivity.allFinite()) return false;
      for (const AngleObservation& observation : observations_[r]) {
        const double scale = 1.0 / std::sqrt(observation.variance);
        residuals[row] =
            scale * (mean_over(observation, motion.path).value() + parameters[1][r] - observation.position);
        if (by_contact != nullptr) {
          Eigen::Map<PathSlope>(by_contact + static_cast<std::size_t>(row) * coordinate_count) =
              scale * mean_over(observation, motion.sensitivity);
        }
        if (by_offset != nullptr) {
          double* const slopes = by_offset + static_cast<std::size_t>(row) * records_.size();
          for (std::size_t i = 0; i < records_.size(); ++i) slopes[i] = i == r ? scale : 0.0;
        }
        ++row;
      }
    }
    add_prior(contact, row, residuals, by_contact, by_offset);
    return true;
  }

 private:
  bool within_reach(const ContactPoint& contact) const {
    double interval = 0.0;  // the longest
    for (const TestRecord& record : records_) interval = std::max(interval, record.sample_time);
    const double limit = std::max(max_rate, 2.0 * rate_of(setting_.prior, setting_.creep_torque) * interval);
    if (rate_of(contact, setting_.creep_torque) * interval > limit) return false;
    for (std::size_t j = 0; j < creep_exponent; ++j) {
      const double away = contact[j] - setting_.prior[j];
      if (!(away <= max_distance && away >= (j == log_limit ? -max_creep_decrease : -max_distance)))
        return false;
    }
    return contact[creep_exponent] >= least_exponent && contact[creep_exponent] <= max_exponent &&
           std::abs(contact[time_offset]) <= max_time_offset;
  }

  void add_prior(const ContactPoint& contact, int row, double* residuals, double* by_contact,
                 double* by_offset) const {
    for (std::size_t i = 0; i < coordinate_count; ++i) {
      const auto at = static_cast<std::size_t>(row) + i;
      const double scale = setting_.free[i] ? 1.0 / setting_.prior_spread : 0.0;
      residuals[at] = scale * (contact[i] - setting_.prior[i]);
      if (by_contact != nullptr) {
        for (std::size_t j = 0; j < coordinate_count; ++j) {
          by_contact[at * coordinate_count + j] = i == j ? scale : 0.0;
        }
      }
      if (by_offset == nullptr) continue;
      for (std::size_t r = 0; r < records_.size(); ++r) by_offset[at * records_.size() + r] = 0.0;
    }
  }

  std::span<const TestRecord> records_;
  const Observations& observations_;
  const FitSetting& setting_;
};

void keep_known(ceres::Problem& problem, double* contact, const FreeCoordinates& free) {
  std::vector<int> known;
  for (std::size_t j = 0; j < coordinate_count; ++j) {
    if (!free[j]) known.push_back(static_cast<int>(j));
  }
  if (known.size() == coordinate_count) {
    problem.SetParameterBlockConstant(contact);
  } else if (!known.empty()) {
    problem.SetManifold(contact, new ceres::SubsetManifold(static_cast<int>(coordinate_count), known));
  }
}

}  // namespace

FitResult fit_jointly(std::span<const TestRecord> records, const Observations& observations,
                      const FitPoint& start, const FitSetting& setting) {
  quieten_log();
  FitPoint point = start;
  ceres::Problem problem;
  problem.AddResidualBlock(new JointResiduals(records, observations, setting), nullptr, point.contact.data(),
                           point.offset.data());
  keep_known(problem, point.contact.data(), setting.free);
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = setting.max_steps;
  options.function_tolerance = setting.tolerance;
  options.parameter_tolerance = 1e-9;
  options.max_num_consecutive_invalid_steps = setting.max_steps;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return {start, std::numeric_limits<double>::infinity()};
  return {point, 2.0 * summary.final_cost};  // Ceres' cost is half the sum
}

}  // namespace zerocount::identification
