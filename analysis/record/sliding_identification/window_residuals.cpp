#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <ceres/autodiff_cost_function.h>

#include "analysis/record/sliding_identification/sliding_record.hpp"
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

/// Simulates a sliding axis (inertia, damping, Coulomb and Stribeck friction). Number is double, or
/// ceres::Jet to carry derivatives.
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

  /// Advances the motion by `duration`, s.
  /// @param course drive torque during this time
  /// @param of_position position-dependent torques against the drive, at the beginning, in the middle and at
  /// the end. They are interpolated by a parabola, because a straight line would leave an error that looks
  /// like a second mass where cogging passes within a few samples.
  void advance(const motion::TorqueCourse& course, double duration,
               const std::array<Number, 3>& of_position) {
    const double rate = std::max(friction_rate_, motion::is_constant(course) ? 0.0 : course.rate);
    constexpr double max_steps = 200.0;  // no meaning beyond: the parameters are far off
    const double steps = std::clamp(std::ceil(20.0 * rate * duration), 1.0, max_steps);
    for (double i = 0.0; i < steps; i += 1.0) {
      const auto torque = [&](double at) -> Number {
        const double s = at / steps;
        return motion::course_after(course, at * duration / steps).now - offset_ -
               ((1.0 - s) * (1.0 - 2.0 * s) * of_position[0] + 4.0 * s * (1.0 - s) * of_position[1] +
                s * (2.0 * s - 1.0) * of_position[2]);
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
  Number damping_;      ///< Viscous damping cs, N m s/rad or N s/m.
  Number offset_;       ///< Constant offset torque u0, N m or N.
  Number per_inertia_;  ///< Reciprocal inertia 1/J, 1/(kg m²), or reciprocal mass, 1/kg.
  double direction_;
  double friction_rate_;  ///< Largest rate at which the friction can change the velocity, 1/s.
};

template <std::size_t terms>
struct WindowResiduals {
  const SlidingRecord& record;
  const Window& window;

  template <class Number>
  bool operator()(const Number* point, const Number* start, Number* residuals) const {
    using std::isfinite;
    SlidingAxis<Number> axis(point, start, window.direction);
    const auto torque_of = [&](const PositionShape& shape) {
      Number torque(0.0);
      for (std::size_t j = 0; j < terms; ++j) torque += shape[j] * point[position_amplitudes + j];
      return torque;
    };
    const auto of_position = [&](const std::vector<PositionShape>& shapes, std::size_t k) {
      return terms == 0 ? Number(0.0) : torque_of(shapes[k]);
    };
    Number here = of_position(record.shape, window.first);
    for (std::size_t k = window.first; k <= window.last; ++k) {
      if (!isfinite(axis.position())) return false;
      *residuals++ = (axis.position() - record.position[k]) / record.resolution;
      if (k == window.last) break;
      const Number next = of_position(record.shape, k + 1);
      axis.advance(record.torque[k], record.time[k + 1] - record.time[k],
                   {here, of_position(record.shape_between, k), next});
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
