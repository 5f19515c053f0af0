#include "core/theory/gains.hpp"

namespace zerocount::theory {

double sample_time(const loop::ControllerParameters& controller) {
  return 1.0 / controller.sample_rate;
}

AnalogueGains analogue_gains(const loop::ControllerParameters& controller,
                             const loop::EncoderParameters& encoder) {
  const double dx = loop::fine_resolution(encoder);
  const double T = sample_time(controller);
  return {controller.kp / dx, 2.0 * controller.ki / (dx * T), controller.kd * T / dx};
}

loop::PidGains sampled_gains(const AnalogueGains& gains, const loop::ControllerParameters& controller,
                             const loop::EncoderParameters& encoder) {
  const double dx = loop::fine_resolution(encoder);
  const double T = sample_time(controller);
  return {gains.kp * dx, gains.ki * dx * T / 2.0, gains.kd * dx / T};
}

}  // namespace zerocount::theory
