#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"

namespace zerocount::parameters {

std::vector<Parameter> initial_rows() {
  return {
      real_row(parameter::initial::encoder_phase, 2, "count",
               "position of the $rotor within a count at the start", assumed, numerics::half_open(0, 1),
               [](auto& p) { return &p.initial.encoder_phase; }),
      real_row(parameter::initial::load_encoder_phase, beyond_moves(306), "count",
               "position of the second mass within a count of its own encoder at the start", assumed,
               numerics::half_open(0, 1), [](auto& p) { return &p.initial.other_encoder_phase; }),
      real_row(parameter::initial::position, 9, "rad",
               "position of the contact along the $track at the start; selects the values of profiles",
               assumed, numerics::all_numbers(), [](auto& p) { return &p.initial.position; }),
      real_row(parameter::initial::hardening, 10, "rad", "work hardening xh at the start", assumed,
               numerics::at_least(0), [](auto& p) { return &p.initial.hardening; }),
      real_row(parameter::initial::preload, 11, "N m",
               "$torque to which the virgin contact is slowly loaded, and unloaded again, before the start",
               assumed, numerics::all_numbers(), [](auto& p) { return &p.initial.preload; }),
      whole_row(
          parameter::initial::history::reversals, 60, "1",
          "number of random $torque levels, alternately up and down, to which the contact is loaded before the start",
          assumed, numerics::closed(0, 1000), [](auto& p) { return &p.initial.history.reversals; }),
      real_row(parameter::initial::history::torque, 61, "N m", "maximum |$torque| of these levels", assumed,
               numerics::at_least(0), [](auto& p) { return &p.initial.history.torque; }),
      ideal_at(0, "at rest at the start",
               real_row(parameter::initial::velocity, 58, "rad/s", "velocity of the $rotor at the start",
                        assumed, numerics::all_numbers(), [](auto& p) { return &p.initial.velocity; })),
      ideal_at(0, "no integral at the start",
               real_row(parameter::initial::integral, 59, "N m",
                        "integral of the controller before the first sample", assumed,
                        numerics::all_numbers(), [](auto& p) { return &p.initial.integral; })),
      word_row(parameter::initial::mode, beyond_moves(5), "state of the hook at the start", assumed,
               {"stick", "slide"}, [](auto& p) { return &p.initial.mode; }),
      bool_row(parameter::initial::holding, beyond_moves(31),
               "whether the contact carries the constant disturbance at the start", assumed,
               [](auto& p) { return &p.initial.holding; }),
      real_row(parameter::initial::gap, beyond_moves(287), "1",
               "twist of the coupling of the second mass at the start, of its gap", assumed,
               numerics::closed(-0.5, 0.5), [](auto& p) { return &p.initial.gap; }),
  };
}

std::vector<Parameter> verdict_rows() {
  return {
      real_row(parameter::verdict::dwell, 27, "s", "time at zero error after which a move has arrived",
               assumed, numerics::above(0), [](auto& p) { return &p.verdict.dwell; }),
      real_row(parameter::verdict::window, 28, "s", "final part of a move, which decides its outcome",
               assumed, numerics::above(0), [](auto& p) { return &p.verdict.window; }),
      bool_row(parameter::verdict::stop, beyond_moves(6),
               "whether a trial ends as soon as a move has diverged, which decides its outcome", assumed,
               [](auto& p) { return &p.verdict.stop; }),
      real_row(parameter::verdict::limit, 62, "count",
               "a move has diverged when |error| exceeds its value at the first sample by more than this",
               assumed, numerics::above(1), [](auto& p) { return &p.verdict.limit; }),
      bool_row(parameter::verdict::motion, beyond_moves(62),
               "whether the true motion is measured too: at rest, while following, and from step to step",
               assumed, [](auto& p) { return &p.verdict.motion; }),
      real_row(parameter::verdict::rest_band, beyond_moves(63), "count",
               "|error| within which a move is at rest, for the measures of the true motion", assumed,
               numerics::closed(0, max_count), [](auto& p) { return &p.verdict.rest_band; }),
  };
}

}  // namespace zerocount::parameters
