#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "analysis/identification/contact_fit.hpp"
#include "analysis/identification/reading_replicates.hpp"

namespace zerocount::identification {

/// A reported quantity: a linear or nearly linear function of the coordinates.
struct FittedQuantity {
  std::string_view name;
  std::string_view key;  ///< of coordinate_keys; empty for k1 + k2
  std::string_view unit;
  std::vector<Coordinate> coordinates;  ///< coordinates that it depends on
  double value{0.0};       ///< at the fit: the logarithm of the quantity; for n and the offset it itself
  ContactPoint slope;      ///< its derivatives with respect to the coordinates
  bool logarithmic{true};  ///< whether `value` is a logarithm
};

/// All reported quantities at a fit, in the order of the report.
std::vector<FittedQuantity> fitted_quantities(const FitPoint& point, double creep_torque);

/// Value and 95 % interval of a quantity, on its own scale (see FittedQuantity::value).
struct QuantityEstimate {
  double value{0.0};
  double standard_error{0.0};
  double low{0.0};
  double high{0.0};
};

/// The interval of a quantity with the value `value` in a fit, from the errors of replicates of the fit,
/// multiplied by `widening` about their mean.
QuantityEstimate interval_of_errors(double value, const Eigen::VectorXd& errors, double widening);

/// The interval from the errors of the replicates, multiplied by `widening` about their mean.
QuantityEstimate interval_by_replicates(const FittedQuantity& quantity, const ReadingReplicates& replicates,
                                        double widening);

/// The interval by profile likelihood: its ends are the values at which the minimum sum of squares exceeds
/// that of the fit by the amount that the ends of `estimate` would have in a linear model. An end that is not
/// found within a factor of 4 (n: ± 2) is infinite. Only for quantities that are parameters of the manifest.
QuantityEstimate interval_by_profile(std::span<const TestRecord> records, const ContactFit& fit,
                                     const FittedQuantity& quantity, const QuantityEstimate& estimate);

}  // namespace zerocount::identification
