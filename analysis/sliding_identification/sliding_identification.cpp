#include "analysis/sliding_identification/sliding_identification.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "analysis/sliding_identification/sliding_fit.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/unknown.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::sliding_identification {
namespace {

using identification::EstimateStatus;
using identification::ParameterEstimate;

constexpr double max_log_halfwidth = 0.7;  // a factor of 2 to each side
constexpr double min_excess_ratio = 3.5;   // of the Stribeck excess to its standard error
constexpr double max_unexplained = 1.0 / 3.0;

bool both_directions(const std::vector<SlidingRecord>& records) {
  bool forward = false;
  bool backward = false;
  for (const SlidingRecord& record : records) {
    for (const Window& window : record.windows) {
      forward = forward || window.direction > 0.0;
      backward = backward || window.direction < 0.0;
    }
  }
  return forward && backward;
}

SlidingSummary summary_of(const SlidingRecord& record) {
  SlidingSummary summary;
  summary.name = record.name;
  summary.samples = record.time.size();
  summary.duration = record.time.back();
  summary.resolution = record.resolution;
  summary.strokes = record.strokes.size();
  summary.windows = record.windows.size();
  summary.min_velocity = record.max_velocity;
  summary.max_velocity = record.max_velocity;
  for (const Window& window : record.windows) {
    summary.used += samples_of(window);
    for (std::size_t k = window.first; k <= window.last; ++k) {
      summary.min_velocity = std::min(summary.min_velocity, std::abs(record.velocity[k]));
    }
  }
  return summary;
}

double torque_rms(const std::vector<SlidingRecord>& records) {
  double squares = 0.0;
  std::size_t samples = 0;
  for (const SlidingRecord& record : records) {
    for (const Window& window : record.windows) {
      samples += samples_of(window);
      for (std::size_t k = window.first; k <= window.last; ++k) {
        squares += record.torque[k].now * record.torque[k].now;
      }
    }
  }
  return std::sqrt(squares / static_cast<double>(samples));
}

/// The fit with the Stribeck curve, if the records show one.
std::optional<SlidingFit> stribeck_fit(const std::vector<SlidingRecord>& records, const SlidingFit& without,
                                       double slowest, double fastest) {
  constexpr int candidates = 12;
  double best = 0.0;
  SlidingPoint start = without.point;
  for (int i = 0; i < candidates; ++i) {
    // Between the slowest velocity and half of the fastest, in equal ratios.
    const double velocity =
        slowest * std::pow(std::max(0.5 * fastest / slowest, 1.0), (i + 0.5) / candidates);
    const double gain = stribeck_gain(records, without, velocity);
    if (gain <= best) continue;
    best = gain;
    start[log_stribeck_velocity] = std::log(velocity);
  }
  constexpr double needed = min_excess_ratio * min_excess_ratio;  // by independent residuals
  if (best < needed * without.squares / static_cast<double>(without.samples)) return std::nullopt;
  FreeParameters free = without.free;
  free[stribeck_excess] = free[log_stribeck_velocity] = true;
  start[stribeck_excess] = 0.1 * std::abs(start[coulomb_level]);
  SlidingFit fit;
  try {
    fit = fit_sliding(records, start, free);
  } catch (const Failure&) {
    return std::nullopt;  // the fit without the curve remains
  }
  const double excess_error = std::sqrt(fit.covariance(stribeck_excess, stribeck_excess));
  const double velocity_error = std::sqrt(fit.covariance(log_stribeck_velocity, log_stribeck_velocity));
  const double ratio = fit.point[stribeck_excess] / excess_error;
  constexpr double two_sided = 2.0;
  if (ratio < min_excess_ratio || !(velocity_error < max_log_halfwidth / two_sided)) return std::nullopt;
  return fit;
}

/// The estimates of one fit.
class Estimates {
 public:
  Estimates(const SlidingFit& fit, bool linear) : fit_(fit), linear_(linear) {
    const double freedom =
        std::max(1.0, static_cast<double>(fit.windows) - static_cast<double>(sliding_dimension));
    quantile_ = statistics::student_t_quantile(freedom, 0.975);
  }

  ParameterEstimate inertia() const {
    return logarithmic(named("inertia", "plant.inertia", linear_ ? "kg" : "kg m^2"), log_inertia,
                       "the velocity hardly changes; accelerate more");
  }

  ParameterEstimate sliding_damping() const {
    ParameterEstimate estimate =
        linear_combination(named("sliding_damping", "plant.sliding_damping", linear_ ? "N s/m" : "N m s/rad"),
                           slope(viscous_damping));
    if (half_width(estimate) <= max_log_halfwidth * estimate.value && estimate.low > 0.0) return estimate;
    return open(estimate,
                fmt::format("it shows too little at these velocities: with 95 % confidence it is at most "
                            "{:.3g} {}; move at velocities that differ more",
                            std::max(estimate.high, 0.0), estimate.unit));
  }

  ParameterEstimate coulomb() const {
    return positive(linear_combination(named("coulomb_level", "", torque_unit()), slope(coulomb_level)),
                    "the velocities differ too little to tell it from the viscous damping");
  }

  ParameterEstimate breakaway_level(bool stribeck) const {
    SlidingPoint both = slope(coulomb_level);
    both[stribeck_excess] = 1.0;
    ParameterEstimate estimate = named("breakaway_level", "friction.breakaway", torque_unit());
    if (!stribeck) return open(estimate, no_stribeck());
    return positive(linear_combination(estimate, both), "the slow motion is too short");
  }

  ParameterEstimate coulomb_ratio(bool stribeck) const {
    ParameterEstimate estimate = named("coulomb_ratio", "friction.coulomb_ratio", "1");
    if (!stribeck) return open(estimate, no_stribeck());
    const double level = fit_.point[coulomb_level] + fit_.point[stribeck_excess];
    SlidingPoint gradient = SlidingPoint::Zero();
    gradient[coulomb_level] = fit_.point[stribeck_excess] / (level * level);
    gradient[stribeck_excess] = -fit_.point[coulomb_level] / (level * level);
    estimate.value = fit_.point[coulomb_level] / level;
    set_interval(estimate, gradient);
    return estimate;
  }

  ParameterEstimate stribeck_velocity(bool stribeck) const {
    ParameterEstimate estimate =
        named("stribeck_velocity", "friction.stribeck_velocity", linear_ ? "m/s" : "rad/s");
    if (!stribeck) return open(estimate, no_stribeck());
    return logarithmic(estimate, log_stribeck_velocity, "the slow motion is too short");
  }

  ParameterEstimate offset(bool both) const {
    ParameterEstimate estimate = named("offset", "", torque_unit());
    if (!both)
      return open(estimate, "the motion has one direction, in which it is part of the Coulomb level");
    return linear_combination(estimate, slope(offset_torque));
  }

 private:
  static ParameterEstimate named(const char* name, const char* key, const char* unit) {
    ParameterEstimate estimate;
    estimate.name = name;
    estimate.key = key;
    estimate.unit = unit;
    estimate.status = EstimateStatus::estimated;
    return estimate;
  }

  const char* torque_unit() const { return linear_ ? "N" : "N m"; }
  static double half_width(const ParameterEstimate& estimate) { return 0.5 * (estimate.high - estimate.low); }
  static const char* no_stribeck() {
    return "the friction does not visibly fall with the velocity; sliding shows no more than the Coulomb "
           "level";
  }

  static SlidingPoint slope(SlidingCoordinate coordinate) {
    SlidingPoint slope = SlidingPoint::Zero();
    slope[coordinate] = 1.0;
    return slope;
  }

  static ParameterEstimate open(ParameterEstimate estimate, const std::string& reason) {
    estimate.status = EstimateStatus::not_identifiable;
    estimate.reason = reason;
    estimate.value = estimate.standard_error = estimate.low = estimate.high = statistics::unknown;
    return estimate;
  }

  void set_interval(ParameterEstimate& estimate, const SlidingPoint& gradient) const {
    estimate.standard_error = std::sqrt(gradient.dot(fit_.covariance * gradient));
    estimate.low = estimate.value - quantile_ * estimate.standard_error;
    estimate.high = estimate.value + quantile_ * estimate.standard_error;
  }

  ParameterEstimate linear_combination(ParameterEstimate estimate, const SlidingPoint& weights) const {
    estimate.value = weights.dot(fit_.point);
    set_interval(estimate, weights);
    return estimate;
  }

  static ParameterEstimate positive(const ParameterEstimate& estimate, const std::string& reason) {
    const bool known = estimate.low > 0.0 && half_width(estimate) <= max_log_halfwidth * estimate.value;
    return known ? estimate : open(estimate, reason);
  }

  ParameterEstimate logarithmic(ParameterEstimate estimate, SlidingCoordinate coordinate,
                                const std::string& reason) const {
    estimate = linear_combination(estimate, slope(coordinate));
    if (!(half_width(estimate) <= max_log_halfwidth)) return open(estimate, reason);
    estimate.value = std::exp(estimate.value);
    estimate.standard_error *= estimate.value;
    estimate.low = std::exp(estimate.low);
    estimate.high = std::exp(estimate.high);
    return estimate;
  }

  const SlidingFit& fit_;
  bool linear_;
  double quantile_{0.0};
};

void set_correlation(const SlidingFit& fit, SlidingIdentification& result) {
  constexpr std::array names{"inertia", "coulomb_level", "sliding_damping",
                             "offset",  "excess",        "stribeck_velocity"};
  std::vector<Eigen::Index> index;
  for (std::size_t j = 0; j < sliding_dimension; ++j) {
    if (!fit.free[j]) continue;
    index.push_back(static_cast<Eigen::Index>(j));
    result.correlated.emplace_back(names[j]);
  }
  const auto count = static_cast<Eigen::Index>(index.size());
  result.correlation.resize(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      result.correlation(i, j) =
          fit.covariance(index[i], index[j]) /
          std::sqrt(fit.covariance(index[i], index[i]) * fit.covariance(index[j], index[j]));
    }
  }
}

void refuse_unexplained(const SlidingIdentification& result) {
  if (result.unexplained_torque <= max_unexplained * result.torque) return;
  throw Failure(
      ExitCode::bad_data,
      fmt::format("{}: inertia and sliding friction do not explain the motion: they leave {:.3g} of {:.3g} "
                  "{} (root mean square). Are the units right, is there another mass or a spring, was the "
                  "torque limited?",
                  result.records.front().name, result.unexplained_torque, result.torque,
                  result.linear ? "N" : "N m"));
}

/// A fit, and whether it has the Stribeck curve.
struct ChosenFit {
  SlidingFit fit;
  bool stribeck{false};
};

ChosenFit chosen_fit(const std::vector<SlidingRecord>& records, bool both, double slowest, double fastest) {
  FreeParameters free{};
  free[log_inertia] = free[coulomb_level] = free[viscous_damping] = true;
  free[offset_torque] = both;
  const SlidingFit fit = fit_sliding(records, starting_point(records, both), free);
  const std::optional<SlidingFit> with_stribeck = stribeck_fit(records, fit, slowest, fastest);
  return with_stribeck ? ChosenFit{*with_stribeck, true} : ChosenFit{fit, false};
}

double misfit_of(const SlidingFit& fit) {
  return std::sqrt(fit.squares / static_cast<double>(fit.samples));
}

}  // namespace

SlidingIdentification identify_sliding(std::vector<SlidingRecord> records) {
  SlidingIdentification result;
  result.linear = records.front().linear;
  double slowest = records.front().max_velocity;
  double fastest = 0.0;
  for (const SlidingRecord& record : records) {
    result.records.push_back(summary_of(record));
    slowest = std::min(slowest, result.records.back().min_velocity);
    fastest = std::max(fastest, result.records.back().max_velocity);
  }
  const bool both = both_directions(records);
  ChosenFit chosen = chosen_fit(records, both, slowest, fastest);
  for (std::size_t samples = max_window_samples / 4;
       misfit_of(chosen.fit) > 1.0 && samples >= min_window_samples; samples /= 4) {
    for (SlidingRecord& record : records) cut_windows(record, samples);
    chosen = chosen_fit(records, both, slowest, fastest);
  }
  const SlidingFit& fit = chosen.fit;
  const bool stribeck = chosen.stribeck;
  for (std::size_t i = 0; i < records.size(); ++i) result.records[i].windows = records[i].windows.size();
  result.misfit = misfit_of(fit);
  result.unexplained_torque = fit.unexplained_torque;
  result.torque = torque_rms(records);
  refuse_unexplained(result);
  const Estimates estimates(fit, result.linear);
  result.parameters = {estimates.inertia(),
                       estimates.sliding_damping(),
                       estimates.coulomb(),
                       estimates.breakaway_level(stribeck),
                       estimates.coulomb_ratio(stribeck),
                       estimates.stribeck_velocity(stribeck),
                       estimates.offset(both)};
  set_correlation(fit, result);
  return result;
}

}  // namespace zerocount::sliding_identification
