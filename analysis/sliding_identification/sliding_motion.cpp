#include "analysis/sliding_identification/sliding_motion.hpp"

#include <algorithm>
#include <cmath>

namespace zerocount::sliding_identification {
namespace {

/// Position and velocity in column 0, and their derivatives to the parameters and to the initial velocity.
using MotionState = Eigen::Matrix<double, 2, sliding_dimension + 2>;
constexpr Eigen::Index of_initial_velocity = sliding_dimension + 1;

class SlidingLaw {
 public:
  SlidingLaw(const SlidingPoint& point, double direction)
      : point_(point),
        direction_(direction),
        inertia_(std::exp(point[log_inertia])),
        stribeck_velocity_(std::exp(point[log_stribeck_velocity])) {}

  MotionState rate(const MotionState& state, double torque) const {
    const double velocity = state(1, 0);
    const double ratio = velocity / stribeck_velocity_;
    const double decay = std::exp(-ratio * ratio);
    const double excess = point_[stribeck_excess];
    const double acceleration = (torque - point_[offset_torque] - point_[viscous_damping] * velocity -
                                 direction_ * (point_[coulomb_level] + excess * decay)) /
                                inertia_;
    const double slope =
        (-point_[viscous_damping] + 2.0 * direction_ * excess * decay * ratio / stribeck_velocity_) /
        inertia_;
    MotionState rate;
    rate.row(0) = state.row(1);
    rate.row(1) = slope * state.row(1);
    rate(1, 0) = acceleration;
    rate(1, 1 + log_inertia) -= acceleration;
    rate(1, 1 + coulomb_level) -= direction_ / inertia_;
    rate(1, 1 + viscous_damping) -= velocity / inertia_;
    rate(1, 1 + offset_torque) -= 1.0 / inertia_;
    rate(1, 1 + stribeck_excess) -= direction_ * decay / inertia_;
    rate(1, 1 + log_stribeck_velocity) -= direction_ * excess * decay * 2.0 * ratio * ratio / inertia_;
    return rate;
  }

  /// The largest rate (1/s) at which the friction can change the velocity.
  double stiffness() const {
    constexpr double steepest = 0.86;  // of 2·x·exp(−x²)
    return (std::abs(point_[viscous_damping]) +
            steepest * std::abs(point_[stribeck_excess]) / stribeck_velocity_) /
           inertia_;
  }

 private:
  const SlidingPoint& point_;
  double direction_;
  double inertia_;
  double stribeck_velocity_;
};

void advance(const SlidingLaw& law, const motion::TorqueCourse& course, double duration, MotionState& state) {
  const double rate = std::max(law.stiffness(), motion::is_constant(course) ? 0.0 : course.rate);
  constexpr double max_steps = 200.0;  // no meaning beyond: the parameters are far off
  const double steps = std::clamp(std::ceil(20.0 * rate * duration), 1.0, max_steps);
  const double step = duration / steps;
  for (double i = 0.0; i < steps; i += 1.0) {
    const double first = motion::course_after(course, i * step).now;
    const double middle = motion::course_after(course, (i + 0.5) * step).now;
    const double last = motion::course_after(course, (i + 1.0) * step).now;
    const MotionState k1 = law.rate(state, first);
    const MotionState k2 = law.rate(state + 0.5 * step * k1, middle);
    const MotionState k3 = law.rate(state + 0.5 * step * k2, middle);
    const MotionState k4 = law.rate(state + step * k3, last);
    state += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
}

}  // namespace

WindowMotion window_motion(const SlidingRecord& record, const Window& window, const SlidingPoint& point,
                           double position, double velocity) {
  const SlidingLaw law(point, window.direction);
  WindowMotion motion;
  const auto samples = static_cast<Eigen::Index>(samples_of(window));
  motion.position.resize(samples);
  motion.slopes.resize(samples, window_columns);
  MotionState state = MotionState::Zero();
  state(0, 0) = position;
  state(1, 0) = velocity;
  state(1, of_initial_velocity) = 1.0;
  for (Eigen::Index i = 0; i < samples; ++i) {
    motion.position[i] = state(0, 0);
    motion.slopes.row(i).head<sliding_dimension>() = state.row(0).segment<sliding_dimension>(1);
    motion.slopes(i, sliding_dimension) = 1.0;
    motion.slopes(i, sliding_dimension + 1) = state(0, of_initial_velocity);
    const std::size_t k = window.first + static_cast<std::size_t>(i);
    if (i + 1 < samples) advance(law, record.torque[k], record.time[k + 1] - record.time[k], state);
  }
  return motion;
}

}  // namespace zerocount::sliding_identification
