#include "experiments/guides/guide_table.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/parameters/handles.hpp"

namespace zerocount::guides {
namespace {

using enum Origin;
using Numbers = std::vector<GuideNumber>;

constexpr const char* seals =
    "2 to 5 N a carriage: Nippon Bearing, Frictional Resistance and Required Thrust (nbcorporation.com/technology/friction_thrust.html); "
    "four carriages are assumed";
constexpr const char* thomson =
    "Thomson, coefficient of friction for profile rail carriages (thomsonlinear.com/en/support/tips)";
constexpr const char* line_contact =
    "shorter than that of balls, as line contacts are narrower; no publication found";
constexpr const char* marginal =
    "static and dynamic friction differ marginally (Nippon Bearing, nbcorporation.com/technology/friction_thrust.html); "
    "the number is assumed";
constexpr const char* grease = "no publication found; below the friction itself up to some 0.1 m/s";

/// Numbers about friction for which no publication was found, so they are assumed; the same for all guides
/// with contact.
Numbers assumed_of_contacts() {
  return {
      {parameter::friction::alpha, "1/s", 0.1, 2, assumed, "creep lasts seconds, as in Fig. 8 of the paper"},
      {parameter::friction::n, "1", 2, 2, assumed, "as of the paper's machine, where it is assumed too"},
      {creep_part, "1", 0.01, 0.1, assumed, "creep is small beside the travel before sliding"},
      {parameter::friction::stribeck_velocity, "m/s", 5e-4, 5e-3, assumed,
       "about 1e-3 m/s, which Canudas de Wit et al., IEEE Trans. Automatic Control 40 (1995) 419, simulate"},
      {damping_ratio, "1", 0.05, 0.15, assumed, "0.14 on the paper's machine: c / (2 sqrt((k1 + k2) J))"}};
}

Numbers contact_numbers(Numbers numbers) {
  const Numbers more = assumed_of_contacts();
  numbers.insert(numbers.end(), more.begin(), more.end());
  return numbers;
}

Guide ball_rail() {
  return {
      .name = "ball-rail",
      .description = "profiled rails with recirculating balls, four carriages",
      .model = "presliding",
      .mass = 5,
      .preload = 500,
      .numbers = contact_numbers(
          {{friction_coefficient, "1", 0.002, 0.003, published, thomson},
           {constant_resistance, "N", 8, 20, published, seals},
           {presliding_travel, "m", 7e-5, 1.5e-4, published,
            "rolls normally beyond 100 µm: Futami, Furutani, Yoshida, Nanotechnology 1 (1990) 31, abstract; the spread is assumed"},
           {softening_length, "m", 2.5e-7, 1e-6, assumed,
            "some times the 100 nm in which the balls are a linear spring (Futami et al., Nanotechnology 1 (1990) 31)"},
           {early_part, "1", 0.1, 0.3, assumed,
            "no publication found; a slide of 5 kg then has a natural frequency of some 200 Hz"},
           {parameter::friction::coulomb_ratio, "1", 0.9, 1, assumed, marginal},
           {parameter::plant::sliding_damping, "N s/m", 20, 100, assumed, grease}})};
}

Guide roller_rail() {
  return {
      .name = "roller-rail",
      .description = "profiled rails with recirculating rollers, four carriages",
      .model = "presliding",
      .mass = 20,
      .preload = 2000,
      .numbers = contact_numbers({{friction_coefficient, "1", 0.001, 0.002, published, thomson},
                                  {constant_resistance, "N", 8, 20, published, seals},
                                  {presliding_travel, "m", 3e-5, 1e-4, assumed, line_contact},
                                  {softening_length, "m", 1.5e-7, 6e-7, assumed, line_contact},
                                  {early_part, "1", 0.1, 0.3, assumed, "as of balls"},
                                  {parameter::friction::coulomb_ratio, "1", 0.9, 1, assumed, marginal},
                                  {parameter::plant::sliding_damping, "N s/m", 20, 100, assumed, grease}})};
}

Guide crossed_roller() {
  return {
      .name = "crossed-roller",
      .description = "crossed rollers in V-grooves, without seals",
      .model = "presliding",
      .mass = 2,
      .preload = 300,
      .numbers = contact_numbers({{friction_coefficient, "1", 0.001, 0.003, published,
                                   "Stanochniy Park, Table 1, p. 21 (online.flipbuilder.com/czjc/rpdc)"},
                                  {constant_resistance, "N", 0.5, 2, assumed, "grease; there are no seals"},
                                  {presliding_travel, "m", 3e-5, 1e-4, assumed, line_contact},
                                  {softening_length, "m", 1.5e-7, 6e-7, assumed, line_contact},
                                  {early_part, "1", 0.1, 0.3, assumed, "as of balls"},
                                  {parameter::friction::coulomb_ratio, "1", 0.9, 1, assumed, marginal},
                                  {parameter::plant::sliding_damping, "N s/m", 5, 30, assumed, grease}})};
}

Guide plain() {
  return {
      .name = "plain",
      .description = "sliding guide lined with PTFE, such as a dovetail",
      .model = "presliding",
      .mass = 5,
      .preload = 100,
      .numbers = contact_numbers(
          {{friction_coefficient, "1", 0.05, 0.1, published,
            "PTFE, Turcite B, Rulon, dry: Industrial Monitor Direct, PTFE vs UHMWPE Way Bearings (industrialmonitordirect.com)"},
           {constant_resistance, "N", 1, 5, assumed, "wipers"},
           {presliding_travel, "m", 5e-6, 5e-5, assumed,
            "around the 15 µm of Fs/sigma0 in the simulations of Canudas de Wit et al., IEEE Trans. Automatic Control 40 (1995) 419"},
           {softening_length, "m", 1e-6, 3e-6, assumed, "deflection of asperities; no publication found"},
           {early_part, "1", 0.2, 0.5, assumed, "no publication found"},
           {parameter::friction::coulomb_ratio, "1", 0.83, 1, published,
            "static friction within 20 % of dynamic: Slocum, Precision Machine Design (1992), as cited at hon1.ru/?p=501"},
           {parameter::plant::sliding_damping, "N s/m", 50, 500, assumed, grease}})};
}

Guide air_bearing() {
  return {
      .name = "air-bearing",
      .description = "aerostatic pads, which have no friction at rest",
      .model = "none",
      .mass = 5,
      .numbers = {
          {parameter::plant::presliding_damping, "N s/m", 0.01, 0.15, assumed,
           "shear of the film, viscosity·area/gap: 1.8e-5 Pa s, 0.01 to 0.04 m^2 and 5 to 15 µm are assumed"}}};
}

Guide rotary_ball() {
  constexpr const char* assumed_here = "not in the paper: docs/the-paper.md";
  return {.name = "rotary-ball",
          .description = "the rotary axis of the paper, on ball bearings",
          .model = "presliding",
          .axis = parameters::AxisKind::rotary,
          .mass = 5.54e-4,
          .numbers = {{parameter::friction::k1, "N m/rad", 90, 130, published,
                       "110, a lower bound: paper, section 4; the spread is assumed"},
                      {parameter::friction::k2, "N m/rad", 600, 900, published,
                       "k1 + k2 = 860: paper, section 4; the spread is assumed"},
                      {parameter::friction::beta, "1/rad", 7e4, 1.4e5, assumed,
                       "from the outcomes in section 4 of the paper: docs/the-paper.md"},
                      {parameter::friction::alpha, "1/s", 0.1, 2, assumed, assumed_here},
                      {parameter::friction::lambda, "(N m)^n/rad", 5, 20, assumed, assumed_here},
                      {parameter::friction::n, "1", 2, 2, assumed, assumed_here},
                      {parameter::friction::breakaway, "N m", 0.2, 0.45, assumed, assumed_here},
                      {parameter::friction::coulomb_ratio, "1", 0.7, 0.9, assumed, assumed_here},
                      {parameter::friction::stribeck_velocity, "rad/s", 5e-3, 2e-2, assumed, assumed_here},
                      {parameter::plant::presliding_damping, "N m s/rad", 0.15, 0.25, published,
                       "0.2: paper, section 4; the spread is assumed"},
                      {parameter::plant::sliding_damping, "N m s/rad", 5e-4, 2e-3, assumed, assumed_here}}};
}

}  // namespace

std::span<const Guide> guide_table() {
  static const std::vector<Guide> table{ball_rail(), roller_rail(), crossed_roller(),
                                        plain(),     air_bearing(), rotary_ball()};
  return table;
}

const Guide& guide_named(std::string_view name) {
  std::string names;
  for (const Guide& guide : guide_table()) {
    if (guide.name == name) return guide;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", guide.name);
  }
  throw Failure(ExitCode::bad_input, fmt::format("unknown guide '{}'; expected one of {}", name, names));
}

const GuideNumber* find_number(const Guide& guide, std::string_view quantity) {
  const auto found = std::find_if(guide.numbers.begin(), guide.numbers.end(),
                                  [&](const GuideNumber& number) { return number.quantity == quantity; });
  return found == guide.numbers.end() ? nullptr : &*found;
}

bool has_load(const Guide& guide) {
  return find_number(guide, friction_coefficient) != nullptr;
}

}  // namespace zerocount::guides
