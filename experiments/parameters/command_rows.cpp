#include "experiments/parameters/parameter_rows.hpp"

namespace zerocount::parameters {

std::vector<Parameter> command_rows() {
  constexpr std::string_view required = "required";
  constexpr numerics::Interval targets{
      .low = -max_count, .high = max_count, .low_included = true, .high_included = true};
  return {
      list_of(max_moves_values, "target", "targets",
              whole_row("command.targets", first_sobol_dimension_of_moves, "count",
                        "target of each move, from the start of the trial", required, targets),
              [](auto& p, std::size_t i) { return &p.command.targets[i]; }),

      list_of(
          max_moves_values, "level", "levels",
          real_row("command.torque.levels", first_sobol_dimension_of_moves, "N m",
                   "open loop: torque that each move goes to and holds", required, numerics::all_numbers()),
          [](auto& p, std::size_t i) { return &p.command.torque.levels[i]; }),
      real_row("command.torque.rate", 56, "N m/s", "rate at which the torque goes from level to level",
               assumed, numerics::above(0), [](auto& p) { return &p.command.torque.rate; }),
      word_row("command.torque.through", beyond_moves(3),
               "whether the torque is rounded by the converter, with its errors, or as commanded", assumed,
               {"dac", "exact"}, [](auto& p) { return &p.command.torque.through; }),

      list_of(max_moves_values, "target", "targets",
              whole_row("command.sequence.targets", first_sobol_dimension_of_moves, "count",
                        "targets of a sequence in ascending order, from the start of the trial", required,
                        targets),
              NoField{}),
      whole_row("command.sequence.overrun", 57, "count",
                "how far beyond the first and the last target a sequence turns round", required,
                numerics::closed(1, max_count)),

      real_row("command.hold", 26, "s",
               "time for which each target is held, or each torque level once it is reached", assumed,
               numerics::above(0), [](auto& p) { return &p.command.hold; }),
      word_row("command.profile.shape", beyond_moves(4), "how the reference goes to the next target", assumed,
               {"step", "trapezoidal", "s_curve"}, [](auto& p) { return &p.command.profile.shape; }),
      real_row("command.profile.velocity_limit", 53, "rad/s", "limit of the reference's velocity", assumed,
               numerics::above(0), [](auto& p) { return &p.command.profile.velocity_limit; }),
      real_row("command.profile.acceleration_limit", 54, "rad/s^2", "limit of the reference's acceleration",
               assumed, numerics::above(0), [](auto& p) { return &p.command.profile.acceleration_limit; }),
      real_row("command.profile.jerk_limit", 55, "rad/s^3",
               "limit of the rate of the reference's acceleration, with s_curve", assumed, numerics::above(0),
               [](auto& p) { return &p.command.profile.jerk_limit; }),
  };
}

}  // namespace zerocount::parameters
