#include "experiments/parameters/measured_parameters.hpp"

#include <algorithm>
#include <limits>

#include "core/friction/presliding/spring.hpp"
#include "core/numerics/elementary_functions.hpp"
#include "experiments/parameters/handles.hpp"

namespace zerocount::parameters {
namespace {

using From = MeasuredNumbers;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

constexpr std::string_view initial_stiffness = parameter::friction::measured::initial_stiffness;
constexpr std::string_view secant_stiffness = parameter::friction::measured::secant_stiffness;
constexpr std::string_view secant_travel = parameter::friction::measured::secant_travel;
constexpr std::string_view final_stiffness = parameter::friction::measured::final_stiffness;
constexpr std::string_view breakaway = parameter::friction::measured::breakaway;
constexpr std::string_view breakaway_travel = parameter::friction::measured::breakaway_travel;

/// The friction spring's parameters that are computed from a group of measured parameters. k2 and beta are
/// computed from all values of the group.
std::vector<DerivedParameter> spring_from(const std::vector<std::string_view>& names, double (*k2)(From),
                                          double (*beta)(From)) {
  return {{parameter::friction::k1, {final_stiffness}},
          {parameter::friction::k2, names, k2},
          {parameter::friction::beta, names, beta},
          {parameter::friction::breakaway, {breakaway}}};
}

MeasuredParameters spring_by_initial_stiffness() {
  static constexpr auto softening = [](From v) {
    enum : std::size_t { initial, final, torque, travel };
    return friction::softening_from(v[initial], v[final], {v[travel], v[torque]})
        .value_or(friction::Softening{nothing, nothing});
  };
  MeasuredParameters group{.section = "friction.measured",
                           .names = {initial_stiffness, final_stiffness, breakaway, breakaway_travel},
                           .own = 1,
                           .derived = {}};
  group.derived = spring_from(
      group.names, [](From v) { return softening(v).k2; }, [](From v) { return softening(v).beta; });
  group.conditions = {{"final_stiffness", "breakaway/breakaway_travel", "N m/rad",
                       [](From v) { return v[1]; }, [](From v) { return v[2] / v[3]; }},
                      {"breakaway/breakaway_travel", "initial_stiffness", "N m/rad",
                       [](From v) { return v[2] / v[3]; }, [](From v) { return v[0]; }}};
  return group;
}

MeasuredParameters spring_by_secant() {
  enum : std::size_t { stiffness, first, final, torque, last };
  static constexpr auto softening = [](From v) {
    return friction::softening_through({v[first], v[stiffness] * v[first]}, {v[last], v[torque]}, v[final])
        .value_or(friction::Softening{nothing, nothing});
  };
  MeasuredParameters group{
      .section = "friction.measured",
      .names = {secant_stiffness, secant_travel, final_stiffness, breakaway, breakaway_travel},
      .own = 2,
      .derived = {}};
  group.derived = spring_from(
      group.names, [](From v) { return softening(v).k2; }, [](From v) { return softening(v).beta; });
  group.conditions = {
      {"final_stiffness", "secant_stiffness", "N m/rad", [](From v) { return v[final]; },
       [](From v) { return v[stiffness]; }},
      {"secant_travel", "breakaway_travel", "rad", [](From v) { return v[first]; },
       [](From v) { return v[last]; }},
      {"breakaway/breakaway_travel", "secant_stiffness", "N m/rad",
       [](From v) { return v[torque] / v[last]; }, [](From v) { return v[stiffness]; }},
      {"secant_stiffness*secant_travel + final_stiffness*(breakaway_travel - secant_travel)", "breakaway",
       "N m", [](From v) { return v[stiffness] * v[first] + v[final] * (v[last] - v[first]); },
       [](From v) { return v[torque]; }}};
  return group;
}

MeasuredParameters measured_creep() {
  constexpr std::string_view torque = parameter::friction::measured::creep::torque;
  constexpr std::string_view extension = parameter::friction::measured::creep::extension;
  constexpr std::string_view rate = parameter::friction::measured::creep::rate;
  constexpr std::string_view exponent = parameter::friction::measured::creep::exponent;
  return {.section = "friction.measured.creep",
          .names = {torque, extension, rate, exponent},
          .own = 4,
          .derived = {{parameter::friction::alpha, {rate}},
                      {parameter::friction::lambda,
                       {torque, extension, exponent},
                       [](From from) { return numerics::pow_of_draws(from[0], from[2]) / from[1]; }},
                      {parameter::friction::n, {exponent}}}};
}

}  // namespace

std::span<const MeasuredParameters> measured_parameters() {
  static const std::vector<MeasuredParameters> all{spring_by_initial_stiffness(), spring_by_secant(),
                                                   measured_creep()};
  return all;
}

bool is_measured(std::string_view name) {
  return std::ranges::any_of(measured_parameters(), [&](const MeasuredParameters& group) {
    return std::ranges::find(group.names, name) != group.names.end();
  });
}

}  // namespace zerocount::parameters
