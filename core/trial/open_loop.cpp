#include "core/trial/open_loop.hpp"

#include "core/trial/torque_record.hpp"

namespace zerocount::trial {

void OpenLoop::start_move(std::size_t number) {
  const TorqueCommand& command = p_.command.torque;
  const double from = number == 0 ? 0.0 : command.levels[number - 1];
  ramp_ = make_torque_ramp(from, command.levels[number], command.rate, p_.controller.sample_rate);
}

OpenLoop::Decision OpenLoop::decide(std::int64_t i) {
  const TorqueCommand& command = p_.command.torque;
  const double sample_time = 1.0 / p_.controller.sample_rate;
  const double torque =
      command.record ? torque_at(*command.record, static_cast<double>(i) * sample_time) : torque_at(ramp_, i);
  const bool exact = command.through == TorquePath::exact;
  const bool held = !command.record && i >= ramp_.samples;
  if (exact) {
    const double limited = converter_.within_limit(torque);
    return {{0, limited, limited != torque}, true, held};
  }
  return {converter_.convert(torque), false, held && !p_.dac.sigma_delta};
}

double OpenLoop::travel_time() const {
  return static_cast<double>(ramp_.samples) * (1.0 / p_.controller.sample_rate);
}

}  // namespace zerocount::trial
