#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include <ceres/dynamic_numeric_diff_cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/record/fit/model.hpp"
#include "analysis/record/fit/presliding/starting_point.hpp"
#include "analysis/record/fit/solver.hpp"
#include "core/friction/presliding/spring.hpp"

namespace zerocount::fit {
namespace {

/// Largest number of samples of a record that are compared with a model.
constexpr std::size_t max_samples = 1500;

/// Relative change of a coordinate for a difference quotient.
constexpr double slope_step = 1e-6;

/// Softening travel 1/β (in units of the readings) below which the readings do not show it.
constexpr double min_slow_travel = 0.3;

/// Largest change of a coordinate from its start, and largest creep exponent n.
constexpr double max_change = 8.0;
constexpr double max_exponent = 6.0;

/// The slow parts of a record, reduced to points: the torques that matter in the order of time, and for some
/// of them the angle that responds.
struct SlowParts {
  struct Point {
    double torque{0.0};     ///< Torque, N m.
    std::size_t sample{0};  ///< Index of the sample whose reading is the response to the torque.
    /// True if the reading is compared with the model; false if the point is only a turning point of the
    /// torque.
    bool read{false};
  };
  std::vector<Point> points;
  std::size_t read{0};  ///< Number of points whose reading is compared.
};

/// The torque to which the reading at sample k is the response, N m.
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
  const std::size_t every = std::max<std::size_t>(1, available / max_samples);
  SlowParts parts;
  std::size_t number = 0;
  for (std::size_t k = 1; k < sample_count(record); ++k) {
    const bool read = slow[k] && number++ % every == 0 && !is_excluded(record, k);
    const double torque = torque_before(record, k);
    const double before = torque - torque_before(record, k - 1);
    const double after = record.torque[k].now - torque;
    const bool reverses = before * after < 0.0 || (before != 0.0 && after == 0.0);
    if (read || reverses) parts.points.push_back({torque, k, read});
    if (read) ++parts.read;
  }
  return parts;
}

/// Residuals (measured − modelled)/unit of all compared samples, about the mean of each record, as a function
/// of a Point.
class SlowPartsResiduals {
 public:
  SlowPartsResiduals(Records records, double creep_torque) : records_(records), creep_torque_(creep_torque) {
    for (const TestRecord& record : records) {
      parts_.push_back(slow_parts_of(record));
      angles_.push_back(measured_angle(record));
      read_ += parts_.back().read;
    }
  }

  std::size_t size() const { return read_; }

  bool operator()(double const* const* coordinates, double* residuals) const {
    const Point point = Eigen::Map<const Point>(coordinates[0], contact_dimension);
    const friction::FrictionParameters friction = contact_at(point, creep_torque_).friction;
    const CreepEstimate creep{std::exp(point[log_alpha]), point[creep_exponent], std::exp(point[log_limit])};
    // Its own memory: the order of a sum depends on the alignment.
    Eigen::VectorXd all(static_cast<Eigen::Index>(read_));
    Eigen::Index filled = 0;
    for (std::size_t r = 0; r < records_.size(); ++r) {
      if (parts_[r].read == 0) continue;
      friction::HystereticSpring spring(friction);
      spring.start_preloaded(records_[r].start.preload);
      for (const double torque : records_[r].start.history) spring.move_to_torque(torque);
      spring.move_to_torque(0.0);
      const Eigen::VectorXd extension = creep_extension(records_[r], creep, creep_torque_);
      const Eigen::Index first = filled;
      for (const SlowParts::Point& at : parts_[r].points) {
        spring.move_to_torque(at.torque);
        if (!at.read) continue;
        const auto k = static_cast<Eigen::Index>(at.sample);
        all[filled++] = (angles_[r][k] - extension[k] - spring.elongation()) / records_[r].unit;
      }
      auto own = all.segment(first, filled - first);
      own.array() -= own.mean();
    }
    std::copy(all.begin(), all.end(), residuals);
    return all.allFinite();
  }

 private:
  Records records_;
  double creep_torque_;
  std::vector<SlowParts> parts_;
  std::vector<Eigen::VectorXd> angles_;  // [record] rad
  std::size_t read_{0};
};

/// Fits the slow parts by the Levenberg–Marquardt method. Only those coordinates change that are in `moved`
/// and are `free`.
/// @param max_log_beta largest ln β
/// @param steps largest number of steps
SlowFit fit_coordinates(const SlowPartsResiduals& residuals, const Point& start, const FreeCoordinates& free,
                        std::span<const Coordinate> moved, double max_log_beta, int steps) {
  Point point = start;
  ceres::NumericDiffOptions differences;
  differences.relative_step_size = slope_step;
  auto* const cost = new ceres::DynamicNumericDiffCostFunction<SlowPartsResiduals, ceres::FORWARD>(
      &residuals, ceres::DO_NOT_TAKE_OWNERSHIP, differences);
  cost->AddParameterBlock(static_cast<int>(coordinate_count));
  cost->SetNumResiduals(static_cast<int>(residuals.size()));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, point.data());
  std::vector<int> fixed;
  for (std::size_t j = 0; j < coordinate_count; ++j) {
    const auto coordinate = static_cast<Coordinate>(j);
    if (!free[j] || std::find(moved.begin(), moved.end(), coordinate) == moved.end()) {
      fixed.push_back(static_cast<int>(j));
      continue;
    }
    const bool exponent = coordinate == creep_exponent;
    problem.SetParameterLowerBound(point.data(), static_cast<int>(j), exponent ? 1.0 : start[j] - max_change);
    const double highest = exponent                 ? max_exponent
                           : coordinate == log_beta ? std::max(max_log_beta, start[j])
                                                    : start[j] + max_change;
    problem.SetParameterUpperBound(point.data(), static_cast<int>(j), highest);
  }
  if (fixed.size() == coordinate_count) return {start, std::numeric_limits<double>::infinity()};
  problem.SetManifold(point.data(), new ceres::SubsetManifold(static_cast<int>(coordinate_count), fixed));
  SearchSetting search;
  search.max_steps = steps;
  search.tolerance = 1e-5;
  const SearchResult found = search_least_squares(problem, search);
  if (!found.found) return {start, std::numeric_limits<double>::infinity()};
  return {point, found.squares};
}

double squares_at(const SlowPartsResiduals& residuals, const Point& point) {
  Eigen::VectorXd all(static_cast<Eigen::Index>(residuals.size()));
  const double* const coordinates = point.data();
  return residuals(&coordinates, all.data()) ? all.squaredNorm() : std::numeric_limits<double>::infinity();
}

/// Runs `fit` from the point of each of `fits`, in parallel, and returns the best results, at most `most`,
/// the best one first.
std::vector<SlowFit> best_fits(std::vector<SlowFit> fits, std::size_t most,
                               const std::function<SlowFit(const Point&)>& fit) {
  parallel::for_each_index(fits.size(), [&](std::size_t i) { fits[i] = fit(fits[i].point); });
  std::stable_sort(fits.begin(), fits.end(),
                   [](const SlowFit& one, const SlowFit& other) { return one.squares < other.squares; });
  fits.resize(std::min(fits.size(), most));
  return fits;
}

}  // namespace

SlowFit fit_slow_parts(Records records, std::span<const Point> starts, double creep_torque,
                       const FreeCoordinates& free, SlowCreep creep) {
  const SlowPartsResiduals residuals(records, creep_torque);
  if (!has_slow_branches(records) || residuals.size() == 0) {
    return {starts.front(), std::numeric_limits<double>::infinity()};
  }
  double max_log_beta = -std::numeric_limits<double>::infinity();
  for (const TestRecord& record : records) {
    max_log_beta = std::max(max_log_beta, -std::log(min_slow_travel * record.unit));
  }
  std::vector<SlowFit> fits;
  for (const Point& start : starts) {
    for (const double rate : {1.0, 0.003, 0.01, 0.03, 0.1, 0.3, 3.0, 10.0, 30.0}) {
      SlowFit& fit = fits.emplace_back(SlowFit{start, 0.0});
      if (free[log_beta]) fit.point[log_beta] += std::log(rate);
      if (free[log_beta] && free[log_k2]) fit.point[log_k2] += std::log(rate);
    }
  }
  constexpr std::array spring{log_k1, log_k2, log_beta};
  constexpr std::array spring_and_creep{log_k1, log_k2, log_beta, log_alpha, log_limit, creep_exponent};
  fits = best_fits(std::move(fits), 9, [&](const Point& point) {
    return SlowFit{point, squares_at(residuals, point)};
  });
  fits = best_fits(std::move(fits), 2, [&](const Point& point) {
    return fit_coordinates(residuals, point, free, spring, max_log_beta, 8);
  });
  const std::span<const Coordinate> moved =
      creep == SlowCreep::fitted ? std::span<const Coordinate>(spring_and_creep) : spring;
  fits = best_fits(std::move(fits), 1, [&](const Point& point) {
    return fit_coordinates(residuals, point, free, moved, max_log_beta, 40);
  });
  return fits.front();
}

}  // namespace zerocount::fit
