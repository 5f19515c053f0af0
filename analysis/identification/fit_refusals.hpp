#pragma once

#include <span>

#include "analysis/identification/contact_fit.hpp"
#include "analysis/identification/residual_checks.hpp"

namespace zerocount::identification {

// Checks of the records after a fit. Each throws Failure (bad_data) with the record, the place in it and the
// // reason.

/// Refuses records with a single outlier (see find_glitch()).
void refuse_glitches(std::span<const TestRecord> records, const FitPoint& point, const FitSetting& setting);

/// Refuses residuals whose root mean square exceeds 2 % of a record's travel and 2 counts.
/// @param tolerance factor on these limits
void refuse_unexplained(std::span<const TestRecord> records, const ContactFit& fit, double tolerance);

/// Refuses a spread of the residuals of more than 30 times that of the simulated replicates.
void refuse_gross_misfit(std::span<const TestRecord> records, const ContactFit& fit,
                         const ResidualChecks& checks);

/// Refuses a natural frequency of k1 (N m/rad) and inertia (kg m²) outside 0.5 Hz to 20 kHz. No check if the
/// units of all records are trusted or one of the two values is NaN.
void refuse_implausible_frequency(std::span<const TestRecord> records, double k1, double inertia);

}  // namespace zerocount::identification
