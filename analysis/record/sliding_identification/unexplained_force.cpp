#include "analysis/record/sliding_identification/unexplained_force.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

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

namespace {

constexpr std::size_t min_strokes = 2;
constexpr int classes = 10;

struct Sum {
  double torque{0.0};
  double windows{0.0};
};

/// The torque of a window that the law leaves unexplained, its stroke (motion in one direction), and the
/// quantities on which the torque may depend.
struct Residual {
  double torque;
  std::pair<const SlidingRecord*, std::size_t> stroke;
  double direction;
  double position;
  double speed;
  double acceleration;
};

std::vector<Residual> residuals_of(const SlidingFit& fit) {
  std::vector<Residual> residuals;
  for (std::size_t i = 0; i < fit.windows.size(); ++i) {
    const SlidingRecord& record = *fit.windows[i].record;
    const Window& window = *fit.windows[i].window;
    const double time = record.time[window.last] - record.time[window.first];
    residuals.push_back({fit.unexplained[i],
                         {&record, window.stroke},
                         window.direction,
                         0.5 * (record.position[window.first] + record.position[window.last]),
                         std::abs(record.position[window.last] - record.position[window.first]) / time,
                         (record.velocity[window.last] - record.velocity[window.first]) / time});
  }
  return residuals;
}

using WindowQuantity = std::function<double(const Residual&)>;

/// [residual] Index of the class: one of ten equal parts of the quantity's range. If `by_direction` is true,
/// the two directions of motion have separate classes.
std::vector<int> classes_of(const std::vector<Residual>& residuals, const WindowQuantity& quantity,
                            bool by_direction) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Residual& one : residuals) {
    low = std::min(low, quantity(one));
    high = std::max(high, quantity(one));
  }
  std::vector<int> found;
  for (const Residual& one : residuals) {
    const double part = high > low ? (quantity(one) - low) / (high - low) : 0.0;
    const int number = std::min(static_cast<int>(part * classes), classes - 1);
    found.push_back(by_direction && one.direction < 0.0 ? number + classes : number);
  }
  return found;
}

RepeatingForce repeats_with(std::string name, const std::vector<Residual>& residuals,
                            const std::vector<int>& of_class) {
  std::map<int, Sum> by_class;
  std::map<std::pair<const SlidingRecord*, std::size_t>, Sum> by_stroke;
  std::map<std::pair<int, std::pair<const SlidingRecord*, std::size_t>>, Sum> by_both;
  Sum all;
  const auto add = [](Sum& sum, double torque) {
    sum.torque += torque;
    sum.windows += 1.0;
  };
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const Residual& one = residuals[i];
    add(all, one.torque);
    add(by_class[of_class[i]], one.torque);
    add(by_stroke[one.stroke], one.torque);
    add(by_both[{of_class[i], one.stroke}], one.torque);
  }
  RepeatingForce force{.with = std::move(name)};
  force.low = std::numeric_limits<double>::infinity();
  force.high = -force.low;
  double unexplained = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const Residual& one = residuals[i];
    const Sum& stroke = by_stroke[one.stroke];
    const Sum& own = by_both[{of_class[i], one.stroke}];
    const Sum& whole = by_class[of_class[i]];
    const double mean = (all.torque - stroke.torque) / (all.windows - stroke.windows);
    double predicted = mean;
    if (whole.windows > own.windows) {
      predicted = (whole.torque - own.torque) / (whole.windows - own.windows);
      force.low = std::min(force.low, whole.torque / whole.windows);
      force.high = std::max(force.high, whole.torque / whole.windows);
    }
    unexplained += (one.torque - predicted) * (one.torque - predicted);
    total += (one.torque - mean) * (one.torque - mean);
  }
  if (force.low > force.high) force.low = force.high = std::numeric_limits<double>::quiet_NaN();
  force.predicted = total > 0.0 ? 1.0 - unexplained / total : 0.0;
  return force;
}

}  // namespace

std::vector<RepeatingForce> repeating_forces(const SlidingFit& fit) {
  const std::vector<Residual> residuals = residuals_of(fit);
  std::size_t strokes = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i)
    strokes += i == 0 || residuals[i].stroke != residuals[i - 1].stroke ? 1 : 0;
  if (strokes < min_strokes) return {};
  const auto with = [&](const char* name, const WindowQuantity& quantity, bool by_direction) {
    return repeats_with(name, residuals, classes_of(residuals, quantity, by_direction));
  };
  return {with("position", &Residual::position, false),
          with("position and direction", &Residual::position, true),
          with("speed and direction", &Residual::speed, true),
          with("acceleration", &Residual::acceleration, false)};
}

}  // namespace zerocount::sliding_identification
