#pragma once

#include <cstdint>

namespace zerocount {

/// The two encoders on the shaft. Defaults: the paper's rig.
struct EncoderParameters {
  double fine{1620000.0};  ///< counts per revolution of the encoder that closes the loop, a whole number
  double coarse{86400.0};  ///< counts per revolution of the encoder read beside it, a whole number
};

/// The digital-to-analogue converter. Defaults: the paper's rig.
struct DacParameters {
  int bits{12};               ///< word length, codes −2^(bits−1) … 2^(bits−1) − 1
  double resolution{2.4e-4};  ///< Δu, torque of one code, N m
};

enum class AntiWindup { clamp, none };

/// PID control of the fine count.
struct ControllerParameters {
  double sample_rate{2000.0};  ///< 1/T, Hz
  double kp{0.0};              ///< N m/count
  double ki{3.85e-5};          ///< k_ID = k_I·Δx·T/2 of the trapezoidal rule, N m/count
  double kd{0.0};              ///< on the difference of successive counts, N m/count
  int delay{0};                ///< samples between deciding a torque and applying it
  AntiWindup anti_windup{AntiWindup::clamp};
};

}  // namespace zerocount
