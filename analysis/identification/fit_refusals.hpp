#pragma once

#include <span>
#include <string>

#include "analysis/identification/contact_fit.hpp"
#include "analysis/record_fit/residual_checks.hpp"

namespace zerocount::identification {

/// Sentence for a search that stopped at its effort limit, without the full stop.
std::string left_out_text(double effort);

// Checks of the records after a fit. Each throws Failure (bad_data) with the record, the place in it and
// the reason.

/// Refuses records with a single outlier (see find_glitch()).
void refuse_glitches(Records records, const FitPoint& point, const FitSetting& setting);

/// Refuses residuals whose root mean square exceeds 2 % of a record's travel and 2 counts.
/// @param tolerance factor on these limits
void refuse_unexplained(Records records, const ContactFit& fit, double tolerance);

/// Refuses a spread of the residuals of more than 30 times that of the simulated replicates.
/// @param cause a sentence that names a likely cause, without its full stop; may be empty
void refuse_gross_misfit(Records records, const ContactFit& fit, const record_fit::ResidualChecks& checks,
                         const std::string& cause);

}  // namespace zerocount::identification
