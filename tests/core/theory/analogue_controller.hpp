#pragma once

#include "core/theory/gains.hpp"

namespace zerocount::theory {

/// `controller` with the sampled gains that stand for these continuous gains.
inline loop::ControllerParameters with_analogue_gains(loop::ControllerParameters controller,
                                                      const AnalogueGains& gains,
                                                      const loop::EncoderParameters& encoder) {
  const loop::PidGains sampled = sampled_gains(gains, controller, encoder);
  controller.kp = sampled.kp;
  controller.ki = sampled.ki;
  controller.kd = sampled.kd;
  return controller;
}

}  // namespace zerocount::theory
