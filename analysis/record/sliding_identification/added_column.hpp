#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/record/sliding_identification/sliding_fit.hpp"

namespace zerocount::sliding_identification {

/// Normal equations of a least-squares fit with one added column (a tried regressor, first) and the free
/// parameters of the fit, over a part of the samples.
struct Equations {
  Eigen::MatrixXd information;
  Eigen::VectorXd right;
  double squares{0.0};  ///< Sum of squares of the residuals without the added column.

  void operator+=(const Equations& other);
};

/// Coefficient of a regressor (column) that is added to a fit of the sliding axis, from one Gauss–Newton
/// step, with its significance.
struct AddedColumn {
  double coefficient{0.0};
  double gain{0.0};  ///< Decrease of the sum of squares of the residuals by the column.
  /// Proportion of the sum of squares of the residuals that the column explains.
  double explained{0.0};
  double white{0.0};  ///< Variance of the residuals when the column is in the fit.
  /// Variance that independent residuals would need to give the coefficient the standard error of the
  /// jackknife over parts.
  double clustered{0.0};
  /// Effective number of parts (clusters of samples) behind the jackknife's standard error.
  double clusters{0.0};
  Eigen::VectorXd shift;  ///< [free parameter] Change of the parameter when the column is added.
};

/// Adds a regressor (column) to a fit by one Gauss–Newton step and estimates its coefficient with a jackknife
/// over parts of the samples.
///
/// The effective number of parts is (Σ I)²/Σ I², with I the information of a part on the coefficient: a
/// column that acts in a few parts has as few degrees of freedom (Carter, Schnepel and Steigerwald, Review of
/// Economics and Statistics 99 (2017) 698).
/// @param parts normal equations of parts of the samples that are independent of each other
/// @param freedom degrees of freedom: number of samples minus number of all parameters
AddedColumn added_column(std::span<const Equations> parts, double freedom);

/// Significance of the added column: ratio of its coefficient to its jackknife standard error, divided by the
/// ratio that chance exceeds with the probability `chance`. Above 1 the coefficient is significant.
double ratio_to_chance(const AddedColumn& column, double chance, double freedom);

/// The residuals of the least-squares regression of each of `columns` on `others`.
Eigen::MatrixXd without(const Eigen::MatrixXd& others, const Eigen::MatrixXd& columns);

/// Derivatives of the residuals of a window (a piece of a record simulated from its own initial state) with
/// respect to the free parameters, one column each; the last column holds the residuals.
Eigen::MatrixXd free_slopes(const WindowSlopes& slopes, const FreeParameters& free);

}  // namespace zerocount::sliding_identification
