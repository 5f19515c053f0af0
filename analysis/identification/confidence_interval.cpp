#include "analysis/identification/confidence_interval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace zerocount::identification {
namespace {

FittedQuantity of_coordinate(std::string_view name, std::string_view unit, Coordinate coordinate,
                             const ContactPoint& contact) {
  FittedQuantity quantity{name, coordinate_keys[coordinate], unit, {coordinate}, contact[coordinate], {},
                          true};
  quantity.slope.setZero();
  quantity.slope[coordinate] = 1.0;
  return quantity;
}

FittedQuantity sum_of_stiffnesses(const ContactPoint& contact) {
  const double k1 = std::exp(contact[log_k1]);
  const double k2 = std::exp(contact[log_k2]);
  FittedQuantity quantity{"k1_plus_k2", "", "N m/rad", {log_k1, log_k2}, std::log(k1 + k2), {}, true};
  quantity.slope.setZero();
  quantity.slope[log_k1] = k1 / (k1 + k2);
  quantity.slope[log_k2] = k2 / (k1 + k2);
  return quantity;
}

FittedQuantity hardening_modulus(const ContactPoint& contact, double creep_torque) {
  const double logarithm = std::log(creep_torque);
  FittedQuantity quantity = of_coordinate("lambda", "(N m)^n/rad", log_limit, contact);
  quantity.coordinates.push_back(creep_exponent);
  quantity.value = contact[creep_exponent] * logarithm - contact[log_limit];
  quantity.slope[log_limit] = -1.0;
  quantity.slope[creep_exponent] = logarithm;
  return quantity;
}

/// Quantile of the errors, interpolated between order statistics.
double quantile_of(std::vector<double>& errors, double probability) {
  std::sort(errors.begin(), errors.end());
  const double rank = probability * static_cast<double>(errors.size() + 1) - 1.0;
  const auto below = static_cast<std::size_t>(std::clamp(rank, 0.0, static_cast<double>(errors.size() - 2)));
  const double between = std::clamp(rank - static_cast<double>(below), 0.0, 1.0);
  return errors[below] + between * (errors[below + 1] - errors[below]);
}

/// The coordinates of the same contact with another σ0.
ContactPoint with_creep_torque(ContactPoint point, double before, double after) {
  point[log_limit] += point[creep_exponent] * std::log(after / before);
  return point;
}

/// Profile likelihood: the minimum sum of squares as a function of one coordinate, minimised over the others.
class ProfileLikelihood {
 public:
  ProfileLikelihood(std::span<const TestRecord> records, const ContactFit& fit, Coordinate coordinate)
      : records_(records),
        fit_(fit),
        setting_(fit.setting),
        start_(fit.model.point),
        coordinate_(coordinate) {
    if (coordinate == log_limit) {  // at 1 N m the coordinate is −ln λ for every n
      start_.contact = with_creep_torque(start_.contact, setting_.creep_torque, 1.0);
      setting_.prior = with_creep_torque(setting_.prior, setting_.creep_torque, 1.0);
      setting_.creep_torque = 1.0;
    }
    const FitResult best = fit_jointly(records_, fit_.observations, start_, setting_);
    start_ = best.point;
    least_ = best.squares;
    const Eigen::MatrixXd covariance =
        textbook_covariance(model_at(records_, start_, setting_), fit_.observations, setting_);
    variance_ = covariance(coordinate, coordinate);
    follow_ = covariance.col(coordinate) / variance_;
  }

  /// The change of the coordinate at which the sum exceeds its minimum by distance²/variance; nothing if that
  /// is not found within `max_distance`.
  std::optional<double> end(double distance, double max_distance) {
    const double target = distance * distance / variance_;
    constexpr int max_tries = 10;
    constexpr double close_enough = 0.02;
    double at = distance;
    for (int i = 0; i < max_tries; ++i) {
      const double ratio = std::sqrt(std::max(squares_at(at) - least_, 0.0) / target);
      if (std::abs(ratio - 1.0) < close_enough) return at;
      at /= std::clamp(ratio, 0.4, 2.5);
      if (std::abs(at) > max_distance) return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  double squares_at(double change) {
    FitSetting setting = setting_;
    setting.free[coordinate_] = false;
    setting.max_steps = 10;
    FitPoint start = start_;
    // Limits the step of poorly determined coordinates; the fit moves them further if needed.
    constexpr double max_step = 1.0;
    start.contact += (follow_.head<contact_dimension>() * change).cwiseMin(max_step).cwiseMax(-max_step);
    start.offset += follow_.tail(start.offset.size()) * change;
    start.contact[coordinate_] = start_.contact[coordinate_] + change;
    return fit_jointly(records_, fit_.observations, start, setting).squares;
  }

  std::span<const TestRecord> records_;
  const ContactFit& fit_;
  FitSetting setting_;
  FitPoint start_;
  Coordinate coordinate_;
  double least_{0.0};
  double variance_{1.0};
  Eigen::VectorXd follow_;  // change of all unknowns per change of the coordinate
};

}  // namespace

std::vector<FittedQuantity> fitted_quantities(const FitPoint& point, double creep_torque) {
  const ContactPoint& contact = point.contact;
  FittedQuantity exponent = of_coordinate("n", "1", creep_exponent, contact);
  exponent.logarithmic = false;
  FittedQuantity offset = of_coordinate("time_offset", "samples", time_offset, contact);
  offset.logarithmic = false;
  return {of_coordinate("k1", "N m/rad", log_k1, contact),
          of_coordinate("k2", "N m/rad", log_k2, contact),
          sum_of_stiffnesses(contact),
          of_coordinate("beta", "1/rad", log_beta, contact),
          of_coordinate("presliding_damping", "N m s/rad", log_damping, contact),
          of_coordinate("inertia", "kg m^2", log_inertia, contact),
          of_coordinate("alpha", "1/s", log_alpha, contact),
          hardening_modulus(contact, creep_torque),
          exponent,
          offset};
}

QuantityEstimate interval_of_errors(double value, const Eigen::VectorXd& errors, double widening) {
  const double mean = errors.mean();
  const Eigen::VectorXd wide = (mean + widening * (errors.array() - mean)).matrix();
  std::vector<double> sorted(wide.data(), wide.data() + wide.size());
  QuantityEstimate estimate;
  estimate.value = value - mean;
  estimate.standard_error =
      std::sqrt((wide.array() - mean).square().sum() / static_cast<double>(wide.size() - 1));
  estimate.low = value - quantile_of(sorted, 0.975);
  estimate.high = value - quantile_of(sorted, 0.025);
  return estimate;
}

QuantityEstimate interval_by_replicates(const FittedQuantity& quantity, const ReadingReplicates& replicates,
                                        double widening) {
  return interval_of_errors(quantity.value, replicates.errors.leftCols<contact_dimension>() * quantity.slope,
                            widening);
}

QuantityEstimate interval_by_profile(std::span<const TestRecord> records, const ContactFit& fit,
                                     const FittedQuantity& quantity, const QuantityEstimate& estimate) {
  const Coordinate coordinate = quantity.coordinates.front();
  const double max_distance = quantity.logarithmic ? std::log(4.0) : 2.0;
  const double sense = quantity.slope[coordinate] < 0.0 ? -1.0 : 1.0;  // of λ and its coordinate
  constexpr double infinity = std::numeric_limits<double>::infinity();
  ProfileLikelihood profile(records, fit, coordinate);
  const auto end = [&](double linear) {
    const std::optional<double> found = profile.end(sense * (linear - quantity.value), max_distance);
    return found ? quantity.value + sense * *found : std::copysign(infinity, linear - quantity.value);
  };
  QuantityEstimate result = estimate;
  result.value = quantity.value;
  result.low = end(estimate.low);
  result.high = end(estimate.high);
  return result;
}

}  // namespace zerocount::identification
