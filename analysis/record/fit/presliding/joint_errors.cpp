#include <cmath>

#include <fmt/format.h>

#include "analysis/record/fit/presliding/contact_fit.hpp"
#include "analysis/record/fit/presliding/identification.hpp"
#include "analysis/record/fit/residuals.hpp"

namespace zerocount::fit {
namespace {

constexpr double min_exponent = 1.0;

/// [replicate, quantity] Errors of the quantities, each on its own scale (Quantity::value).
/// @param errors [replicate, coordinate] errors of the coordinates
Eigen::MatrixXd errors_of(std::span<const EstimatedQuantity> quantities, const Eigen::MatrixXd& errors) {
  Eigen::MatrixXd found(errors.rows(), static_cast<Eigen::Index>(quantities.size()));
  for (std::size_t j = 0; j < quantities.size(); ++j) {
    found.col(static_cast<Eigen::Index>(j)) =
        errors.leftCols(quantities[j].quantity.slope.size()) * quantities[j].quantity.slope;
  }
  return found;
}

/// Ratio of two distances from the estimated value; 1 if the second one is not positive.
double ratio_of(double distance, double of_replicates) {
  return of_replicates > 0.0 ? distance / of_replicates : 1.0;
}

double drawn_value(const EstimatedQuantity& estimated, double error, double widening) {
  const QuantityEstimate& linear = estimated.by_replicates;
  const QuantityEstimate& reported = estimated.reported;
  const double mean_error = estimated.quantity.value - linear.value;
  const double distance = -widening * (error - mean_error);
  const double scale = distance < 0.0 ? ratio_of(reported.value - reported.low, linear.value - linear.low)
                                      : ratio_of(reported.high - reported.value, linear.high - linear.value);
  const double value = reported.value + scale * distance;
  return estimated.quantity.logarithmic ? std::exp(value) : value;
}

bool is_valid(const EstimatedQuantity& estimated, double value) {
  if (!std::isfinite(value)) return false;
  return estimated.quantity.logarithmic ? value > 0.0 : value >= min_exponent;
}

}  // namespace

void append_draws(std::span<const EstimatedQuantity> quantities, const Eigen::MatrixXd& errors,
                  double widening, std::size_t max_rows, JointDraws& draws) {
  const Eigen::MatrixXd own = errors_of(quantities, errors);
  for (Eigen::Index i = 0; i < own.rows() && draws.rows.size() < max_rows; ++i) {
    std::vector<double> row;
    bool valid = true;
    for (std::size_t j = 0; j < quantities.size(); ++j) {
      row.push_back(drawn_value(quantities[j], own(i, static_cast<Eigen::Index>(j)), widening));
      valid = valid && is_valid(quantities[j], row.back());
    }
    if (valid) draws.rows.push_back(std::move(row));
  }
}

std::string reason_of_missing_draws(const JointDraws& draws, std::size_t wanted) {
  if (draws.keys.empty()) return "there is no parameter to draw";
  if (draws.rows.size() >= wanted) return "";
  return fmt::format("only {} of {} draws are valid; in the others n is less than {:g}, or a value overflows",
                     draws.rows.size(), wanted, min_exponent);
}

double JointErrors::correlation(Eigen::Index one, Eigen::Index other) const {
  if (one == other) return 1.0;
  return covariance(one, other) / std::sqrt(covariance(one, one) * covariance(other, other));
}

JointErrors joint_errors(std::span<const EstimatedQuantity> quantities, const Eigen::MatrixXd& errors,
                         double widening) {
  JointErrors joint;
  for (const EstimatedQuantity& estimated : quantities) joint.names.push_back(estimated.quantity.name);
  Eigen::MatrixXd own = errors_of(quantities, errors);
  own.rowwise() -= own.colwise().mean().eval();
  joint.covariance = widening * widening / static_cast<double>(errors.rows() - 1) * (own.transpose() * own);
  return joint;
}

}  // namespace zerocount::fit
