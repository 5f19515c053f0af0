#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "analysis/sliding_identification/sliding_record.hpp"

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

/// Derivatives of the positions of a window: the parameters, the initial position, the initial velocity.
constexpr std::size_t window_columns = sliding_dimension + 2;
using WindowSlopes = Eigen::Matrix<double, Eigen::Dynamic, window_columns, Eigen::RowMajor>;

struct WindowMotion {
  Eigen::VectorXd position;  ///< [sample of the window]
  WindowSlopes slopes;       ///< [sample of the window, column]
};

/// The sliding motion over a window, d = ±1 being its direction:
///
///   J·dω/dt = u − u0 − cs·ω − d·(Fc + (Fs − Fc)·exp(−(ω/ωs)²)),   dθ/dt = ω,
///
/// the law of core/friction/sliding.hpp with an offset, and its derivatives by the variational equations. By
/// the classical Runge–Kutta method, with steps of at most a sampling interval and a twentieth of the time
/// constants of the friction and of the amplifier.
WindowMotion window_motion(const SlidingRecord& record, const Window& window, const SlidingPoint& point,
                           double position, double velocity);

}  // namespace zerocount::sliding_identification
