#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/identification/joint_fit.hpp"
#include "analysis/identification/record_parts.hpp"

namespace zerocount {

/// A parameter that is known from elsewhere.
struct KnownParameter {
  Coordinate coordinate{log_k1};  ///< whose coordinate_keys entry it is
  double value{0.0};              ///< in the parameter's own unit
};

/// A contact fitted to records.
struct ContactFit {
  FitSetting setting;
  FittedModel model;
  Observations observations;  ///< [record]
  std::vector<double> noise;  ///< [record] of the readings, in the record's unit; 0 for counts without noise
  /// Root mean square of what the model leaves of the readings, each record in its unit: 0.29 where it is the
  /// width of a count alone.
  std::vector<double> misfit;
};

/// σ0 of the coordinates for these records: 1 N m where λ is known, because the coordinate is then ln(1/λ)
/// whatever n; otherwise 0.7 of the largest torque, N m.
double creep_torque_for(std::span<const TestRecord> records, const std::vector<KnownParameter>& known);

/// Fits the contact to all records together: from the starting point, first by all readings alike, which
/// leads near from far away, then by the observations that the readings really are, made anew until they no
/// longer change the fit.
/// @throws Failure (bad_data) where a single reading is off, the model does not explain a record, or the fit
/// ends at a rotor that cannot be simulated.
ContactFit fit_contact(std::span<const TestRecord> records, std::span<const RecordParts> parts,
                       const std::vector<KnownParameter>& known);

/// Fits from other rates of softening, and keeps what leaves a smaller spread of residuals: a spring that
/// softens within a count or two is hardly seen by the fit to all readings alike, which may end far off.
/// @returns whether `fit` is another now.
bool improve_softening(std::span<const TestRecord> records, ContactFit& fit);

}  // namespace zerocount
