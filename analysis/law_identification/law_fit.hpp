#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/law_identification/law_model.hpp"
#include "analysis/record_fit/joint_fit.hpp"
#include "analysis/record_fit/reading_replicates.hpp"
#include "analysis/record_fit/residual_checks.hpp"

namespace zerocount::law_identification {

/// Squares in multiples of those of another law from which a law is not searched further.
inline constexpr double hopeless = 100.0;

/// A law fitted to records.
struct LawFit {
  record_fit::FitSetting setting;
  record_fit::FittedModel model;
  std::vector<double> noise;  ///< [record] of the readings, in the record's unit; 0: counts without noise
  record_fit::Observations observations;
  /// [record] residuals of all readings that are not masked, of the fit to them, in the record's unit
  std::vector<std::vector<double>> residuals;
  double squares{0.0};  ///< of the fit to all readings, over the variance of a count
  bool converged{false};
};

/// Fits a law by non-linear least squares: first to all readings with equal weights, a few steps from the
/// best of the starting points and to the end from the best of these; then to the observations
/// (record_fit::observe()), in three rounds.
/// A law whose best starting points leave a hundred times the squares of another one is fitted with fewer
/// steps, and without a search among its local minima.
/// @param least_squares of the laws fitted before; infinite without any
/// @throws Failure (bad_data) if the law cannot be simulated from any of its starting points.
LawFit fit_law(Records records, const LawModel& model, double least_squares);

/// Fits a law whose fit `found` does not explain the records again, from many more starting points, scattered
/// at random about those of the law and about `found`. @returns the better fit of both.
LawFit search_again(Records records, const LawModel& model, double least_squares, LawFit found);

/// The errors of a fit.
struct LawErrors {
  Eigen::MatrixXd errors;  ///< see record_fit::ReadingReplicates
  record_fit::ResidualChecks checks;
};

/// 300 replicates of the readings (record_fit::replicate_readings()).
LawErrors errors_of(Records records, const LawFit& fit);

}  // namespace zerocount::law_identification
