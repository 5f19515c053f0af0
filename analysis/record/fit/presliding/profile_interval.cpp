#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/record/fit/presliding/contact.hpp"
#include "analysis/record/fit/presliding/contact_fit.hpp"

namespace zerocount::fit {
namespace {

/// The coordinates of the same contact for another torque scale σ0 of the creep.
/// @param before, after old and new σ0, N m
Point with_creep_torque(Point point, double before, double after) {
  point[log_limit] += point[creep_exponent] * std::log(after / before);
  return point;
}

/// Profile likelihood: the minimum sum of squares as a function of one coordinate, minimised over the others.
class ProfileLikelihood {
 public:
  ProfileLikelihood(Records records, const ContactFit& fit, Coordinate coordinate)
      : records_(records),
        fit_(fit),
        setting_(fit.setting),
        start_(fit.model.point),
        coordinate_(coordinate) {
    if (coordinate == log_limit) {  // at 1 N m the coordinate is −ln λ for every n
      start_.axis = with_creep_torque(start_.axis, fit.creep_torque, 1.0);
      setting_.prior = with_creep_torque(setting_.prior, fit.creep_torque, 1.0);
      setting_.model = contact_model(1.0);
    }
    const FitResult best = fit_jointly(records_, fit_.observations, start_, setting_);
    start_ = best.point;
    least_ = best.squares;
    const Eigen::MatrixXd covariance =
        textbook_covariance(model_at(records_, start_, setting_), fit_.observations, setting_);
    variance_ = covariance(coordinate, coordinate);
    follow_ = covariance.col(coordinate) / variance_;
  }

  /// The change of the coordinate at which the minimum sum of squares exceeds that of the fit by
  /// distance²/variance; null if this is not found within a change of `max_distance`.
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
    start.axis += (follow_.head(contact_dimension) * change).cwiseMin(max_step).cwiseMax(-max_step);
    start.offset += follow_.tail(start.offset.size()) * change;
    start.axis[coordinate_] = start_.axis[coordinate_] + change;
    return fit_jointly(records_, fit_.observations, start, setting).squares;
  }

  Records records_;
  const ContactFit& fit_;
  FitSetting setting_;
  FitPoint start_;
  Coordinate coordinate_;
  double least_{0.0};
  double variance_{1.0};
  Eigen::VectorXd follow_;  // change of all unknowns per change of the coordinate
};

}  // namespace

Coordinate coordinate_of(const Quantity& quantity) {
  Eigen::Index first = 0;
  while (quantity.slope[first] == 0.0) ++first;
  return static_cast<Coordinate>(first);
}

QuantityEstimate interval_by_profile(Records records, const ContactFit& fit, const Quantity& quantity,
                                     const QuantityEstimate& estimate) {
  const Coordinate coordinate = coordinate_of(quantity);
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

}  // namespace zerocount::fit
