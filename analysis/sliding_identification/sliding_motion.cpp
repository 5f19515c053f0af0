#include "analysis/sliding_identification/sliding_motion.hpp"

#include <algorithm>
#include <cmath>

#include <ceres/autodiff_cost_function.h>

#include "core/friction/sliding/sliding.hpp"

namespace zerocount::sliding_identification {
namespace {

double value_of(double number) {
  return number;
}

template <int N>
double value_of(const ceres::Jet<double, N>& number) {
  return number.a;
}

/// A sliding axis. Number is double, or ceres::Jet to carry derivatives.
template <class Number>
class SlidingAxis {
 public:
  SlidingAxis(const Number* point, const Number* start, double direction)
      : position_(start[0]), velocity_(start[1]), direction_(direction) {
    using std::abs, std::exp, std::sqrt;
    curve_ = {point[coulomb_level], point[stribeck_excess], exp(-2.0 * point[log_stribeck_velocity])};
    damping_ = point[viscous_damping];
    offset_ = point[offset_torque];
    per_inertia_ = exp(-point[log_inertia]);
    constexpr double steepest = 0.86;  // of 2·x·exp(−x²)
    friction_rate_ = value_of(
        per_inertia_ * (abs(damping_) + steepest * abs(curve_.excess) * sqrt(curve_.per_velocity_squared)));
  }

  const Number& position() const { return position_; }

  /// @param first, last torques against the drive that depend on the position, at both ends
  void advance(const motion::TorqueCourse& course, double duration, const Number& first, const Number& last) {
    const double rate = std::max(friction_rate_, motion::is_constant(course) ? 0.0 : course.rate);
    constexpr double max_steps = 200.0;  // no meaning beyond: the parameters are far off
    const double steps = std::clamp(std::ceil(20.0 * rate * duration), 1.0, max_steps);
    for (double i = 0.0; i < steps; i += 1.0) {
      const auto torque = [&](double at) -> Number {
        return motion::course_after(course, at * duration / steps).now - offset_ -
               (first + at / steps * (last - first));
      };
      step(torque(i), torque(i + 0.5), torque(i + 1.0), duration / steps);
    }
  }

 private:
  Number acceleration(const Number& velocity, const Number& torque) const {
    return per_inertia_ * friction::sliding_torque<Number>(torque, damping_, curve_, direction_, velocity);
  }

  void step(const Number& first, const Number& middle, const Number& last, double time) {
    const Number a1 = acceleration(velocity_, first);
    const Number a2 = acceleration(velocity_ + 0.5 * time * a1, middle);
    const Number a3 = acceleration(velocity_ + 0.5 * time * a2, middle);
    const Number a4 = acceleration(velocity_ + time * a3, last);
    position_ += time * velocity_ + time * time / 6.0 * (a1 + a2 + a3);
    velocity_ += time / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
  }

  Number position_;
  Number velocity_;
  friction::StribeckCurveOf<Number> curve_;
  Number damping_;      ///< cs
  Number offset_;       ///< u0
  Number per_inertia_;  ///< 1/J
  double direction_;
  double friction_rate_;  ///< the largest (1/s) at which the friction can change the velocity
};

template <std::size_t terms>
struct WindowResiduals {
  const SlidingRecord& record;
  const Window& window;

  template <class Number>
  bool operator()(const Number* point, const Number* start, Number* residuals) const {
    using std::isfinite;
    SlidingAxis<Number> axis(point, start, window.direction);
    const auto of_position = [&](std::size_t k) {
      Number torque(0.0);
      for (std::size_t j = 0; j < terms; ++j) torque += record.shape[k][j] * point[position_amplitudes + j];
      return torque;
    };
    Number here = of_position(window.first);
    for (std::size_t k = window.first; k <= window.last; ++k) {
      if (!isfinite(axis.position())) return false;
      *residuals++ = (axis.position() - record.position[k]) / record.resolution;
      if (k == window.last) break;
      const Number next = of_position(k + 1);
      axis.advance(record.torque[k], record.time[k + 1] - record.time[k], here, next);
      here = next;
    }
    return true;
  }
};

template <std::size_t terms>
std::unique_ptr<ceres::CostFunction> residuals_with(const SlidingRecord& record, const Window& window) {
  using Residuals = ceres::AutoDiffCostFunction<WindowResiduals<terms>, ceres::DYNAMIC,
                                                static_cast<int>(position_amplitudes + terms), 2>;
  return std::make_unique<Residuals>(new WindowResiduals<terms>{record, window},
                                     static_cast<int>(samples_of(window)));
}

}  // namespace

std::unique_ptr<ceres::CostFunction> window_residuals(const SlidingRecord& record, const Window& window) {
  if (record.waves == 0) return residuals_with<0>(record, window);
  return record.waves == 1 ? residuals_with<2>(record, window)
                           : residuals_with<position_terms>(record, window);
}

}  // namespace zerocount::sliding_identification
