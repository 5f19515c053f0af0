#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/identification/contact_fit.hpp"
#include "analysis/identification/reading_replicates.hpp"

namespace zerocount {

/// A quantity whose estimate is reported: a function of the coordinates that is linear, or nearly so.
struct FittedQuantity {
  std::string_view name;
  std::string_view key;  ///< in a manifest; empty for k1 + k2
  std::string_view unit;
  std::vector<Coordinate> coordinates;  ///< that it depends on
  double value{0.0};                    ///< at the fit: the logarithm of the quantity, but of n itself
  ContactPoint slope;                   ///< its derivatives with respect to the coordinates
  bool logarithmic{true};               ///< whether `value` is a logarithm
};

/// All of them, at a fit, in the order of the report.
std::vector<FittedQuantity> fitted_quantities(const FitPoint& point, double creep_torque);

/// Value and 95 % interval of a quantity, on its own scale (see FittedQuantity::value).
struct QuantityEstimate {
  double value{0.0};
  double standard_error{0.0};
  double low{0.0};
  double high{0.0};
};

/// By the errors of the replicates, stretched by `widening` about their mean.
QuantityEstimate interval_by_replicates(const FittedQuantity& quantity, const ReadingReplicates& replicates,
                                        double widening);

/// The interval by profile likelihood: the values at which the least sum of squares exceeds that of the fit
/// by as much as the ends of `estimate` would if the model were linear. An end that is not found within a
/// factor of 4 (n: within 2) is infinite. For quantities that are a parameter of the manifest.
QuantityEstimate interval_by_profile(std::span<const TestRecord> records, const ContactFit& fit,
                                     const FittedQuantity& quantity, const QuantityEstimate& estimate);

}  // namespace zerocount
