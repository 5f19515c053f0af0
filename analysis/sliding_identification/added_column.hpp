#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/sliding_identification/sliding_fit.hpp"

namespace zerocount::sliding_identification {

/// Normal equations of one added column and the free parameters of a fit, in that order, over a part of the
/// samples.
struct Equations {
  Eigen::MatrixXd information;
  Eigen::VectorXd right;
  double squares{0.0};  ///< Sum of squares of the residuals.

  void operator+=(const Equations& other);
};

/// Coefficient of a column that one step of Gauss and Newton adds to a fit.
struct AddedColumn {
  double coefficient{0.0};
  double gain{0.0};  ///< Decrease of the sum of squares of the residuals by the column.
  /// Proportion of the sum of squares of the residuals that the column explains.
  double explained{0.0};
  double white{0.0};      ///< Variance of the residuals with the column in the fit.
  double clustered{0.0};  ///< Variance of independent residuals that would cause the jackknife's error.
  double clusters{0.0};   ///< Effective number of parts behind the jackknife's error.
  Eigen::VectorXd shift;  ///< [free parameter] Change of the parameter when the column is added.
};

/// Adds a column to a fit.
///
/// The effective number of parts is (Σ I)²/Σ I², with I the information of a part on the coefficient: a
/// column that acts in a few parts has as few degrees of freedom (Carter, Schnepel and Steigerwald, Review of
/// Economics and Statistics 99 (2017) 698).
/// @param freedom number of samples less all parameters
AddedColumn added_column(std::span<const Equations> parts, double freedom);

/// Ratio of the coefficient to its jackknife error, divided by the ratio that chance exceeds with the
/// probability `chance`. Above 1 the coefficient is significant.
double ratio_to_chance(const AddedColumn& column, double chance, double freedom);

/// The residuals of the regression of `columns` on `others`.
Eigen::MatrixXd without(const Eigen::MatrixXd& others, const Eigen::MatrixXd& columns);

/// Derivatives of the residuals of a window with respect to the free parameters; the last column holds the
/// residuals.
Eigen::MatrixXd free_slopes(const WindowSlopes& slopes, const FreeParameters& free);

}  // namespace zerocount::sliding_identification
