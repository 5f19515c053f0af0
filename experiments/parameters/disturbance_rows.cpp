#include <array>

#include "experiments/parameters/element_lists.hpp"
#include "experiments/parameters/parameter_rows.hpp"

namespace zerocount::parameters {
namespace {

// Sobol dimensions of one element.
constexpr std::size_t dimensions_of_ripple = 3;
constexpr std::size_t dimensions_of_vibration = 3;
constexpr std::size_t max_ripples = 8;
constexpr std::size_t max_vibrations = 16;

std::vector<trial::RippleParameters>& ripples(trial::TrialParameters& p) {
  return p.disturbance.ripple;
}
std::vector<trial::VibrationParameters>& vibrations(trial::TrialParameters& p) {
  return p.disturbance.vibration;
}

// The row of a number of each element of a list.
template <auto list, auto field>
Parameter number_of(std::string_view name, std::size_t dimension, std::size_t dimensions,
                    std::string_view unit, std::string_view meaning, const numerics::Interval& range) {
  Parameter row = real_row(name, dimension, unit, meaning, "required", range);
  row.element = {dimensions, [](trial::TrialParameters& parameters, std::size_t element, std::size_t,
                                double value) { list(parameters)[element].*field = value; }};
  return row;
}

Parameter zero_by_default(Parameter row) {
  row.source = assumed;
  row.get = [](const trial::TrialParameters&) { return 0.0; };
  return row;
}

}  // namespace

std::vector<Parameter> disturbance_rows() {
  using R = trial::RippleParameters;
  using V = trial::VibrationParameters;
  constexpr std::size_t ripple = beyond_moves(192);
  constexpr std::size_t vibration = ripple + max_ripples * dimensions_of_ripple;
  return {
      idealised_by(no_constant_disturbance,
                   real_row("disturbance.torque", beyond_moves(30), "N m", "constant $torque on the $rotor",
                            assumed, numerics::all_numbers(), [](auto& p) { return &p.disturbance.torque; })),
      ideal_at(0, "no ripple",
               number_of<ripples, &R::amplitude>(
                   "disturbance.ripple.#.amplitude", ripple, dimensions_of_ripple, "N m",
                   "amplitude of a $torque that varies along the $track", numerics::at_least(0))),
      only_on(
          AxisKind::rotary, "pitch, m",
          number_of<ripples, &R::periods>("disturbance.ripple.#.periods", ripple + 1, dimensions_of_ripple,
                                          "1", "its periods in a revolution", numerics::above(0))),
      only_on(AxisKind::linear, "periods, per revolution",
              number_of<ripples, &R::pitch>("disturbance.ripple.#.pitch", ripple + 1, dimensions_of_ripple,
                                            "m", "length of one of its periods", numerics::above(0))),
      zero_by_default(number_of<ripples, &R::phase>(
          "disturbance.ripple.#.phase", ripple + 2, dimensions_of_ripple, "1",
          "its phase at the zero of the $track, of 2 pi in a period", numerics::all_numbers())),
      ideal_at(0, "no vibration",
               number_of<vibrations, &V::amplitude>(
                   "disturbance.vibration.#.amplitude", vibration, dimensions_of_vibration, "N m",
                   "amplitude of a $torque that varies in time", numerics::at_least(0))),
      number_of<vibrations, &V::frequency>("disturbance.vibration.#.frequency", vibration + 1,
                                           dimensions_of_vibration, "Hz", "its frequency",
                                           numerics::above(0)),
      zero_by_default(number_of<vibrations, &V::phase>(
          "disturbance.vibration.#.phase", vibration + 2, dimensions_of_vibration, "1",
          "its phase at the start of the trial, of 2 pi in a period", numerics::all_numbers())),
  };
}

ElementList ripple_list() {
  static const std::array<ElementForm, 2> forms{{
      {"", {"amplitude", "periods", "phase"}, "on a rotary axis"},
      {"", {"amplitude", "pitch", "phase"}, "on a linear axis"},
  }};
  return {"disturbance.ripple", "ripple", max_ripples, forms,
          [](trial::TrialParameters& p, std::size_t) { ripples(p).emplace_back(); }};
}

ElementList vibration_list() {
  static const std::array<ElementForm, 1> forms{{
      {"", {"amplitude", "frequency", "phase"}, "a line"},
  }};
  return {"disturbance.vibration", "vibration", max_vibrations, forms,
          [](trial::TrialParameters& p, std::size_t) { vibrations(p).emplace_back(); }};
}

}  // namespace zerocount::parameters
