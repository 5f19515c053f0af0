#include "experiments/parameters/parameter_rows.hpp"

namespace zerocount::parameters {
std::vector<Parameter> controller_rows() {
  constexpr std::string_view integral_alone = "paper, section 4 (integral control alone)";
  return {
      real_row("controller.sample_rate", 20, "Hz", "sampling rate of the loop", "paper, section 4",
               numerics::above(0), [](auto& p) { return &p.controller.sample_rate; }),
      in_si(real_row("controller.kp", 21, "N m/count", "proportional gain", integral_alone,
                     numerics::closed(0, 1e6), [](auto& p) { return &p.controller.kp; }),
            "N m/rad", "proportional gain"),
      in_si(real_row("controller.ki", 22, "N m/count", "integral gain k_ID of the trapezoidal rule",
                     "paper, section 4 (a)", numerics::closed(0, 1e6),
                     [](auto& p) { return &p.controller.ki; }),
            "N m/(rad s)", "integral gain"),
      in_si(real_row("controller.kd", 23, "N m/count", "gain on the difference of successive counts",
                     integral_alone, numerics::closed(0, 1e6), [](auto& p) { return &p.controller.kd; }),
            "N m s/rad", "derivative gain"),
      whole_row("controller.delay", 24, "sample", "samples between deciding a torque and applying it",
                assumed, numerics::closed(0, 100), [](auto& p) { return &p.controller.delay; }),
      word_row("controller.anti_windup", 25, "what keeps the integral inside the converter's range", assumed,
               {"clamp", "none"}, [](auto& p) { return &p.controller.anti_windup; }),
      word_row("controller.encoder", beyond_moves(1),
               "encoder that closes the loop; with a coarse phase, in the fine one", "paper, section 4",
               {"fine", "coarse"}, [](auto& p) { return &p.controller.encoder; }),

      in_si(real_row("controller.coarse.kp", 46, "N m/count", "proportional gain of the coarse phase",
                     assumed, numerics::closed(0, 1e6), [](auto& p) { return &p.controller.coarse.kp; }),
            "N m/rad", "proportional gain of the coarse phase"),
      in_si(real_row("controller.coarse.ki", 47, "N m/count", "integral gain of the coarse phase", assumed,
                     numerics::closed(0, 1e6), [](auto& p) { return &p.controller.coarse.ki; }),
            "N m/(rad s)", "integral gain of the coarse phase"),
      in_si(real_row("controller.coarse.kd", 48, "N m/count",
                     "gain of the coarse phase on the difference of successive counts", assumed,
                     numerics::closed(0, 1e6), [](auto& p) { return &p.controller.coarse.kd; }),
            "N m s/rad", "derivative gain of the coarse phase"),
      word_row("controller.coarse.encoder", beyond_moves(2),
               "encoder that closes the loop in the coarse phase", assumed, {"fine", "coarse"},
               [](auto& p) { return &p.controller.coarse.encoder; }),
      real_row("controller.coarse.fine_within", 49, "count",
               "largest |error| with which the fine phase is entered", assumed,
               numerics::closed(0, max_count), [](auto& p) { return &p.controller.coarse.fine_within; }),
      real_row("controller.coarse.fine_rate", 50, "count/sample",
               "largest change of the count per sample with which the fine phase is entered", assumed,
               numerics::at_least(0), [](auto& p) { return &p.controller.coarse.fine_rate; }),
      real_row("controller.coarse.fine_dwell", 51, "s", "time for which both must have held", assumed,
               numerics::at_least(0), [](auto& p) { return &p.controller.coarse.fine_dwell; }),
      or_never(real_row("controller.coarse.coarse_beyond", 52, "count",
                        "|error| beyond which the coarse phase is entered; 1e12: there is none", assumed,
                        numerics::closed(0, max_count)),
               [](auto& p) { return &p.controller.coarse.coarse_beyond; }),
  };
}

}  // namespace zerocount::parameters
