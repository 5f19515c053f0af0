#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/record/fit/presliding/contact.hpp"
#include "analysis/record/fit/residuals.hpp"
#include "analysis/record/fit/solver.hpp"

namespace zerocount::fit {

/// A friction or plant parameter whose value the user has given, so that it is not fitted.
struct KnownParameter {
  /// Coordinate of the fit that belongs to the parameter, see coordinate_keys.
  Coordinate coordinate{log_k1};
  double value{0.0};  ///< Value in the parameter's own unit.
};

/// Called with the name of each stage of a computation when it begins, for messages; may be empty.
using StageReport = std::function<void(std::string_view)>;

/// A friction contact fitted to records.
struct ContactFit : Fit {
  double creep_torque{1.0};  ///< Torque scale σ0 to which the creep coordinates refer, N m.
  double effort{1.0};        ///< Factor on the search effort (1: usual), see fit_contact().
};

/// Root mean square of the residuals of a record's readings, in the record's unit. Quantisation alone gives
/// 0.29.
double misfit_of(Records records, const Fit& fit, std::size_t record);

/// Torque scale σ0 of the creep coordinates for these records, N m: 1 N m if λ is known, because the
/// coordinate is then ln(1/λ) for every n; otherwise 0.7 of the largest torque.
double creep_torque_for(Records records, const std::vector<KnownParameter>& known);

/// Fits the contact to all records together. First a rough fit from the starting point, to all readings with
/// equal weights, which converges from far away. Then fits to the observations (see observe()), repeated with
/// updated observations until the fit no longer changes.
/// @throws Failure (bad_data) if a single reading is an outlier, the model does not explain a record, or the
/// fit ends at a rotor that cannot be simulated.
/// @param effort factor on the number of simulated samples after which no other starting points are tried
ContactFit fit_contact(Records records, const std::vector<KnownParameter>& known,
                       const StageReport& report = {}, double effort = 1.0);

/// True if the search for other starting points ended at its effort limit.
bool has_ended_early(const ContactFit& fit);

/// Repeats the fit with the time offset fixed at 0, so that the torque acts with the delay that the record
/// states.
void keep_time_offset(Records records, ContactFit& fit);

/// Repeats the fit from other values of β and keeps the fit with the smallest spread of residuals. A spring
/// that softens within a count or two has little influence on the rough fit, which may end far away. Records
/// that consist of slow parts only are not fitted again, because the fit of the slow parts has already
/// searched β.
/// @returns whether `fit` changed.
bool improve_softening(Records records, ContactFit& fit);

/// The reason why the records do not determine a coordinate, derived from their parts: a clause that
/// completes "because …".
std::string missing_information(Records records, const ContactFit& fit, Coordinate coordinate);

/// Sentence that says that the search stopped at this effort limit, without the full stop.
std::string left_out_text(double effort);

// Checks of the records after a fit. Each throws Failure (bad_data) with the record, the place in it and
// the reason.

/// Throws a Failure if a record has a single reading that is an outlier (see find_glitch()).
void refuse_glitches(Records records, const FitPoint& point, const FitSetting& setting);

/// Throws a Failure if the root mean square of the residuals exceeds 2 % of a record's travel and 2 counts.
/// @param tolerance factor on both limits
void refuse_unexplained(Records records, const ContactFit& fit, double tolerance);

/// Throws a Failure if the spread of the residuals is more than 30 times the spread of the simulated
/// replicates.
/// @param cause a sentence that names a likely cause, without its full stop; may be empty
void refuse_gross_misfit(Records records, const ContactFit& fit, const ResidualChecks& checks,
                         const std::string& cause);

}  // namespace zerocount::fit
