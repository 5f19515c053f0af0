#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"

namespace zerocount::parameters {

Parameter in_si_positions(const Parameter& position) {
  Parameter row = position;
  row.kind = ParameterKind::real;
  row.unit = "rad";
  row.range = is_list(row) ? numerics::all_numbers() : numerics::above(0);
  if (row.list) row.list->set = {};  // a trial has the counts that they become (study_trial.cpp)
  return row;
}

std::vector<Parameter> command_rows() {
  constexpr std::string_view required = "required";
  constexpr numerics::Interval targets{
      .low = -max_count, .high = max_count, .low_included = true, .high_included = true};
  return {
      position(
          list_of(max_moves_values, "target", "targets",
                  whole_row(parameter::command::targets, first_sobol_dimension_of_moves, "count",
                            "target of each move, relative to the start of the trial", required, targets),
                  [](auto& p, std::size_t i) { return &p.command.targets[i]; })),

      list_of(max_moves_values, "level", "levels",
              real_row(parameter::command::torque::levels, first_sobol_dimension_of_moves, "N m",
                       "open loop: $torque to which each move ramps and which it then holds", required,
                       numerics::all_numbers()),
              [](auto& p, std::size_t i) { return &p.command.torque.levels[i]; }),
      real_row(parameter::command::torque::rate, 56, "N m/s", "rate of change of the $torque between levels",
               assumed, numerics::above(0), [](auto& p) { return &p.command.torque.rate; }),
      word_row(parameter::command::torque::through, beyond_moves(3),
               "how the $torque is applied: through the converter, with its rounding and errors, or exactly",
               assumed, {"dac", "exact"}, [](auto& p) { return &p.command.torque.through; }),

      position(
          list_of(max_moves_values, "target", "targets",
                  whole_row(parameter::command::sequence::targets, first_sobol_dimension_of_moves, "count",
                            "targets of a sequence in ascending order, relative to the start of the trial",
                            required, targets),
                  NoField{})),
      position(whole_row(parameter::command::sequence::overrun, 57, "count",
                         "distance beyond the first and the last target at which a sequence reverses",
                         required, numerics::closed(1, max_count))),

      real_row(parameter::command::hold, 26, "s",
               "time for which each target is held, or each $torque level after it is reached", assumed,
               numerics::above(0), [](auto& p) { return &p.command.hold; }),
      word_row(
          parameter::command::profile::shape, beyond_moves(4),
          "shape of the reference between targets, a sine about the target, or the record of command.reference",
          assumed, {"step", "trapezoidal", "s_curve", "sine", "record"},
          [](auto& p) { return &p.command.profile.shape; }),
      idealised_by(faster_profile, real_row(parameter::command::profile::velocity_limit, 53, "rad/s",
                                            "maximum velocity of the reference", assumed, numerics::above(0),
                                            [](auto& p) { return &p.command.profile.velocity_limit; })),
      idealised_by(faster_profile,
                   real_row(parameter::command::profile::acceleration_limit, 54, "rad/s^2",
                            "maximum acceleration of the reference", assumed, numerics::above(0),
                            [](auto& p) { return &p.command.profile.acceleration_limit; })),
      idealised_by(faster_profile,
                   real_row(parameter::command::profile::jerk_limit, 55, "rad/s^3",
                            "maximum rate of change of the reference's acceleration (s_curve only)", assumed,
                            numerics::above(0), [](auto& p) { return &p.command.profile.jerk_limit; })),
      real_row(parameter::command::profile::amplitude, beyond_moves(60), "rad",
               "amplitude of a sine reference", assumed, numerics::above(0),
               [](auto& p) { return &p.command.profile.amplitude; }),
      real_row(parameter::command::profile::frequency, beyond_moves(61), "Hz",
               "frequency of a sine reference", assumed, numerics::above(0),
               [](auto& p) { return &p.command.profile.frequency; }),
  };
}

}  // namespace zerocount::parameters
