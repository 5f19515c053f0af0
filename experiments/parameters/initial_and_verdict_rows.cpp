#include "experiments/parameters/parameter_rows.hpp"

namespace zerocount::parameters {

std::vector<Parameter> initial_rows() {
  return {
      stored_at(
          real_row("initial.encoder_phase", "count", "where inside a count the rotor stands at the start",
                   assumed, numerics::half_open(0, 1)),
          [](auto& p) -> auto& { return p.initial.encoder_phase; }),
      stored_at(
          real_row("initial.position", "rad", "where on the rotor the contact is; selects from the profiles",
                   assumed, numerics::all_numbers()),
          [](auto& p) -> auto& { return p.initial.position; }),
      stored_at(
          real_row("initial.hardening", "rad", "work hardening xh at the start", assumed,
                   numerics::at_least(0)),
          [](auto& p) -> auto& { return p.initial.hardening; }),
      stored_at(
          real_row("initial.preload", "N m", "torque of a slow load-and-unload from virgin before the start",
                   assumed, numerics::all_numbers()),
          [](auto& p) -> auto& { return p.initial.preload; }),
      stored_at(
          whole_row("initial.history.reversals", "1",
                    "number of random torque levels that the contact is loaded to, up and down by turns, "
                    "before the start",
                    assumed, numerics::closed(0, 1000)),
          [](auto& p) -> auto& { return p.initial.history.reversals; }),
      stored_at(
          real_row("initial.history.torque", "N m", "largest magnitude of these levels", assumed,
                   numerics::at_least(0)),
          [](auto& p) -> auto& { return p.initial.history.torque; }),
      stored_at(
          real_row("initial.velocity", "rad/s", "velocity of the rotor at the start", assumed,
                   numerics::all_numbers()),
          [](auto& p) -> auto& { return p.initial.velocity; }),
      stored_at(
          real_row("initial.integral", "N m", "integral of the controller before the first sample", assumed,
                   numerics::all_numbers()),
          [](auto& p) -> auto& { return p.initial.integral; }),
      stored_at(
          word_row("initial.mode", "whether the hook sticks at the start, or slides", assumed,
                   {"stick", "slide"}),
          [](auto& p) -> auto& { return p.initial.mode; }),
  };
}

std::vector<Parameter> verdict_rows() {
  return {
      stored_at(
          real_row("verdict.dwell", "s", "time at zero error that makes an arrival", assumed,
                   numerics::above(0)),
          [](auto& p) -> auto& { return p.verdict.dwell; }),
      stored_at(
          real_row("verdict.window", "s", "last part of a move, by which its outcome is judged", assumed,
                   numerics::above(0)),
          [](auto& p) -> auto& { return p.verdict.window; }),
      stored_at(
          truth_row("verdict.stop",
                    "whether a trial ends where a move has diverged, its outcome being decided", assumed),
          [](auto& p) -> auto& { return p.verdict.stop; }),
      stored_at(
          real_row("verdict.limit", "count",
                   "|error| beyond that at the move's first sample by which it has diverged", assumed,
                   numerics::above(1)),
          [](auto& p) -> auto& { return p.verdict.limit; }),
  };
}

}  // namespace zerocount::parameters
