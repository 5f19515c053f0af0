#pragma once

#include <string>

#include <Eigen/Core>

#include "analysis/record_fit/axis_model.hpp"

namespace zerocount::record_fit {

/// A reported quantity: a linear or nearly linear function of the coordinates.
struct Quantity {
  std::string name;
  std::string key;         ///< of its parameter in a manifest; empty: none
  std::string unit;        ///< on a rotary axis
  double value{0.0};       ///< at the fit: its logarithm, or itself
  Eigen::VectorXd slope;   ///< derivatives of `value` with respect to the coordinates
  bool logarithmic{true};  ///< whether `value` is a logarithm
};

/// A quantity whose logarithm is one of the coordinates.
Quantity coordinate_quantity(const std::string& name, const std::string& key, const std::string& unit,
                             const Point& point, Eigen::Index coordinate);

/// The time offset, the last coordinate.
Quantity time_offset_quantity(const Point& point);

/// Value and 95 % interval of a quantity, on its own scale (see Quantity::value).
struct QuantityEstimate {
  double value{0.0};
  double standard_error{0.0};
  double low{0.0};
  double high{0.0};

  double half_width() const { return 0.5 * (high - low); }
};

/// The interval of a quantity from the errors of replicates of the fit, multiplied by `widening` about their
/// mean.
/// @param errors [replicate, coordinate]; further columns are left out
QuantityEstimate interval_of_errors(const Quantity& quantity, const Eigen::MatrixXd& errors, double widening);

/// Largest half-width of a 95 % interval of a quantity that the records determine: of a logarithm a factor of
/// two to each side, of n or the time offset (samples) 1.
inline double max_half_width(bool logarithmic) {
  return logarithmic ? 0.7 : 1.0;
}

/// The estimate on the scale of the parameter: the exponential of a logarithm; n at least 1.
QuantityEstimate on_parameter_scale(const Quantity& quantity, QuantityEstimate estimate);

}  // namespace zerocount::record_fit
