#include "core/loop/controller.hpp"

#include <limits>

namespace zerocount {
namespace {

PidGains fine_gains(const ControllerParameters& p) {
  return {p.kp, p.ki, has_coarse_phase(p) ? 0.0 : p.kd};
}

PidGains coarse_gains(const ControllerParameters& p) {
  return {p.coarse.kp, p.coarse.ki, p.coarse.kd};
}

}  // namespace

TorqueRange integral_range(AntiWindup anti_windup, double lowest, double highest) {
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  switch (anti_windup) {
    case AntiWindup::clamp:
      return {lowest, highest};
    case AntiWindup::none:
      break;
  }
  return {-unbounded, unbounded};
}

bool has_coarse_phase(const ControllerParameters& parameters) {
  return parameters.coarse.coarse_beyond < std::numeric_limits<double>::infinity();
}

Controller::Controller(const ControllerParameters& parameters, double fine_per_coarse, double integral,
                       double lowest, double highest)
    : two_phases_(has_coarse_phase(parameters)),
      fine_encoder_(parameters.encoder),
      coarse_encoder_(parameters.coarse.encoder),
      fine_per_coarse_(fine_per_coarse),
      fine_(fine_gains(parameters), integral, integral_range(parameters.anti_windup, lowest, highest)),
      coarse_(coarse_gains(parameters), integral, integral_range(parameters.anti_windup, lowest, highest)),
      switch_(parameters.coarse, parameters.sample_rate) {}

double Controller::update(std::int64_t reference, const EncoderReading& reading, double torque_in_force) {
  const Feedback fine = feedback(fine_encoder_, reference, reading);
  if (!two_phases_) return fine_.update(fine);

  const Feedback coarse = feedback(coarse_encoder_, reference, reading);
  const bool changed = switch_.update(fine, coarse);
  const bool in_fine = switch_.phase() == ControlPhase::fine;
  PidController& deciding = in_fine ? fine_ : coarse_;
  PidController& resting = in_fine ? coarse_ : fine_;
  if (changed) deciding.set_integral(torque_in_force);
  resting.observe(in_fine ? coarse : fine);
  return deciding.update(in_fine ? fine : coarse);
}

double Controller::integral() const {
  return phase() == ControlPhase::fine ? fine_.integral() : coarse_.integral();
}

Feedback Controller::feedback(EncoderChoice encoder, std::int64_t reference,
                              const EncoderReading& reading) const {
  const double count = encoder == EncoderChoice::fine
                           ? static_cast<double>(reading.fine)
                           : static_cast<double>(reading.coarse) * fine_per_coarse_;
  return {static_cast<double>(reference) - count, count};
}

}  // namespace zerocount
