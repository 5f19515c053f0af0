#include "analysis/record/fit/presliding/starting_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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

}  // namespace zerocount::fit
