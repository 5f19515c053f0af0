#include "core/theory/gains.hpp"

namespace zerocount {

double sample_time(const ControllerParameters& controller) {
  return 1.0 / controller.sample_rate;
}

AnalogueGains analogue_gains(const ControllerParameters& controller, const EncoderParameters& encoder) {
  const double dx = fine_resolution(encoder);
  const double T = sample_time(controller);
  return {controller.kp / dx, 2.0 * controller.ki / (dx * T), controller.kd * T / dx};
}

PidGains sampled_gains(const AnalogueGains& gains, const ControllerParameters& controller,
                       const EncoderParameters& encoder) {
  const double dx = fine_resolution(encoder);
  const double T = sample_time(controller);
  return {gains.kp * dx, gains.ki * dx * T / 2.0, gains.kd * dx / T};
}

ControllerParameters with_analogue_gains(ControllerParameters controller, const AnalogueGains& gains,
                                         const EncoderParameters& encoder) {
  const PidGains sampled = sampled_gains(gains, controller, encoder);
  controller.kp = sampled.kp;
  controller.ki = sampled.ki;
  controller.kd = sampled.kd;
  return controller;
}

}  // namespace zerocount
