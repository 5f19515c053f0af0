#include <array>

#include "experiments/parameters/element_lists.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"

namespace zerocount::parameters {
namespace {

// Sobol dimensions of one element.
constexpr std::size_t dimensions_of_ripple = 3;
constexpr std::size_t dimensions_of_vibration = 3;
constexpr std::size_t max_ripples = 8;
constexpr std::size_t max_vibrations = 16;

constexpr std::size_t max_load_vibrations = 8;

std::vector<trial::RippleParameters>& ripples(trial::TrialParameters& p) {
  return p.disturbance.ripple;
}
std::vector<trial::VibrationParameters>& vibrations(trial::TrialParameters& p) {
  return p.disturbance.vibration;
}
std::vector<trial::RippleParameters>& load_ripples(trial::TrialParameters& p) {
  return p.load_side.disturbance.ripple;
}
std::vector<trial::VibrationParameters>& load_vibrations(trial::TrialParameters& p) {
  return p.load_side.disturbance.vibration;
}
std::vector<trial::RippleParameters>& errors(trial::TrialParameters& p) {
  return p.load_side.error;
}

// The row of a number of each element of a list.
template <auto list, auto field>
Parameter number_of(parameter::Handle name, std::size_t dimension, std::size_t dimensions,
                    std::string_view unit, std::string_view meaning, const numerics::Interval& range) {
  Parameter row = real_row(name, dimension, unit, meaning, "required", range);
  row.element = {dimensions, +[](trial::TrialParameters& parameters, std::size_t element, std::size_t,
                                 double value) { list(parameters)[element].*field = value; }};
  return row;
}

Parameter zero_by_default(Parameter row) {
  row.source = assumed;
  row.get = [](const trial::TrialParameters&) { return 0.0; };
  return row;
}

// Rows of a list of ripples.
// @param names of amplitude, periods, pitch and phase.
// @param ideal of the amplitude
template <auto list>
void add_ripple_rows(std::vector<Parameter>& rows, const std::array<parameter::Handle, 4>& names,
                     std::size_t first, std::string_view unit, std::string_view meaning, const Ideal& ideal) {
  using R = trial::RippleParameters;
  constexpr std::size_t of = dimensions_of_ripple;
  rows.push_back(number_of<list, &R::amplitude>(names[0], first, of, unit, meaning, numerics::at_least(0)));
  rows.back().ideal = ideal;
  rows.push_back(only_on(AxisKind::rotary, "pitch, m",
                         number_of<list, &R::periods>(names[1], first + 1, of, "1",
                                                      "its periods in a revolution", numerics::above(0))));
  rows.push_back(only_on(AxisKind::linear, "periods, per revolution",
                         number_of<list, &R::pitch>(names[2], first + 1, of, "m",
                                                    "length of one of its periods", numerics::above(0))));
  rows.push_back(zero_by_default(number_of<list, &R::phase>(
      names[3], first + 2, of, "1", "its phase at the zero of the $track, of 2 pi in a period",
      numerics::all_numbers())));
}

// Rows of a list of vibrations.
// @param names of amplitude, frequency and phase.
template <auto list>
void add_vibration_rows(std::vector<Parameter>& rows, const std::array<parameter::Handle, 3>& names,
                        std::size_t first, std::string_view meaning) {
  using V = trial::VibrationParameters;
  constexpr std::size_t of = dimensions_of_vibration;
  rows.push_back(
      ideal_at(0, "no vibration",
               number_of<list, &V::amplitude>(names[0], first, of, "N m", meaning, numerics::at_least(0))));
  rows.push_back(
      number_of<list, &V::frequency>(names[1], first + 1, of, "Hz", "its frequency", numerics::above(0)));
  rows.push_back(zero_by_default(number_of<list, &V::phase>(
      names[2], first + 2, of, "1", "its phase at the start of the trial, of 2 pi in a period",
      numerics::all_numbers())));
}

template <auto list>
ElementList ripples_at(std::string_view path, std::string_view element) {
  static const std::array<ElementForm, 2> forms{{
      {"", {"amplitude", "periods", "phase"}, "on a rotary axis"},
      {"", {"amplitude", "pitch", "phase"}, "on a linear axis"},
  }};
  return {path, element, max_ripples, forms,
          [](trial::TrialParameters& p, std::size_t) { list(p).emplace_back(); }};
}

template <auto list>
ElementList vibrations_at(std::string_view path, std::size_t max_elements) {
  static const std::array<ElementForm, 1> forms{{
      {"", {"amplitude", "frequency", "phase"}, "a line"},
  }};
  return {path, "vibration", max_elements, forms,
          [](trial::TrialParameters& p, std::size_t) { list(p).emplace_back(); }};
}

// First Sobol dimensions.
constexpr std::size_t load_ripple = beyond_moves(445);
constexpr std::size_t kinematic_error = load_ripple + max_ripples * dimensions_of_ripple;

}  // namespace

std::vector<Parameter> kinematic_error_rows() {
  std::vector<Parameter> rows;
  add_ripple_rows<errors>(rows,
                          {parameter::plant::load::error::amplitude, parameter::plant::load::error::periods,
                           parameter::plant::load::error::pitch, parameter::plant::load::error::phase},
                          kinematic_error, "rad",
                          "amplitude of a kinematic error of the coupling, along the $track",
                          {"no kinematic error", 0.0});
  return rows;
}

std::vector<Parameter> disturbance_rows() {
  constexpr std::size_t ripple = beyond_moves(192);
  std::vector<Parameter> rows{
      idealised_by(
          no_constant_disturbance,
          real_row(parameter::disturbance::torque, beyond_moves(30), "N m", "constant $torque on the $rotor",
                   assumed, numerics::all_numbers(), [](auto& p) { return &p.disturbance.torque; })),
  };
  add_ripple_rows<ripples>(
      rows,
      {parameter::disturbance::ripple::amplitude, parameter::disturbance::ripple::periods,
       parameter::disturbance::ripple::pitch, parameter::disturbance::ripple::phase},
      ripple, "N m", "amplitude of a $torque that varies along the $track", {no_ripple});
  add_vibration_rows<vibrations>(
      rows,
      {parameter::disturbance::vibration::amplitude, parameter::disturbance::vibration::frequency,
       parameter::disturbance::vibration::phase},
      ripple + max_ripples * dimensions_of_ripple, "amplitude of a $torque that varies in time");
  rows.push_back(
      idealised_by(no_constant_load_disturbance,
                   real_row(parameter::disturbance::load::torque, beyond_moves(288), "N m",
                            "constant $torque on the second mass", assumed, numerics::all_numbers(),
                            [](auto& p) { return &p.load_side.disturbance.torque; })));
  add_ripple_rows<load_ripples>(
      rows,
      {parameter::disturbance::load::ripple::amplitude, parameter::disturbance::load::ripple::periods,
       parameter::disturbance::load::ripple::pitch, parameter::disturbance::load::ripple::phase},
      load_ripple, "N m", "amplitude of a $torque on the second mass that varies along its way", {no_ripple});
  add_vibration_rows<load_vibrations>(
      rows,
      {parameter::disturbance::load::vibration::amplitude, parameter::disturbance::load::vibration::frequency,
       parameter::disturbance::load::vibration::phase},
      kinematic_error + max_ripples * dimensions_of_ripple,
      "amplitude of a $torque on the second mass that varies in time");
  return rows;
}

ElementList ripple_list() {
  return ripples_at<ripples>("disturbance.ripple", "ripple");
}

ElementList vibration_list() {
  return vibrations_at<vibrations>("disturbance.vibration", max_vibrations);
}

ElementList load_ripple_list() {
  return ripples_at<load_ripples>("disturbance.load.ripple", "ripple");
}

ElementList load_vibration_list() {
  return vibrations_at<load_vibrations>("disturbance.load.vibration", max_load_vibrations);
}

ElementList kinematic_error_list() {
  return ripples_at<errors>("plant.load.error", "kinematic error");
}

}  // namespace zerocount::parameters
