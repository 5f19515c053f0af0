#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "analysis/record/fit/model.hpp"
#include "core/friction/parameters.hpp"
#include "core/motion/parameters.hpp"
#include "experiments/parameters/handles.hpp"

namespace zerocount::fit {

struct ContactFit;

/// The parameters of a rotor and its friction contact that an identification estimates.
struct ContactParameters {
  motion::PlantParameters plant;
  friction::FrictionParameters friction;
};

/// The coordinates in which a contact is fitted. The parameters of the contact are logarithms, except for n,
/// because they are positive and their uncertainty is relative. The last coordinate belongs to the records.
enum Coordinate : std::size_t {
  log_k1,       ///< ln k1: logarithm of the contact's tangent stiffness k1 long after a reversal, in N m/rad
  log_k2,       ///< ln k2: logarithm of the additional stiffness k2 just after a reversal, in N m/rad
  log_beta,     ///< ln β: logarithm of the rate β at which the stiffness falls from k1 + k2 to k1, in 1/rad
  log_damping,  ///< ln c: logarithm of the pre-sliding damping c in N m s/rad
  log_inertia,  ///< ln J: logarithm of the inertia J in kg m²
  log_alpha,    ///< ln α: logarithm of the creep rate α in 1/s
  /// ln(σ0ⁿ/λ), of rad: logarithm of the creep extension (hardening) at which creep ends under the torque σ0
  log_limit,
  creep_exponent,  ///< creep exponent n; a fit may pass through values below 1
  time_offset  ///< time offset: samples by which the torque acts later than recorded; common to all records
};
inline constexpr std::size_t coordinate_count = 9;
/// coordinate_count as an Eigen index.
inline constexpr auto contact_dimension = static_cast<Eigen::Index>(coordinate_count);

/// Name of each coordinate: the manifest key of its parameter (friction.lambda for log_limit), and
/// "time_offset", which is not a parameter of a manifest.
inline constexpr std::array<std::string_view, coordinate_count> coordinate_keys{
    parameter::friction::k1,
    parameter::friction::k2,
    parameter::friction::beta,
    parameter::plant::presliding_damping,
    parameter::plant::inertia,
    parameter::friction::alpha,
    parameter::friction::lambda,
    parameter::friction::n,
    "time_offset"};

/// Converts the coordinates of a fit to parameters of the contact.
/// @param creep_torque torque scale σ0 of the coordinates, N m. It should be near the torques at which creep
/// was observed; otherwise limit and exponent are strongly correlated.
/// @returns parameters whose breakaway torque is never reached
ContactParameters contact_at(const Point& point, double creep_torque);

/// The fit model of the pre-sliding law in the coordinates of Coordinate. Its quantities, in the order of the
/// report, are k1, k2, k1_plus_k2, beta, presliding_damping, inertia, alpha, lambda, n and time_offset.
/// @param creep_torque torque scale σ0 of the coordinates, N m
FitModel contact_model(double creep_torque);

/// Converts parameters of a contact to the coordinates of a fit: the inverse of contact_at(), except for the
/// breakaway torque, with a time offset of 0.
Point point_of(const ContactParameters& contact, double creep_torque);

/// The coordinate on which a quantity depends; the first one if there are several.
Coordinate coordinate_of(const Quantity& quantity);

/// The 95 % interval of a quantity by profile likelihood. At its ends the minimum sum of squares exceeds the
/// sum of squares of the fit as much as a linear model does at the ends of `estimate`. An end that is not
/// found within a factor of 4 (n: ± 2) is infinite. Only for quantities that are parameters of the manifest.
QuantityEstimate interval_by_profile(Records records, const ContactFit& fit, const Quantity& quantity,
                                     const QuantityEstimate& estimate);

}  // namespace zerocount::fit
