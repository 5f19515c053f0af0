#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "core/friction/presliding/spring.hpp"
#include "core/numerics/elementary_functions.hpp"
#include "experiments/guides/guide_manifest.hpp"
#include "experiments/parameters/handles.hpp"

namespace zerocount::guides {
namespace {

constexpr double gravity = 9.81;  // m/s²

const GuideNumber& number_of(const Guide& guide, std::string_view quantity) {
  return *find_number(guide, quantity);  // a guide with a load has all of them: test Guides
}

Origin of_both(const GuideNumber& a, const GuideNumber& b) {
  return a.origin == Origin::published && b.origin == Origin::published ? Origin::published : Origin::assumed;
}

std::string from(std::string_view formula, const GuideNumber& number) {
  return fmt::format("{}; {}: {}", formula, number.quantity, number.source);
}

bool is_parameter(const GuideNumber& number) {
  return number.quantity.find('.') != std::string_view::npos;
}

/// The friction spring of a guide, with the values from which other parameters are computed.
struct GuideSpring {
  double force{0.0};              ///< breakaway force, N
  double travel{0.0};             ///< travel from rest up to breakaway, m
  double initial_stiffness{0.0};  ///< initial stiffness k1 + k2 of the spring, N/m
  std::vector<GuideNumber> parameters;
};

/// The friction spring of a guide whose friction grows with the load, at the geometric centres of the ranges
/// in the guide's table.
GuideSpring loaded_spring(const Guide& guide, const GuideLoad& load) {
  const double normal_force = load.preload + gravity * load.mass;
  const GuideNumber& coefficient = number_of(guide, friction_coefficient);
  const GuideNumber& constant = number_of(guide, constant_resistance);
  const GuideNumber& travel = number_of(guide, presliding_travel);
  const GuideNumber& softening = number_of(guide, softening_length);
  const GuideNumber& early = number_of(guide, early_part);

  const GuideNumber breakaway{
      parameter::friction::breakaway,
      "N",
      coefficient.low * normal_force + constant.low,
      coefficient.high * normal_force + constant.high,
      of_both(coefficient, constant),
      from(from("friction coefficient·(preload + weight) + constant resistance", coefficient), constant)};
  const double force = centre(breakaway);
  const double late_force = (1.0 - centre(early)) * force;
  const GuideNumber k1{parameter::friction::k1,  "N/m",
                       late_force / travel.high, late_force / travel.low,
                       Origin::assumed,          from("(1 - early part)·breakaway / travel", travel)};
  const double per_early_part = 2.0 * force / centre(softening);
  const GuideNumber k2{
      parameter::friction::k2,     "N/m",           per_early_part * early.low,
      per_early_part * early.high, Origin::assumed, from("2·early part·breakaway / softening length", early)};
  const GuideNumber beta{parameter::friction::beta, "1/m",
                         1.0 / softening.high,      1.0 / softening.low,
                         softening.origin,          from("1 / softening length", softening)};
  return {force, centre(travel), centre(k1) + centre(k2), {k1, k2, beta, breakaway}};
}

GuideSpring measured_spring(const MeasuredSpring& measured, parameters::AxisKind axis) {
  const double highest = highest_final_stiffness(measured);
  const GuideNumber final{
      parameter::friction::measured::final_stiffness,
      "N m/rad",
      0.1 * highest,
      0.9 * highest,
      Origin::assumed,
      fmt::format("0.1 to 0.9 of {:.4g} {}, with which the spring would break away on the line "
                  "from the secant's end",
                  highest, parameters::unit_on(axis, "N m/rad"))};
  const friction::VirginPoint first{measured.secant_travel,
                                    measured.secant_stiffness * measured.secant_travel};
  const double k2 =
      friction::softening_through(first, {measured.travel, measured.breakaway}, centre(final)).value().k2;
  const auto given = [](std::string_view quantity, std::string_view unit, double number,
                        std::string_view option) {
    return GuideNumber{quantity, unit, number, number, Origin::measured, std::string(option)};
  };
  return {
      measured.breakaway,
      measured.travel,
      centre(final) + k2,
      {given(parameter::friction::measured::secant_stiffness, "N m/rad", measured.secant_stiffness,
             "--secant"),
       given(parameter::friction::measured::secant_travel, "rad", measured.secant_travel, "--secant"),
       given(parameter::friction::measured::breakaway, "N m", measured.breakaway, "--breakaway"),
       given(parameter::friction::measured::breakaway_travel, "rad", measured.travel, "--travel"), final}};
}

/// The friction parameters that are computed for a guide with this load and this friction spring.
std::vector<GuideNumber> computed_parameters(const Guide& guide, const GuideLoad& load,
                                             const GuideSpring& spring) {
  const GuideNumber& creep = number_of(guide, creep_part);
  const GuideNumber& damping = number_of(guide, damping_ratio);
  const double creep_modulus =
      numerics::pow(spring.force, centre(number_of(guide, parameter::friction::n))) / spring.travel;
  const GuideNumber lambda{
      parameter::friction::lambda, "N^n/m",         creep_modulus / creep.high,
      creep_modulus / creep.low,   Origin::assumed, from("breakaway^n / (creep part·travel)", creep)};
  const double critical = 2.0 * std::sqrt(spring.initial_stiffness * load.mass);
  const GuideNumber presliding_damping{parameter::plant::presliding_damping,
                                       "N s/m",
                                       damping.low * critical,
                                       damping.high * critical,
                                       Origin::assumed,
                                       from("2·damping ratio·sqrt((k1 + k2)·mass)", damping)};
  std::vector<GuideNumber> all{presliding_damping};
  all.insert(all.end(), spring.parameters.begin(), spring.parameters.end());
  all.insert(all.end() - 1, lambda);
  return all;
}

}  // namespace

GuideLoad usual_load(const Guide& guide) {
  return {.mass = guide.mass, .preload = guide.preload};
}

std::string fault_of(const MeasuredSpring& m) {
  const double carried = m.secant_stiffness * m.secant_travel;
  if (!(m.secant_travel < m.travel))
    return fmt::format("the secant's travel of {:g} is not below the travel up to breakaway, {:g}",
                       m.secant_travel, m.travel);
  if (!(carried < m.breakaway))
    return fmt::format("the secant of {:g} over {:g} carries {:g}, which is not below the breakaway of {:g}",
                       m.secant_stiffness, m.secant_travel, carried, m.breakaway);
  if (!(m.breakaway < m.secant_stiffness * m.travel))
    return fmt::format(
        "the secant stiffness of {:g} is not above breakaway over travel, {:g}/{:g} = {:g}: a "
        "friction spring softens",
        m.secant_stiffness, m.breakaway, m.travel, m.breakaway / m.travel);
  return "";
}

double highest_final_stiffness(const MeasuredSpring& m) {
  return (m.breakaway - m.secant_stiffness * m.secant_travel) / (m.travel - m.secant_travel);
}

std::vector<GuideNumber> guide_parameters(const Guide& guide, const GuideLoad& load,
                                          const std::optional<MeasuredSpring>& measured) {
  std::vector<GuideNumber> parameters;
  if (has_load(guide))
    parameters = computed_parameters(
        guide, load, measured ? measured_spring(*measured, guide.axis) : loaded_spring(guide, load));
  std::copy_if(guide.numbers.begin(), guide.numbers.end(), std::back_inserter(parameters), is_parameter);
  return parameters;
}

double centre(const GuideNumber& number) {
  return std::sqrt(number.low * number.high);
}

std::optional<std::pair<double, double>> range_over_guides(parameters::AxisKind axis,
                                                           std::string_view parameter) {
  std::optional<std::pair<double, double>> range;
  for (const Guide& guide : guide_table()) {
    if (guide.axis != axis) continue;
    for (const GuideNumber& number : guide_parameters(guide, usual_load(guide))) {
      if (number.quantity != parameter) continue;
      if (!range) range = {number.low, number.high};
      range = {std::min(range->first, number.low), std::max(range->second, number.high)};
    }
  }
  return range;
}

}  // namespace zerocount::guides
