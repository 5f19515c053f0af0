#include "analysis/identification/contact_coordinates.hpp"

#include <cmath>

#include <fmt/format.h>

namespace zerocount::identification {

namespace {

/// Breakaway torque in multiples of σ0, above all torques of a record, so that the hook never slides.
constexpr double breakaway_factor = 1e3;

}  // namespace

ContactParameters contact_at(const ContactPoint& point, double creep_torque) {
  ContactParameters contact;
  contact.friction.k1 = std::exp(point[log_k1]);
  contact.friction.k2 = std::exp(point[log_k2]);
  contact.friction.beta = std::exp(point[log_beta]);
  contact.plant.presliding_damping = std::exp(point[log_damping]);
  contact.plant.inertia = std::exp(point[log_inertia]);
  contact.friction.alpha = std::exp(point[log_alpha]);
  contact.friction.n = point[creep_exponent];
  contact.friction.lambda = std::exp(contact.friction.n * std::log(creep_torque) - point[log_limit]);
  contact.friction.breakaway = breakaway_factor * creep_torque;
  return contact;
}

record_fit::AxisModel contact_model(double creep_torque) {
  // Far beyond, simulations become very slow. The limit of creep may vanish, which does not slow them.
  constexpr double max_change = 4.6;  // a factor of 100
  constexpr double max_creep_decrease = 14.0;
  constexpr double min_exponent = 0.2;
  constexpr double max_exponent = 20.0;
  record_fit::AxisModel model;
  model.coordinates.assign(coordinate_count, {.max_decrease = max_change, .max_increase = max_change});
  model.coordinates[log_limit].max_decrease = max_creep_decrease;
  model.coordinates[creep_exponent] = {.low = min_exponent, .high = max_exponent};
  model.coordinates[time_offset] = record_fit::time_offset_range();
  model.parameters_at = [creep_torque](const record_fit::Point& point) {
    const ContactParameters contact = contact_at(point, creep_torque);
    return record_fit::AxisParameters{contact.plant, {contact.friction, {}}};
  };
  return model;
}

ContactPoint point_of(const ContactParameters& contact, double creep_torque) {
  ContactPoint point = ContactPoint::Zero();
  point[log_k1] = std::log(contact.friction.k1);
  point[log_k2] = std::log(contact.friction.k2);
  point[log_beta] = std::log(contact.friction.beta);
  point[log_damping] = std::log(contact.plant.presliding_damping);
  point[log_inertia] = std::log(contact.plant.inertia);
  point[log_alpha] = std::log(contact.friction.alpha);
  point[creep_exponent] = contact.friction.n;
  point[log_limit] = contact.friction.n * std::log(creep_torque) - std::log(contact.friction.lambda);
  return point;
}

namespace {

constexpr double min_exponent = 1.0;

/// [replicate, quantity] errors of the quantities on their own scales.
Eigen::MatrixXd errors_of(std::span<const EstimatedQuantity> quantities, const Eigen::MatrixXd& errors) {
  Eigen::MatrixXd found(errors.rows(), static_cast<Eigen::Index>(quantities.size()));
  for (std::size_t j = 0; j < quantities.size(); ++j) {
    found.col(static_cast<Eigen::Index>(j)) =
        errors.leftCols(quantities[j].quantity.slope.size()) * quantities[j].quantity.slope;
  }
  return found;
}

/// The ratio of two distances from the value; 1 where the second is none.
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

}  // namespace zerocount::identification
