#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/confidence_interval.hpp"

namespace zerocount::identification {

/// A sample of the joint distribution of the estimated parameters.
struct JointDraws {
  std::vector<std::string> keys;          ///< in a manifest, one for each column
  std::vector<std::vector<double>> rows;  ///< [draw][column] in the parameter's own unit
};

/// An estimated parameter of the manifest with its intervals, on the quantity's own scale.
struct EstimatedQuantity {
  Quantity quantity;
  QuantityEstimate by_replicates;  ///< see record_fit::interval_of_errors()
  QuantityEstimate reported;       ///< the same, or the profile's
};

/// Appends one draw for each row of `errors` (see ReadingReplicates): with the error e of a replicate, whose
/// mean is ē, and the widening w, the draw is value − w·(e − ē). Where the reported interval is the
/// profile's, the distances above and below the value are scaled to its two ends. Both are monotonic, so that
/// the rank correlations are those of the replicates. Draws with n < 1 are left out.
/// @param max_rows ends the draws
void append_draws(std::span<const EstimatedQuantity> quantities, const Eigen::MatrixXd& errors,
                  double widening, std::size_t max_rows, JointDraws& draws);

/// Reason why there are fewer draws than wanted; empty if there are as many.
std::string reason_of_missing_draws(const JointDraws& draws, std::size_t wanted);

/// Covariance of the errors of estimated quantities, on their own scales: of logarithms, except for n and the
/// time offset.
struct JointErrors {
  std::vector<std::string> names;
  Eigen::MatrixXd covariance;  ///< [names, names]

  double correlation(Eigen::Index one, Eigen::Index other) const;
};

/// The covariance of the errors of replicates, widened.
JointErrors joint_errors(std::span<const EstimatedQuantity> quantities, const Eigen::MatrixXd& errors,
                         double widening);

}  // namespace zerocount::identification
