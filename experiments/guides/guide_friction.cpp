#include "experiments/guides/guide_friction.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "core/numerics/elementary_functions.hpp"

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

/// The parameters of a guide whose friction grows with the load, in terms of the quantities of its table.
std::vector<GuideNumber> computed_parameters(const Guide& guide, const GuideLoad& load) {
  const double normal_force = load.preload + gravity * load.mass;
  const GuideNumber& coefficient = number_of(guide, friction_coefficient);
  const GuideNumber& constant = number_of(guide, constant_resistance);
  const GuideNumber& travel = number_of(guide, presliding_travel);
  const GuideNumber& softening = number_of(guide, softening_length);
  const GuideNumber& early = number_of(guide, early_part);
  const GuideNumber& creep = number_of(guide, creep_part);
  const GuideNumber& damping = number_of(guide, damping_ratio);

  const GuideNumber breakaway{
      "friction.breakaway",
      "N",
      coefficient.low * normal_force + constant.low,
      coefficient.high * normal_force + constant.high,
      of_both(coefficient, constant),
      from(from("friction coefficient·(preload + weight) + constant resistance", coefficient), constant)};
  const double force = centre(breakaway);
  const double late_force = (1.0 - centre(early)) * force;
  const GuideNumber k1{
      "friction.k1",           "N/m",           late_force / travel.high,
      late_force / travel.low, Origin::assumed, from("(1 - early part)·breakaway / travel", travel)};
  const double per_early_part = 2.0 * force / centre(softening);
  const GuideNumber k2{"friction.k2",
                       "N/m",
                       per_early_part * early.low,
                       per_early_part * early.high,
                       Origin::assumed,
                       from("2·early part·breakaway / softening length", early)};
  const GuideNumber beta{"friction.beta",      "1/m",
                         1.0 / softening.high, 1.0 / softening.low,
                         softening.origin,     from("1 / softening length", softening)};
  const double creep_modulus = numerics::pow(force, centre(number_of(guide, "friction.n"))) / centre(travel);
  const GuideNumber lambda{
      "friction.lambda",         "N^n/m",         creep_modulus / creep.high,
      creep_modulus / creep.low, Origin::assumed, from("breakaway^n / (creep part·travel)", creep)};
  const double critical = 2.0 * std::sqrt((centre(k1) + centre(k2)) * load.mass);
  const GuideNumber presliding_damping{
      "plant.presliding_damping", "N s/m",         damping.low * critical,
      damping.high * critical,    Origin::assumed, from("2·damping ratio·sqrt((k1 + k2)·mass)", damping)};
  return {presliding_damping, k1, k2, beta, lambda, breakaway};
}

}  // namespace

GuideLoad usual_load(const Guide& guide) {
  return {.mass = guide.mass, .preload = guide.preload};
}

std::vector<GuideNumber> guide_parameters(const Guide& guide, const GuideLoad& load) {
  std::vector<GuideNumber> parameters;
  if (has_load(guide)) parameters = computed_parameters(guide, load);
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
