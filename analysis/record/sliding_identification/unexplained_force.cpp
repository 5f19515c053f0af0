#include "analysis/record/sliding_identification/unexplained_force.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/record/sliding_identification/sliding_fit.hpp"
#include "core/plant/plant.hpp"

namespace zerocount::sliding_identification {
namespace {

plant::Plant axis_of(const SlidingPoint& point, double velocity, double resolution) {
  motion::PlantParameters axis;
  axis.inertia = std::exp(point[log_inertia]);
  axis.sliding_damping = std::max(point[viscous_damping], 0.0);
  friction::FrictionAlongRotor friction;
  friction.model = friction::FrictionModel::coulomb;
  const double coulomb = std::max(point[coulomb_level], std::numeric_limits<double>::min());
  const double breakaway = std::max(coulomb + point[stribeck_excess], coulomb);
  friction.uniform.breakaway = breakaway;
  friction.uniform.coulomb_ratio = coulomb / breakaway;
  friction.uniform.stribeck_velocity = std::exp(point[log_stribeck_velocity]);
  constexpr double part_of_a_step = 1e-3;
  return {axis, friction, {.velocity = velocity}, {part_of_a_step * resolution}};
}

/// The fitted position-dependent torques as a disturbance of the simulation.
/// @param x record's position at the simulation's θ = 0, rad or m
motion::Disturbance position_torque(const SlidingFit& fit, double x, double travel) {
  motion::Disturbance disturbance;
  for (std::size_t i = 0; i < fit.waves.size(); ++i) {
    const double sine = -fit.point[static_cast<Eigen::Index>(position_amplitudes + 2 * i)];
    const double cosine = -fit.point[static_cast<Eigen::Index>(position_amplitudes + 2 * i + 1)];
    constexpr double straight = 1e-4;  // rad over the travel: the sine of a torque proportional to x
    const bool linear = fit.waves[i].periods == 0.0;
    const double wave_number = linear ? straight / travel : fit.waves[i].wave_number;
    disturbance.ripple.push_back({linear ? sine / wave_number : std::hypot(sine, cosine), wave_number,
                                  std::atan2(linear ? 0.0 : cosine, linear ? 1.0 : sine) + wave_number * x});
  }
  return disturbance;
}

FreeRun free_run(const FittedWindow& first, const SlidingFit& fit) {
  const SlidingPoint& point = fit.point;
  const SlidingRecord& record = *first.record;
  const std::size_t from = first.window->first;
  plant::Plant axis = axis_of(point, first.start[1], record.resolution);
  const auto [lowest, highest] = std::minmax_element(record.position.begin(), record.position.end());
  axis.disturb(position_torque(fit, record.origin + first.start[0], *highest - *lowest));
  double squares = 0.0;
  FreeRun run{.name = record.name,
              .axis = record.axis,
              .start = record.time[from],
              .duration = record.time.back() - record.time[from]};
  for (std::size_t k = from; k < record.time.size() && axis.finite(); ++k) {
    const double difference = first.start[0] + axis.theta() - record.position[k];
    squares += difference * difference;
    run.max = std::max(run.max, std::abs(difference));
    if (k + 1 == record.time.size()) break;
    motion::TorqueCourse course = record.torque[k];
    course.now -= point[offset_torque];
    course.settled -= point[offset_torque];
    axis.advance(course, record.time[k + 1] - record.time[k]);
  }
  run.stroke = *highest - *lowest;
  run.rms = std::sqrt(squares / static_cast<double>(record.time.size() - from));
  if (!axis.finite()) run.rms = run.max = std::numeric_limits<double>::quiet_NaN();
  return run;
}

}  // namespace

std::vector<FreeRun> free_runs(const SlidingFit& fit) {
  std::vector<FreeRun> runs;
  const SlidingRecord* last = nullptr;
  for (const FittedWindow& window : fit.windows) {
    if (window.record == last) continue;
    last = window.record;
    runs.push_back(free_run(window, fit));
  }
  return runs;
}

}  // namespace zerocount::sliding_identification
