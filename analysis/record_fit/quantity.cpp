#include "analysis/record_fit/quantity.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/statistics/quantile.hpp"

namespace zerocount::record_fit {

Quantity coordinate_quantity(const std::string& name, const std::string& key, const std::string& unit,
                             const Point& point, Eigen::Index coordinate) {
  Quantity quantity{name, key, unit, point[coordinate], Eigen::VectorXd::Zero(point.size()), true};
  quantity.slope[coordinate] = 1.0;
  return quantity;
}

Quantity time_offset_quantity(const Point& point) {
  Quantity quantity = coordinate_quantity("time_offset", "", "samples", point, point.size() - 1);
  quantity.logarithmic = false;
  return quantity;
}

QuantityEstimate interval_of_errors(const Quantity& quantity, const Eigen::MatrixXd& errors,
                                    double widening) {
  const Eigen::VectorXd own = errors.leftCols(quantity.slope.size()) * quantity.slope;
  const double mean = own.mean();
  const Eigen::VectorXd wide = (mean + widening * (own.array() - mean)).matrix();
  std::vector<double> sorted(wide.data(), wide.data() + wide.size());
  std::sort(sorted.begin(), sorted.end());
  QuantityEstimate estimate;
  estimate.value = quantity.value - mean;
  estimate.standard_error =
      std::sqrt((wide.array() - mean).square().sum() / static_cast<double>(wide.size() - 1));
  estimate.low = quantity.value - statistics::interpolated_quantile(sorted, 0.975);
  estimate.high = quantity.value - statistics::interpolated_quantile(sorted, 0.025);
  return estimate;
}

QuantityEstimate on_parameter_scale(const Quantity& quantity, QuantityEstimate estimate) {
  if (quantity.logarithmic) {
    const double value = std::exp(estimate.value);
    return {value, value * estimate.standard_error, std::exp(estimate.low), std::exp(estimate.high)};
  }
  if (quantity.key != "friction.n") return estimate;
  constexpr double min_exponent = 1.0;
  for (double* number : {&estimate.value, &estimate.low, &estimate.high}) {
    *number = std::max(*number, min_exponent);
  }
  return estimate;
}

}  // namespace zerocount::record_fit
