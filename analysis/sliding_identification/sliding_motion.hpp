#pragma once

#include <cstddef>
#include <memory>

#include <Eigen/Core>

#include "analysis/sliding_identification/sliding_record.hpp"

namespace ceres {
class CostFunction;
}

namespace zerocount::sliding_identification {

/// The fitted parameters of a sliding axis, in this order.
enum SlidingCoordinate : std::size_t {
  log_inertia,            ///< ln of J (kg m²) or of the mass (kg)
  coulomb_level,          ///< Fc, N m or N
  viscous_damping,        ///< cs, N m s/rad or N s/m
  offset_torque,          ///< u0, N m or N
  stribeck_excess,        ///< Fs − Fc, N m or N
  log_stribeck_velocity,  ///< ln of ωs, rad/s or m/s
  sliding_dimension
};

using SlidingPoint = Eigen::Matrix<double, sliding_dimension, 1>;

/// The positions of a simulated sliding motion less the readings in a window, in units of the resolution. The
/// parameters are a SlidingPoint, and the initial position and velocity.
///
/// The motion is J·dω/dt = u − u0 − cs·ω − d·g(ω), dθ/dt = ω, the law of core/friction/sliding/sliding.hpp
/// with an offset, by the classical Runge–Kutta method, with steps of at most a sampling interval and a
/// twentieth of the time constants of the friction and of the amplifier. The derivatives are those of these
/// steps, by forward automatic differentiation. The evaluation fails where the motion is not finite.
/// @param record and @param window must outlive the result.
std::unique_ptr<ceres::CostFunction> window_residuals(const SlidingRecord& record, const Window& window);

}  // namespace zerocount::sliding_identification
