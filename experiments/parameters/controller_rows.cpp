#include "experiments/parameters/parameter_rows.hpp"

namespace zerocount::parameters {
std::vector<Parameter> controller_rows() {
  constexpr std::string_view integral_alone = "paper, section 4 (integral control alone)";
  return {
      real_row("controller.sample_rate", "Hz", "sampling rate of the loop", "paper, section 4",
               numerics::above(0), [](auto& p) { return &p.controller.sample_rate; }),
      in_si(real_row("controller.kp", "N m/count", "proportional gain", integral_alone,
                     numerics::closed(0, 1e6), [](auto& p) { return &p.controller.kp; }),
            "N m/rad", "proportional gain"),
      in_si(real_row("controller.ki", "N m/count", "integral gain k_ID of the trapezoidal rule",
                     "paper, section 4 (a)", numerics::closed(0, 1e6),
                     [](auto& p) { return &p.controller.ki; }),
            "N m/(rad s)", "integral gain"),
      in_si(real_row("controller.kd", "N m/count", "gain on the difference of successive counts",
                     integral_alone, numerics::closed(0, 1e6), [](auto& p) { return &p.controller.kd; }),
            "N m s/rad", "derivative gain"),
      whole_row("controller.delay", "sample", "samples between deciding a torque and applying it", assumed,
                numerics::closed(0, 100), [](auto& p) { return &p.controller.delay; }),
      word_row("controller.anti_windup", "what keeps the integral inside the converter's range", assumed,
               {"clamp", "none"}, [](auto& p) { return &p.controller.anti_windup; }),
      word_row("controller.encoder", "encoder that closes the loop; with a coarse phase, in the fine one",
               "paper, section 4", {"fine", "coarse"}, [](auto& p) { return &p.controller.encoder; }),

      in_si(real_row("controller.coarse.kp", "N m/count", "proportional gain of the coarse phase", assumed,
                     numerics::closed(0, 1e6), [](auto& p) { return &p.controller.coarse.kp; }),
            "N m/rad", "proportional gain of the coarse phase"),
      in_si(real_row("controller.coarse.ki", "N m/count", "integral gain of the coarse phase", assumed,
                     numerics::closed(0, 1e6), [](auto& p) { return &p.controller.coarse.ki; }),
            "N m/(rad s)", "integral gain of the coarse phase"),
      in_si(real_row("controller.coarse.kd", "N m/count",
                     "gain of the coarse phase on the difference of successive counts", assumed,
                     numerics::closed(0, 1e6), [](auto& p) { return &p.controller.coarse.kd; }),
            "N m s/rad", "derivative gain of the coarse phase"),
      word_row("controller.coarse.encoder", "encoder that closes the loop in the coarse phase", assumed,
               {"fine", "coarse"}, [](auto& p) { return &p.controller.coarse.encoder; }),
      real_row("controller.coarse.fine_within", "count",
               "largest |error| with which the fine phase is entered", assumed,
               numerics::closed(0, max_count), [](auto& p) { return &p.controller.coarse.fine_within; }),
      real_row("controller.coarse.fine_rate", "count/sample",
               "largest change of the count per sample with which the fine phase is entered", assumed,
               numerics::at_least(0), [](auto& p) { return &p.controller.coarse.fine_rate; }),
      real_row("controller.coarse.fine_dwell", "s", "time for which both must have held", assumed,
               numerics::at_least(0), [](auto& p) { return &p.controller.coarse.fine_dwell; }),
      or_never(real_row("controller.coarse.coarse_beyond", "count",
                        "|error| beyond which the coarse phase is entered; 1e12: there is none", assumed,
                        numerics::closed(0, max_count)),
               [](auto& p) { return &p.controller.coarse.coarse_beyond; }),
  };
}

}  // namespace zerocount::parameters
