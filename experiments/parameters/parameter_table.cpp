#include "experiments/parameters/parameter_table.hpp"

#include <algorithm>
#include <string>
#include <type_traits>

#include <fmt/format.h>

namespace zerocount {
namespace {

// Completes a row with the way to and from the trial's parameters: `at` returns a reference to the field.
template <class At>
Parameter stored_at(Parameter row, At) {
  row.get = [](const TrialParameters& parameters) { return static_cast<double>(At{}(parameters)); };
  row.set = [](TrialParameters& parameters, double value) {
    auto& field = At{}(parameters);
    field = static_cast<std::remove_reference_t<decltype(field)>>(value);
  };
  return row;
}

template <double FrictionParameters::*field>
Parameter friction(Parameter row) {
  row.profiled = field;
  return stored_at(
      std::move(row), [](auto& p) -> auto& { return p.friction.uniform.*field; });
}

Parameter per_move(Parameter row) {
  row.per_move = true;
  return row;
}

// Largest magnitude of a target and of a counts-per-revolution: far above any machine's, and exact as a
// double with the whole arithmetic of counts around it.
constexpr double largest_count = 1e12;

constexpr auto whole = ParameterKind::whole_number;
constexpr auto enumeration = ParameterKind::enumeration;
constexpr std::string_view assumed = "assumed";

// The fields of a row: name, unit, meaning, source, kind, range, words, sobol_dimension.
// A new row takes the next free Sobol dimension (below first_sobol_dimension_of_moves).
std::vector<Parameter> make_table() {
  using P = FrictionParameters;
  return {
      stored_at(
          {"plant.inertia",
           "kg m^2",
           "moment of inertia J of the rotor",
           "paper, section 4",
           {},
           above(0),
           {},
           12},
          [](auto& p) -> auto& { return p.plant.inertia; }),
      stored_at(
          {"plant.presliding_damping",
           "N m s/rad",
           "damping c from hook to rotor while the hook sticks",
           "paper, section 4",
           {},
           at_least(0),
           {},
           13},
          [](auto& p) -> auto& { return p.plant.presliding_damping; }),
      stored_at(
          {"plant.sliding_damping",
           "N m s/rad",
           "viscous damping cs while the hook slides",
           assumed,
           {},
           at_least(0),
           {},
           14},
          [](auto& p) -> auto& { return p.plant.sliding_damping; }),

      friction<&P::k1>({"friction.k1",
                        "N m/rad",
                        "lowest tangent stiffness of the friction spring",
                        "paper, section 4",
                        {},
                        above(0),
                        {},
                        0}),
      friction<&P::k2>({"friction.k2",
                        "N m/rad",
                        "highest tangent stiffness of the friction spring less k1",
                        "paper, section 4 (k1 + k2 = 860)",
                        {},
                        at_least(0),
                        {},
                        1}),
      friction<&P::beta>({"friction.beta",
                          "1/rad",
                          "rate at which a branch softens from k1 + k2 to k1",
                          assumed,
                          {},
                          above(0),
                          {},
                          3}),
      friction<&P::alpha>(
          {"friction.alpha", "1/s", "rate of creep; 0 switches creep off", assumed, {}, at_least(0), {}, 4}),
      friction<&P::lambda>({"friction.lambda",
                            "(N m)^n/rad",
                            "hardening modulus: creep ends at |torque|^n / lambda",
                            assumed,
                            {},
                            above(0),
                            {},
                            5}),
      friction<&P::n>(
          {"friction.n", "1", "exponent of the torque in the creep law", assumed, {}, at_least(1), {}, 15}),
      friction<&P::breakaway>({"friction.breakaway",
                               "N m",
                               "torque at which the hook starts to slide",
                               assumed,
                               {},
                               above(0),
                               {},
                               6}),
      friction<&P::coulomb_ratio>({"friction.coulomb_ratio",
                                   "1",
                                   "Coulomb level over breakaway",
                                   assumed,
                                   {},
                                   {.low = 0, .high = 1, .high_included = true},
                                   {},
                                   7}),
      friction<&P::stribeck_velocity>({"friction.stribeck_velocity",
                                       "rad/s",
                                       "velocity over which sliding friction falls to the Coulomb level",
                                       assumed,
                                       {},
                                       above(0),
                                       {},
                                       8}),

      stored_at(
          {"encoder.fine",
           "count/rev",
           "counts per revolution of the encoder that closes the loop",
           "paper, section 2",
           whole,
           closed(1, largest_count),
           {},
           16},
          [](auto& p) -> auto& { return p.encoder.fine; }),
      stored_at(
          {"encoder.coarse",
           "count/rev",
           "counts per revolution of the encoder read beside it",
           "paper, section 2",
           whole,
           closed(1, largest_count),
           {},
           17},
          [](auto& p) -> auto& { return p.encoder.coarse; }),

      stored_at(
          {"dac.bits",
           "bit",
           "word length of the digital-to-analogue converter",
           "paper, section 2",
           whole,
           closed(1, 32),
           {},
           18},
          [](auto& p) -> auto& { return p.dac.bits; }),
      stored_at(
          {"dac.resolution",
           "N m",
           "torque of one code of the digital-to-analogue converter",
           "paper, section 4",
           {},
           above(0),
           {},
           19},
          [](auto& p) -> auto& { return p.dac.resolution; }),

      stored_at(
          {"controller.sample_rate",
           "Hz",
           "sampling rate of the loop",
           "paper, section 4",
           {},
           above(0),
           {},
           20},
          [](auto& p) -> auto& { return p.controller.sample_rate; }),
      stored_at(
          {"controller.kp",
           "N m/count",
           "proportional gain",
           "paper, section 4 (integral control alone)",
           {},
           closed(0, 1e6),
           {},
           21},
          [](auto& p) -> auto& { return p.controller.kp; }),
      stored_at(
          {"controller.ki",
           "N m/count",
           "integral gain k_ID of the trapezoidal rule",
           "paper, section 4 (a)",
           {},
           closed(0, 1e6),
           {},
           22},
          [](auto& p) -> auto& { return p.controller.ki; }),
      stored_at(
          {"controller.kd",
           "N m/count",
           "gain on the difference of successive counts",
           "paper, section 4 (integral control alone)",
           {},
           closed(0, 1e6),
           {},
           23},
          [](auto& p) -> auto& { return p.controller.kd; }),
      stored_at(
          {"controller.delay",
           "sample",
           "samples between deciding a torque and applying it",
           assumed,
           whole,
           closed(0, 100),
           {},
           24},
          [](auto& p) -> auto& { return p.controller.delay; }),
      stored_at(
          {"controller.anti_windup",
           "1",
           "what keeps the integral inside the converter's range",
           assumed,
           enumeration,
           closed(0, 1),
           {"clamp", "none"},
           25},
          [](auto& p) -> auto& { return p.controller.anti_windup; }),

      per_move({"command.targets",
                "count",
                "target of each move, from the start of the trial",
                "required",
                whole,
                closed(-largest_count, largest_count),
                {},
                first_sobol_dimension_of_moves}),
      stored_at(
          {"command.hold", "s", "time for which each target is held", assumed, {}, above(0), {}, 26},
          [](auto& p) -> auto& { return p.command.hold; }),

      stored_at(
          {"initial.encoder_phase",
           "count",
           "where inside a count the rotor stands at the start",
           assumed,
           {},
           half_open(0, 1),
           {},
           2},
          [](auto& p) -> auto& { return p.initial.encoder_phase; }),
      stored_at(
          {"initial.position",
           "rad",
           "where on the rotor the contact is; selects from the profiles",
           assumed,
           {},
           all_numbers(),
           {},
           9},
          [](auto& p) -> auto& { return p.initial.position; }),
      stored_at(
          {"initial.hardening", "rad", "work hardening xh at the start", assumed, {}, at_least(0), {}, 10},
          [](auto& p) -> auto& { return p.initial.hardening; }),
      stored_at(
          {"initial.preload",
           "N m",
           "torque of a slow load-and-unload from virgin before the start",
           assumed,
           {},
           all_numbers(),
           {},
           11},
          [](auto& p) -> auto& { return p.initial.preload; }),

      stored_at(
          {"verdict.dwell", "s", "time at zero error that makes an arrival", assumed, {}, above(0), {}, 27},
          [](auto& p) -> auto& { return p.verdict.dwell; }),
      stored_at(
          {"verdict.window",
           "s",
           "last part of a move, by which its outcome is judged",
           assumed,
           {},
           above(0),
           {},
           28},
          [](auto& p) -> auto& { return p.verdict.window; }),
  };
}

}  // namespace

std::span<const Parameter> parameter_table() {
  static const std::vector<Parameter> table = make_table();
  return table;
}

std::optional<std::size_t> find_parameter(std::string_view name) {
  const auto table = parameter_table();
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const Parameter& p) { return p.name == name; });
  if (found == table.end()) return std::nullopt;
  return static_cast<std::size_t>(found - table.begin());
}

double default_value(const Parameter& parameter) {
  return parameter.get(TrialParameters{});
}

std::string default_text(const Parameter& parameter) {
  if (parameter.per_move) return "required";
  const double value = default_value(parameter);
  if (parameter.kind == ParameterKind::enumeration) {
    return std::string(parameter.words[static_cast<std::size_t>(value)]);
  }
  return fmt::format("{}", value);
}

}  // namespace zerocount
