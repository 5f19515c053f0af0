#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/record/sliding_identification/sliding_fit.hpp"
#include "core/numerics/interval.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::sliding_identification {
namespace {

using fit::EstimateStatus;
using fit::ParameterEstimate;

enum class Scale { linear, positive, logarithmic };

/// A reported parameter as a function of the fitted parameters.
struct Quantity {
  std::string name;
  std::string_view key;  ///< Manifest key of the parameter; empty if the manifest has none.
  const char* unit;      ///< Unit of the parameter on a rotary axis; it is converted for a linear one.
  /// Index of the fitted parameter that must be free, so that this one can be reported.
  std::size_t coordinate;
  double value;           ///< Value of the parameter; its logarithm if the scale is logarithmic.
  SlidingPoint gradient;  ///< Gradient of `value` with respect to the point.
  Scale scale;
  /// Text for the user if the interval of the parameter is too wide to identify it. Placeholder {0} is the
  /// upper end of the interval, {1} the unit.
  const char* vague;
  /// Name of a position-dependent torque that the records cannot distinguish from this one; empty: none.
  std::string alike{};
  /// True if motion in one direction only cannot separate the parameter from the constant offset torque.
  bool with_offset{false};
};

/// Allowed range of a reported parameter. The range of the Coulomb level is that of a breakaway torque,
/// because the level is a breakaway torque times a ratio.
numerics::Interval range_of(const Quantity& quantity) {
  const std::string_view key =
      quantity.name == "coulomb_level" ? parameter::friction::breakaway.path : quantity.key;
  const auto row = parameters::find_parameter(key);
  return row ? parameters::parameter_table()[*row].range : numerics::all_numbers();
}

/// Appends the amplitude and phase of the position-dependent torque A·sin(κ·x + phase), or its slope, to the
/// reported parameters.
/// @param number index of the torque in SlidingFit::waves
void add_wave(const SlidingFit& fit, std::size_t number, std::vector<Quantity>& quantities) {
  const PositionWave& wave = fit.waves[number];
  const auto first = static_cast<Eigen::Index>(position_amplitudes + 2 * number);
  const SlidingPoint& point = fit.point;
  const std::optional<PositionWave> other = alike_wave(fit, number);
  const std::string alike = other ? name_of(*other) : "";
  const double sine = point[first];
  const double cosine = point[first + 1];
  const SlidingPoint of_sine = SlidingPoint::Unit(first);
  const SlidingPoint of_cosine = SlidingPoint::Unit(first + 1);
  const auto coordinate = static_cast<std::size_t>(first);
  if (wave.periods == 0.0) {
    quantities.push_back(
        {name_of(wave), "", "N m/rad", coordinate, -sine, -of_sine, Scale::linear, "", alike});
    return;
  }
  const double amplitude = std::hypot(sine, cosine);
  const char* vague = "the record moves over too small a part of its period";
  quantities.push_back({name_of(wave) + ".amplitude", "", "N m", coordinate, amplitude,
                        (sine * of_sine + cosine * of_cosine) / amplitude, Scale::positive, vague, alike});
  quantities.push_back({name_of(wave) + ".phase", "", "rad", coordinate, std::atan2(-cosine, -sine),
                        (sine * of_cosine - cosine * of_sine) / (amplitude * amplitude), Scale::linear, "",
                        alike});
}

std::vector<Quantity> quantities_of(const SlidingFit& fit) {
  const SlidingPoint& point = fit.point;
  const double coulomb = point[coulomb_level];
  const double excess = point[stribeck_excess];
  const double level = coulomb + excess;
  const SlidingPoint of_coulomb = SlidingPoint::Unit(coulomb_level);
  const SlidingPoint of_excess = SlidingPoint::Unit(stribeck_excess);
  const SlidingPoint of_ratio = (excess * of_coulomb - coulomb * of_excess) / (level * level);
  std::vector<Quantity> quantities{
      {"inertia", parameter::plant::inertia, "kg m^2", log_inertia, point[log_inertia],
       SlidingPoint::Unit(log_inertia), Scale::logarithmic, "the velocity hardly changes; accelerate more"},
      {"sliding_damping", parameter::plant::sliding_damping, "N m s/rad", viscous_damping,
       point[viscous_damping], SlidingPoint::Unit(viscous_damping), Scale::positive,
       "it shows too little at these velocities: with 95 % confidence it is at most {0:.3g} {1}; move at "
       "velocities that differ more"},
      {"coulomb_level", "", "N m", coulomb_level, coulomb, of_coulomb, Scale::positive,
       "the velocities differ too little to distinguish it from the viscous damping"},
      {"breakaway_level", parameter::friction::breakaway, "N m", stribeck_excess, level,
       of_coulomb + of_excess, Scale::positive, "the slow motion is too short"},
      {"coulomb_ratio", parameter::friction::coulomb_ratio, "1", stribeck_excess, coulomb / level, of_ratio,
       Scale::linear, ""},
      {"stribeck_velocity", parameter::friction::stribeck_velocity, "rad/s", log_stribeck_velocity,
       point[log_stribeck_velocity], SlidingPoint::Unit(log_stribeck_velocity), Scale::logarithmic,
       "the slow motion is too short"},
      {"offset", "", "N m", offset_torque, point[offset_torque], SlidingPoint::Unit(offset_torque),
       Scale::linear, ""}};
  for (Quantity& quantity : quantities)
    for (const char* name : {"coulomb_level", "breakaway_level", "coulomb_ratio"})
      quantity.with_offset = quantity.with_offset || quantity.name == name;
  Quantity& offset = quantities.back();
  for (std::size_t i = 0; i < fit.waves.size(); ++i)
    if (const auto other = alike_wave(fit, i)) offset.alike = name_of(*other);
  for (std::size_t i = 0; i < fit.waves.size(); ++i) add_wave(fit, i, quantities);
  return quantities;
}

/// Whether the confidence interval of the parameter spans at most a factor of about 2 to each side.
bool is_narrow(const ParameterEstimate& estimate, Scale scale) {
  switch (scale) {
    case Scale::positive:
      return estimate.low > 0.0 && estimate.half_width() <= fit::max_half_width(true) * estimate.value;
    case Scale::logarithmic:
      return estimate.half_width() <= fit::max_half_width(true);
    case Scale::linear:
      break;
  }
  return true;
}

/// The estimate of a reported parameter, with an interval that spans `quantile` standard errors to each side.
ParameterEstimate estimate_within(const Quantity& quantity, const SlidingFit& fit, double quantile) {
  ParameterEstimate estimate;
  estimate.value = quantity.value;
  estimate.standard_error = std::sqrt(quantity.gradient.dot(fit.covariance * quantity.gradient));
  estimate.low = estimate.value - quantile * estimate.standard_error;
  estimate.high = estimate.value + quantile * estimate.standard_error;
  return estimate;
}

double quantile_of(const SlidingFit& fit, double probability) {
  const double freedom =
      std::max(1.0, static_cast<double>(fit.windows.size()) - static_cast<double>(sliding_dimension));
  return statistics::student_t_quantile(freedom, probability);
}

/// Whether the wide interval of the parameter (missed by chance once in 1000 records) contains no allowed
/// value.
bool is_impossible(const Quantity& quantity, const SlidingFit& fit) {
  if (!fit.free[quantity.coordinate] || quantity.scale == Scale::logarithmic) return false;
  if (quantity.with_offset && !fit.free[offset_torque]) return false;
  constexpr double chance = 1e-3;
  const ParameterEstimate wide = estimate_within(quantity, fit, quantile_of(fit, 1.0 - 0.5 * chance));
  const numerics::Interval range = range_of(quantity);
  return wide.high < range.low || wide.low > range.high;
}

std::string value_and_range(const Quantity& quantity, const ParameterEstimate& estimate) {
  return fmt::format("the fit gives {:.3g} [{:.3g}, {:.3g}] {}, which is not {}", estimate.value,
                     estimate.low, estimate.high, estimate.unit, numerics::range_text(range_of(quantity)));
}

ParameterEstimate estimate_of(const Quantity& quantity, const SlidingFit& fit, parameters::AxisKind axis) {
  ParameterEstimate estimate = estimate_within(quantity, fit, quantile_of(fit, 0.975));
  estimate.name = quantity.name;
  estimate.key = quantity.key;
  estimate.unit = quantity.name.ends_with("phase") ? quantity.unit : parameters::unit_on(axis, quantity.unit);
  estimate.status = EstimateStatus::estimated;
  const std::string torque = parameters::text_on(axis, "$torque");
  if (!fit.free[quantity.coordinate]) {
    leave_open(estimate,
               quantity.coordinate == offset_torque
                   ? "the motion has one direction, in which it is part of the Coulomb level"
                   : "the friction does not visibly fall with the velocity; sliding shows no more than the "
                     "Coulomb level");
    return estimate;
  }
  if (quantity.with_offset && !fit.free[offset_torque]) {
    leave_open(estimate,
               quantity.name == "coulomb_level"
                   ? fmt::format("the motion has one direction, in which an offset of the {} cannot be "
                                 "distinguished from it: together they are {:.4g} [{:.4g}, {:.4g}] {}",
                                 torque, estimate.value, estimate.low, estimate.high, estimate.unit)
                   : fmt::format("the motion has one direction, in which an offset of the {} cannot be "
                                 "distinguished from the Coulomb level",
                                 torque));
    return estimate;
  }
  if (!quantity.alike.empty()) {
    leave_open(estimate,
               fmt::format("over so small a part of a {} it cannot be distinguished from {}; move farther",
                           axis == parameters::AxisKind::linear ? "pitch" : "revolution", quantity.alike));
    return estimate;
  }
  const numerics::Interval range = range_of(quantity);
  if (is_impossible(quantity, fit)) {
    leave_open(estimate, value_and_range(quantity, estimate));
  } else if (!is_narrow(estimate, quantity.scale)) {
    leave_open(estimate,
               fmt::format(fmt::runtime(quantity.vague), std::max(estimate.high, 0.0), estimate.unit));
  } else if (quantity.scale == Scale::logarithmic) {
    estimate.value = std::exp(estimate.value);
    estimate.standard_error *= estimate.value;
    estimate.low = std::exp(estimate.low);
    estimate.high = std::exp(estimate.high);
  } else if (!numerics::contains(range, estimate.value)) {
    leave_open(estimate, value_and_range(quantity, estimate));
  } else {
    estimate.low = std::max(estimate.low, range.low);
    estimate.high = std::min(estimate.high, range.high);
  }
  return estimate;
}

}  // namespace

std::vector<ParameterEstimate> estimates_of(const SlidingFit& fit, parameters::AxisKind axis) {
  std::vector<ParameterEstimate> estimates;
  for (const Quantity& quantity : quantities_of(fit)) estimates.push_back(estimate_of(quantity, fit, axis));
  return estimates;
}

std::string impossible_parameter(const SlidingFit& fit, parameters::AxisKind axis) {
  for (const Quantity& quantity : quantities_of(fit)) {
    if (!is_impossible(quantity, fit)) continue;
    ParameterEstimate estimate = estimate_within(quantity, fit, quantile_of(fit, 0.975));
    estimate.unit = parameters::unit_on(axis, quantity.unit);
    return fmt::format("for {} {}: the axis does not follow this law", quantity.name,
                       value_and_range(quantity, estimate));
  }
  return "";
}

}  // namespace zerocount::sliding_identification
