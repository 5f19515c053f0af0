#pragma once

#include <span>

#include "analysis/identification/contact_fit.hpp"
#include "analysis/identification/residual_checks.hpp"

namespace zerocount {

// What a fit shows of records that cannot serve. Each throws Failure (bad_data) with the record, the place in
// it and the reason.

/// No single reading is off the path alone (see find_glitch()).
void refuse_glitches(std::span<const TestRecord> records, const FitPoint& point, const FitSetting& setting);

/// The model leaves (root mean square) no more than 2 % of a record's travel, or 2 counts.
/// @param tolerance by what factor more is let pass.
void refuse_unexplained(std::span<const TestRecord> records, const ContactFit& fit, double tolerance);

/// The spread of the residuals is no more than 30 times what it is in records made up from the fit.
void refuse_gross_misfit(std::span<const TestRecord> records, const ContactFit& fit,
                         const ResidualChecks& checks);

/// The rotor swings on the spring k1 (N m/rad) with its inertia (kg m²) at 0.5 Hz to 20 kHz, unless the units
/// of all records are believed, or one of the two is not known (NaN).
void refuse_implausible_frequency(std::span<const TestRecord> records, double k1, double inertia);

}  // namespace zerocount
