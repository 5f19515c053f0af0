#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/identification/residual_checks.hpp"
#include "analysis/law_identification/law_motion.hpp"

namespace zerocount::law_identification {

/// A law fitted to records.
struct LawFit {
  LawUnknowns at;
  std::vector<LawMotion> motions;  ///< [record] at the fit; the paths include the phases
  std::vector<double> noise;  ///< [record] of the readings, in the record's unit; 0: counts without noise
  Observations observations;
  /// [record] residuals of all readings that are not masked, of the fit to them, in the record's unit
  std::vector<std::vector<double>> residuals;
  bool converged{false};
};

/// Fits a law by non-linear least squares: first to all readings with equal weights, a few steps from the
/// best of the starting points and to the end from the best of these; then to the observations
/// (identification::observe()), in three rounds.
/// @throws Failure (bad_data) if the law cannot be simulated from any of its starting points.
LawFit fit_law(Records records, const LawModel& model);

/// The errors of a fit.
struct LawErrors {
  Eigen::MatrixXd errors;  ///< [replicate, coordinate] fit − truth
  identification::ResidualChecks checks;
};

/// A parametric bootstrap: replicates of the readings are simulated from the fitted model, read by the same
/// encoder and fitted in the linearised model, as by identification::replicate_readings().
LawErrors errors_of(Records records, const LawModel& model, const LawFit& fit);

}  // namespace zerocount::law_identification
