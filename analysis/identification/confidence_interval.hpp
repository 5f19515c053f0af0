#pragma once

#include <vector>

#include "analysis/identification/contact_fit.hpp"
#include "analysis/record_fit/axis_model.hpp"

namespace zerocount::identification {

using record_fit::Quantity;
using record_fit::QuantityEstimate;

/// All reported quantities of a contact, in the order of the report: k1, k2, k1_plus_k2, beta,
/// presliding_damping, inertia, alpha, lambda, n, time_offset.
std::vector<Quantity> fitted_quantities(const record_fit::Point& point, double creep_torque);

/// The coordinate that a quantity depends on: the first of several.
Coordinate coordinate_of(const Quantity& quantity);

/// The interval by profile likelihood: its ends are the values at which the minimum sum of squares exceeds
/// that of the fit by the amount that the ends of `estimate` would have in a linear model. An end that is not
/// found within a factor of 4 (n: ± 2) is infinite. Only for quantities that are parameters of the manifest.
QuantityEstimate interval_by_profile(Records records, const ContactFit& fit, const Quantity& quantity,
                                     const QuantityEstimate& estimate);

}  // namespace zerocount::identification
