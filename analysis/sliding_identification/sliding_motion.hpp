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
  position_amplitudes,    ///< the first of those of the position's waves, N m or N (of a slope N/m)
  sliding_dimension = position_amplitudes + position_terms
};

using SlidingPoint = Eigen::Matrix<double, sliding_dimension, 1>;

/// The positions of a simulated sliding motion less the readings in a window, in units of the resolution. The
/// parameters are the first coordinates of a SlidingPoint, as many as the record's waves need, and the
/// initial position and velocity.
///
/// The motion is J·dω/dt = u − u0 − p(θ) − cs·ω − d·g(ω), dθ/dt = ω, the law of
/// core/friction/sliding/sliding.hpp with an offset and with the torques p of the record's waves, by the
/// classical Runge–Kutta method, with steps of at most a sampling interval and a twentieth of the time
/// constants of the friction and of the amplifier. The derivatives are those of these steps, by forward
/// automatic differentiation. p is taken at the positions that were read: their errors are small beside a
/// wave, and p is then known but for its amplitudes. The evaluation fails where the motion is not finite.
/// @param record and @param window must outlive the result.
std::unique_ptr<ceres::CostFunction> window_residuals(const SlidingRecord& record, const Window& window);

}  // namespace zerocount::sliding_identification
