#include "analysis/identification/quasistatic_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <ceres/dynamic_numeric_diff_cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <oneapi/tbb/parallel_for.h>

#include "core/friction/spring.hpp"

namespace zerocount::identification {
namespace {

/// Samples of a record that are compared.
constexpr std::size_t most_samples = 3000;

/// Relative change of a coordinate for a difference quotient.
constexpr double slope_step = 1e-6;

/// Softening travel (units of the readings) below which the readings cannot tell it.
constexpr double least_travel = 0.3;

/// Largest change of a coordinate from its start.
constexpr double max_change = 8.0;

/// Slow parts of a record: the torques that matter in the order of time, and the angles that answer some.
struct SlowParts {
  struct Point {
    double torque{0.0};     ///< N m
    std::size_t sample{0};  ///< of its answer
    bool read{false};       ///< otherwise only a turning point
  };
  std::vector<Point> points;
  std::size_t read{0};  ///< number of angles
};

/// The torque (N m) whose answer is the reading at sample k.
double torque_before(const TestRecord& record, std::size_t k) {
  return k == 0 ? 0.0 : record.torque[k - 1].now;
}

SlowParts slow_parts_of(const TestRecord& record) {
  std::vector<bool> slow(sample_count(record), false);
  const auto mark = [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k <= last; ++k) slow[k] = true;
  };
  for (const LoadingBranch& branch : record.parts.branches) {
    if (is_gradual(record, branch)) mark(branch.first + 1, branch.last);
  }
  for (const TorqueHold& hold : record.parts.holds) {
    if (hold.rings_down)
      std::fill(slow.begin() + static_cast<std::ptrdiff_t>(hold.first),
                slow.begin() + static_cast<std::ptrdiff_t>(hold.last) + 1, false);
    mark(hold.first + (hold.last - hold.first) / 2, hold.last);
  }
  const auto available = static_cast<std::size_t>(std::count(slow.begin(), slow.end(), true));
  const std::size_t every = std::max<std::size_t>(1, available / most_samples);
  SlowParts parts;
  std::size_t number = 0;
  for (std::size_t k = 1; k < sample_count(record); ++k) {
    const bool read = slow[k] && number++ % every == 0 && !is_excluded(record, k);
    const double torque = torque_before(record, k);
    const double before = torque - torque_before(record, k - 1);
    const double after = record.torque[k].now - torque;
    const bool turns = before * after < 0.0 || (before != 0.0 && after == 0.0);
    if (read || turns) parts.points.push_back({torque, k, read});
    if (read) ++parts.read;
  }
  return parts;
}

/// Residuals (measured − modelled)/unit of all samples read, about the mean of each record, as a function of
/// ln k1, ln k2 and ln β.
class SlowPartsResiduals {
 public:
  SlowPartsResiduals(Records records, const ContactPoint& creep, double creep_torque) : records_(records) {
    const CreepEstimate law{std::exp(creep[log_alpha]), creep[creep_exponent], std::exp(creep[log_limit])};
    for (const TestRecord& record : records) {
      parts_.push_back(slow_parts_of(record));
      angles_.push_back(measured_angle(record) - creep_extension(record, law, creep_torque));
      read_ += parts_.back().read;
    }
  }

  std::size_t size() const { return read_; }

  bool operator()(double const* const* spring_point, double* residuals) const {
    friction::FrictionParameters friction;
    friction.k1 = std::exp(spring_point[0][log_k1]);
    friction.k2 = std::exp(spring_point[0][log_k2]);
    friction.beta = std::exp(spring_point[0][log_beta]);
    Eigen::Map<Eigen::VectorXd> all(residuals, static_cast<Eigen::Index>(read_));
    Eigen::Index filled = 0;
    for (std::size_t r = 0; r < records_.size(); ++r) {
      if (parts_[r].read == 0) continue;
      friction::HystereticSpring spring(friction);
      spring.start_preloaded(records_[r].start.preload);
      for (const double torque : records_[r].start.history) spring.move_to_torque(torque);
      spring.move_to_torque(0.0);
      const Eigen::Index first = filled;
      for (const SlowParts::Point& at : parts_[r].points) {
        spring.move_to_torque(at.torque);
        if (!at.read) continue;
        const auto k = static_cast<Eigen::Index>(at.sample);
        all[filled++] = (angles_[r][k] - spring.elongation()) / records_[r].unit;
      }
      auto own = all.segment(first, filled - first);
      own.array() -= own.mean();
    }
    return all.allFinite();
  }

 private:
  Records records_;
  std::vector<SlowParts> parts_;
  std::vector<Eigen::VectorXd> angles_;  // [record] less the creep extension, rad
  std::size_t read_{0};
};

/// Numbers of the coordinates of the spring.
constexpr std::array spring_coordinates{log_k1, log_k2, log_beta};

SlowFit fit_spring(const SlowPartsResiduals& residuals, const ContactPoint& start,
                   const FreeCoordinates& free, double max_log_beta) {
  ContactPoint point = start;
  ceres::NumericDiffOptions differences;
  differences.relative_step_size = slope_step;
  auto* const cost = new ceres::DynamicNumericDiffCostFunction<SlowPartsResiduals, ceres::FORWARD>(
      &residuals, ceres::DO_NOT_TAKE_OWNERSHIP, differences);
  cost->AddParameterBlock(static_cast<int>(spring_coordinates.size()));
  cost->SetNumResiduals(static_cast<int>(residuals.size()));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, point.data());
  std::vector<int> fixed;
  for (const Coordinate j : spring_coordinates) {
    const auto at = static_cast<int>(j);
    if (!free[j]) fixed.push_back(at);
    problem.SetParameterLowerBound(point.data(), at, start[j] - max_change);
    problem.SetParameterUpperBound(point.data(), at,
                                   j == log_beta ? std::max(max_log_beta, start[j]) : start[j] + max_change);
  }
  if (!fixed.empty()) {
    problem.SetManifold(point.data(),
                        new ceres::SubsetManifold(static_cast<int>(spring_coordinates.size()), fixed));
  }
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 40;
  options.function_tolerance = 1e-7;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return {start, std::numeric_limits<double>::infinity()};
  return {point, 2.0 * summary.final_cost};
}

}  // namespace

SlowFit fit_slow_parts(Records records, const ContactPoint& start, double creep_torque,
                       const FreeCoordinates& free) {
  static_assert(log_k1 == 0 && log_k2 == 1 && log_beta == 2);  // the first coordinates of a point
  const SlowPartsResiduals residuals(records, start, creep_torque);
  const bool any = std::any_of(spring_coordinates.begin(), spring_coordinates.end(),
                               [&](Coordinate coordinate) { return free[coordinate]; });
  if (!any || !has_slow_branches(records) || residuals.size() == 0) {
    return {start, std::numeric_limits<double>::infinity()};
  }
  double max_log_beta = -std::numeric_limits<double>::infinity();
  for (const TestRecord& record : records) {
    max_log_beta = std::max(max_log_beta, -std::log(least_travel * record.unit));
  }
  constexpr std::array rates{1.0, 0.003, 0.01, 0.03, 0.1, 0.3, 3.0, 10.0, 30.0};
  std::array<SlowFit, rates.size()> found;
  oneapi::tbb::parallel_for(std::size_t{0}, rates.size(), [&](std::size_t i) {
    ContactPoint point = start;
    if (free[log_beta]) point[log_beta] += std::log(rates[i]);
    if (free[log_beta] && free[log_k2]) point[log_k2] += std::log(rates[i]);
    found[i] = fit_spring(residuals, point, free, max_log_beta);
  });
  return *std::min_element(found.begin(), found.end(), [](const SlowFit& one, const SlowFit& other) {
    return one.squares < other.squares;
  });
}

}  // namespace zerocount::identification
