#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/joint_fit.hpp"

namespace zerocount {

/// What remains of the observations once a model is taken away, in units of their standard deviations, in the
/// order of time, record by record.
struct ResidualStatistics {
  double squares{0.0};  ///< sum of squares
  std::size_t observations{0};
  double runs{0.0};  ///< stretches of one sign
  /// 1 + 2·Σ ρ_j over the lags j up to the first that is not positive: by how much neighbours repeat each
  /// other.
  double correlation_length{1.0};
};

ResidualStatistics residual_statistics(const std::vector<double>& residuals);

/// (observed − modelled angle)/√variance of every observation; `step` goes from the model's point to the one
/// whose residuals are wanted, along the linearised model: empty for none.
std::vector<double> residuals_of(const FittedModel& model, const Observations& observations,
                                 const Eigen::VectorXd& step);

/// What comes out where records like those at hand are made up and fitted.
struct ReadingReplicates {
  Eigen::MatrixXd errors;  ///< [replicate, coordinate] estimate less truth; then the offsets
  std::vector<ResidualStatistics> residuals;  ///< [replicate]
};

/// The parametric bootstrap of the whole instrument: truths are drawn around the model's point, each truth's
/// path is read by the encoder with its steps and noise, and the readings are observed and fitted as the real
/// ones were, with the model linearised at its point.
///
/// This takes the place of the textbook formula (inverse of the normal matrix), because readings of an
/// encoder are no independent draws: the errors at successive edges of a steady ramp compensate each other,
/// and what an estimate owes to them depends on where the edges happen to lie. The truths are spread over
/// three times the textbook's standard deviations: far enough to meet all such cases, near enough for the
/// linearisation.
/// @param noise [record] of the readings, in the record's unit.
ReadingReplicates replicate_readings(std::span<const TestRecord> records, const FittedModel& model,
                                     const FitSetting& setting, const std::vector<double>& noise,
                                     std::size_t replicates);

}  // namespace zerocount
