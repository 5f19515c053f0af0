#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include <Eigen/Core>

#include "core/friction/parameters.hpp"
#include "core/motion/parameters.hpp"

namespace zerocount::identification {

/// The identified parameters of a rotor and its contact.
struct ContactParameters {
  motion::PlantParameters plant;
  friction::FrictionParameters friction;
};

/// The coordinates in which a contact is fitted. All but the last are logarithms, because the parameters are
/// positive and their uncertainty is relative.
enum Coordinate : std::size_t {
  log_k1,         ///< ln k1, of N m/rad
  log_k2,         ///< ln k2, of N m/rad
  log_beta,       ///< ln β, of 1/rad
  log_damping,    ///< ln c, of N m s/rad
  log_inertia,    ///< ln J, of kg m²
  log_alpha,      ///< ln α, of 1/s
  log_limit,      ///< ln(σ0ⁿ/λ), of rad: the hardening at which creep ends under the torque σ0
  creep_exponent  ///< n; a fit may pass through values below 1
};
inline constexpr std::size_t coordinate_count = 8;
/// coordinate_count as an Eigen index.
inline constexpr auto contact_dimension = static_cast<Eigen::Index>(coordinate_count);

/// Not aligned, so that structs that contain it need no special alignment.
using ContactPoint = Eigen::Matrix<double, coordinate_count, 1, Eigen::DontAlign>;

/// True for estimated coordinates; the others keep a given value.
using FreeCoordinates = std::array<bool, coordinate_count>;

/// Manifest key of the parameter of each coordinate; for log_limit it is friction.lambda.
inline constexpr std::array<std::string_view, coordinate_count> coordinate_keys{
    "friction.k1",   "friction.k2",    "friction.beta",   "plant.presliding_damping",
    "plant.inertia", "friction.alpha", "friction.lambda", "friction.n"};

/// @param creep_torque σ0, N m. It should be near the torques at which creep was observed; otherwise limit
/// and exponent are strongly correlated. @returns parameters whose breakaway torque is never reached.
ContactParameters contact_at(const ContactPoint& point, double creep_torque);

/// The inverse of contact_at, except for the breakaway torque.
ContactPoint point_of(const ContactParameters& contact, double creep_torque);

}  // namespace zerocount::identification
