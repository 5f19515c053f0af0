#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "analysis/fit/model.hpp"
#include "core/friction/parameters.hpp"
#include "core/motion/parameters.hpp"
#include "experiments/parameters/handles.hpp"

namespace zerocount::fit {

struct ContactFit;

/// The identified parameters of a rotor and its contact.
struct ContactParameters {
  motion::PlantParameters plant;
  friction::FrictionParameters friction;
};

/// The coordinates in which a contact is fitted. The parameters of the contact are logarithms, except for n,
/// because they are positive and their uncertainty is relative. The last coordinate belongs to the records.
enum Coordinate : std::size_t {
  log_k1,          ///< ln k1, of N m/rad
  log_k2,          ///< ln k2, of N m/rad
  log_beta,        ///< ln β, of 1/rad
  log_damping,     ///< ln c, of N m s/rad
  log_inertia,     ///< ln J, of kg m²
  log_alpha,       ///< ln α, of 1/s
  log_limit,       ///< ln(σ0ⁿ/λ), of rad: the hardening at which creep ends under the torque σ0
  creep_exponent,  ///< n; a fit may pass through values below 1
  time_offset      ///< samples by which the torque acts later than recorded; common to all records
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

/// @param creep_torque σ0, N m. It should be near the torques at which creep was observed; otherwise limit
/// and exponent are strongly correlated. @returns parameters whose breakaway torque is never reached.
ContactParameters contact_at(const Point& point, double creep_torque);

/// The pre-sliding model as a function of these coordinates. Its quantities, in the order of the report, are
/// k1, k2, k1_plus_k2, beta, presliding_damping, inertia, alpha, lambda, n and time_offset.
FitModel contact_model(double creep_torque);

/// The inverse of contact_at, except for the breakaway torque, with a time offset of 0.
Point point_of(const ContactParameters& contact, double creep_torque);

/// The coordinate that a quantity depends on: the first of several.
Coordinate coordinate_of(const Quantity& quantity);

/// The interval by profile likelihood. At its ends the minimum sum of squares exceeds the sum of squares of
/// the fit as much as a linear model does at the ends of `estimate`. An end that is not found within a factor
/// of 4 (n: ± 2) is infinite. Only for quantities that are parameters of the manifest.
QuantityEstimate interval_by_profile(Records records, const ContactFit& fit, const Quantity& quantity,
                                     const QuantityEstimate& estimate);

}  // namespace zerocount::fit
