#include "analysis/record/fit/presliding/starting_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <numbers>

#include <ceres/dynamic_numeric_diff_cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/record/fit/model.hpp"
#include "analysis/record/fit/solver.hpp"
#include "core/friction/presliding/spring.hpp"

namespace zerocount::fit {

namespace {

/// A ring-down (oscillation after a step of the torque), with the record that contains it.
struct RingDown {
  const TestRecord* record{nullptr};
  TorqueHold hold;
};

RingDown largest_ring_down(Records records) {
  RingDown largest;
  for (std::size_t r = 0; r < records.size(); ++r) {
    for (const TorqueHold& hold : records[r].parts.holds) {
      if (!hold.rings_down) continue;
      const bool larger = largest.record == nullptr || std::abs(hold.torque - hold.from) >
                                                           std::abs(largest.hold.torque - largest.hold.from);
      if (larger) largest = {&records[r], hold};
    }
  }
  return largest;
}

/// Sum of squares of the residuals of a record's readings about their mean, in units of the readings, for the
/// contact at the point.
/// @param creep_torque torque scale σ0 of the coordinates, N m
double misfit(const TestRecord& record, const Point& point, double creep_torque) {
  const Eigen::VectorXd path = modelled_path(record, contact_model(creep_torque), point);
  const Eigen::VectorXd residual = readings_of(record) - path;
  const double sum = (residual.array() - residual.mean()).square().sum();
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

using ChosenRecords = std::vector<const TestRecord*>;

double misfit(const ChosenRecords& records, const Point& point, double creep_torque) {
  double sum = 0.0;
  for (const TestRecord* record : records) sum += misfit(*record, point, creep_torque);
  return sum;
}

/// The best of the point and its variations by `changes`, by the sum of squares. A variation must reduce the
/// sum below the fraction `proportion`.
Point best_of(const ChosenRecords& records, const Point& point, double creep_torque,
              std::span<const Point> changes, double proportion = 1.0) {
  const std::size_t unchanged = changes.size();
  std::vector<double> left(unchanged + 1);
  parallel::for_each_index(left.size(), [&](std::size_t i) {
    left[i] = misfit(records, i == unchanged ? point : point + changes[i], creep_torque);
  });
  Point best = point;
  double least = proportion * left[unchanged];
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (left[i] >= least) continue;
    least = left[i];
    best = point + changes[i];
  }
  return best;
}

/// Variations of the softening rate β with constant k2/β; β is the parameter about which the estimate from
/// the branches is least certain.
std::vector<Point> softening_changes() {
  std::vector<Point> changes;
  for (const double factor : {0.3, 0.55, 1.8, 3.3})
    changes.push_back(change_of({{log_beta, std::log(factor)}, {log_k2, std::log(factor)}}));
  return changes;
}

ChosenRecords all_of(Records records) {
  ChosenRecords all;
  for (const TestRecord& record : records) all.push_back(&record);
  return all;
}

/// The records that have a ring-down (oscillation after a step of the torque).
ChosenRecords ringing_records(Records records) {
  ChosenRecords ringing;
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (records[r].parts.ring_downs() > 0) ringing.push_back(&records[r]);
  }
  return ringing;
}

/// Searches the inertia J and the damping c around those of the point, far and then near, with the records
/// that have a ring-down. Without a ring-down it searches a wider range with all records, because the
/// response to DAC steps may show the inertia.
Point with_best_ringing(Records records, const Point& point, double creep_torque) {
  constexpr double much = 0.8;
  const ChosenRecords ringing = ringing_records(records);
  if (!ringing.empty()) {
    std::vector<Point> changes = inertia_changes({0.01, 0.1, 1.0, 10.0, 100.0}, {0.15, 1.0, 7.0});
    std::erase_if(changes, [&](const Point& change) {
      return !is_sampled(records, contact_model(creep_torque), point + change);
    });
    const Point far = best_of(ringing, point, creep_torque, changes, much);
    return best_of(ringing, far, creep_torque,
                   inertia_changes({0.4, 0.63, 1.0, 1.6, 2.5}, {0.2, 0.45, 1.0, 2.2}));
  }
  return best_of(all_of(records), point, creep_torque,
                 inertia_changes({1.0, 10.0, 100.0, 1e3, 1e4}, {0.5, 2.0, 8.0}), much);
}

/// A starting point for a given creep law: estimates the spring, the inertia J and the damping c without
/// simulating.
Point point_with_creep(Records records, const CreepEstimate& creep, double creep_torque) {
  const SpringEstimate spring = estimate_spring(records, creep, creep_torque);
  ContactParameters contact;
  contact.plant = estimate_ring_down(records, spring.k1);
  contact.friction.k1 = spring.k1;
  contact.friction.k2 = spring.offset * spring.beta;
  contact.friction.beta = spring.beta;
  contact.friction.alpha = creep.alpha;
  contact.friction.n = creep.exponent;
  contact.friction.lambda = std::pow(creep_torque, creep.exponent) / creep.limit;
  return point_of(contact, creep_torque);
}

Point with_known(Point point, const Point& known, const FreeCoordinates& free) {
  for (std::size_t j = 0; j < coordinate_count; ++j) {
    if (!free[j]) point[j] = known[j];
  }
  return point;
}

}  // namespace

Point change_of(std::initializer_list<std::pair<Coordinate, double>> changes) {
  Point change = Point::Zero(coordinate_count);
  for (const auto& [coordinate, value] : changes) change[coordinate] = value;
  return change;
}

std::vector<Point> inertia_changes(std::initializer_list<double> inertias,
                                   std::initializer_list<double> dampings) {
  std::vector<Point> changes;
  for (const double inertia : inertias) {
    for (const double damping : dampings)
      changes.push_back(change_of({{log_inertia, std::log(inertia)}, {log_damping, std::log(damping)}}));
  }
  return changes;
}

FirstOvershoot first_overshoot(const TestRecord& record, const TorqueHold& ring_down) {
  const Eigen::VectorXd angle = measured_angle(record);
  const double sign = ring_down.torque > ring_down.from ? 1.0 : -1.0;
  const auto first = static_cast<Eigen::Index>(ring_down.first);
  const auto samples = static_cast<Eigen::Index>(ring_down.last) - first + 1;
  const Eigen::VectorXd motion = sign * (angle.segment(first, samples).array() - angle[first]);
  Eigen::Index peak = 0;
  while (peak + 1 < motion.size() && motion[peak + 1] >= motion[peak]) ++peak;
  const Eigen::Index settled = std::min(6 * (peak + 1), motion.size() - 1);
  const double travel = motion[settled];
  constexpr double risen = 0.632;  // 1 − 1/e
  Eigen::Index rise = 0;
  while (rise < settled && motion[rise] < risen * travel) ++rise;
  return {static_cast<std::size_t>(peak + 1), static_cast<std::size_t>(rise + 1), travel,
          travel > 0.0 ? motion[peak] / travel - 1.0 : 0.0};
}

motion::PlantParameters estimate_ring_down(Records records, double k1) {
  const RingDown ring = largest_ring_down(records);
  const double sample_time = records.front().sample_time;
  // Without a ring-down: an oscillation too fast for the sampling, with a third of the critical damping.
  double frequency = 0.5 * std::numbers::pi / sample_time;  // of the undamped rotor, rad/s
  double damping_ratio = 0.33;
  double stiffness = k1;
  if (ring.record != nullptr) {
    const FirstOvershoot motion = first_overshoot(*ring.record, ring.hold);
    // The chord stiffness over the step: larger than k1 if k1 is much smaller than k2.
    if (motion.travel > 0.0)
      stiffness = std::max(k1, std::abs(ring.hold.torque - ring.hold.from) / motion.travel);
    constexpr double visible = 0.01;
    if (motion.overshoot > visible && motion.overshoot < 1.0) {
      const double decay = -std::log(motion.overshoot);
      damping_ratio = std::clamp(decay / std::hypot(std::numbers::pi, decay), 0.05, 0.9);
      const double to_peak = ring.record->sample_time * static_cast<double>(motion.peak);
      frequency = std::numbers::pi / to_peak / std::sqrt(1.0 - damping_ratio * damping_ratio);
    } else {
      // A critically damped rotor has risen to 1 − 1/e at ω0·t = 2.15. What follows is creep.
      damping_ratio = 1.0;
      frequency = 2.15 / (ring.record->sample_time * static_cast<double>(motion.rise));
    }
  }
  motion::PlantParameters plant;
  plant.inertia = stiffness / (frequency * frequency);
  plant.presliding_damping = 2.0 * damping_ratio * std::sqrt(stiffness * plant.inertia);
  return plant;
}

std::vector<Point> starting_points(Records records, double creep_torque, const Point& known,
                                   const FreeCoordinates& free) {
  const auto start_with = [&](const CreepEstimate& creep) {
    return with_known(point_with_creep(records, creep, creep_torque), known, free);
  };
  const auto with_ringing = [&](const Point& point) {
    return with_known(with_best_ringing(records, point, creep_torque), known, free);
  };
  CreepEstimate creep = estimate_creep(records, creep_torque);
  const bool creep_seen = creep.limit > 0.0;
  std::vector<Point> starts;
  if (creep_seen) {
    const Point start = start_with(creep);
    starts.push_back(best_of(all_of(records), start, creep_torque, softening_changes()));
    if (!has_slow_branches(records)) return {with_ringing(with_known(starts.front(), known, free))};
  }
  // Creep as a fraction of the spring's travel.
  creep.exponent = 2.0;
  const double travel = creep_torque / estimate_spring(records, {}, creep_torque).k1;
  for (const double proportion : {1e-3, 0.1, 0.3, 1.0, 3.0}) {
    creep.limit = proportion * travel;
    starts.push_back(start_with(creep));
  }
  SlowFit slow = fit_slow_parts(records, starts, creep_torque, free,
                                creep_seen || are_slow_alone(records) ? SlowCreep::fitted : SlowCreep::kept);
  const Point estimated = starts.front();
  std::vector<Point> changes = softening_changes();
  for (const Point& start : starts) changes.push_back(start - estimated);
  if (std::isfinite(slow.squares)) {
    // The inertia and the damping of the same frequency and damping ratio.
    const double softer = slow.point[log_k1] - estimated[log_k1];
    if (free[log_inertia]) slow.point[log_inertia] += softer;
    if (free[log_damping]) slow.point[log_damping] += softer;
    changes.push_back(slow.point - estimated);
  }
  const Point point = with_ringing(best_of(all_of(records), estimated, creep_torque, changes));
  if (!creep_seen) return {point};
  // Creep that was fitted to slow parts may stand for the softening of the spring.
  const std::array<Point, 1> other{with_ringing(estimated) - point};
  const Point first = best_of(all_of(records), point, creep_torque, other);
  return {first, first == point ? Point(point + other[0]) : point};
}

std::vector<Point> starts_with_other_softening(Records records, const Point& start, double creep_torque) {
  // Slow parts alone hardly show inertia and damping.
  const bool ringing = !ringing_records(records).empty() || !has_slow_branches(records);
  std::vector<Point> points;
  for (const double rate : {0.1, 1.0, 5.0, 20.0, 80.0}) {
    for (const double offset : {0.3, 1.0}) {
      const Point point = start + change_of({{log_beta, std::log(rate)}, {log_k2, std::log(rate * offset)}});
      points.push_back(ringing ? with_best_ringing(records, point, creep_torque) : point);
    }
  }
  return points;
}

std::vector<Point> starts_with_other_creep(Records records, const Point& start, double creep_torque) {
  CreepEstimate creep{std::exp(start[log_alpha]), start[creep_exponent], 0.0};
  const double travel = creep_torque / estimate_spring(records, creep, creep_torque).k1;
  std::vector<Point> points;
  for (const double proportion : {1e-3, 0.1, 1.0}) {
    creep.limit = proportion * travel;
    const Point base = point_with_creep(records, creep, creep_torque);
    for (const Point& point : starts_with_other_softening(records, base, creep_torque)) {
      points.push_back(point);
    }
  }
  return points;
}

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
