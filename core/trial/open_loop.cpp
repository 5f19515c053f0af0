#include "core/trial/open_loop.hpp"

#include <cstddef>
#include <cstdint>

#include "core/random/random_numbers.hpp"
#include "core/trial/torque_record.hpp"

namespace zerocount::trial {

std::vector<double> draw_history(const RandomHistory& history, const random::TrialRandomness& randomness) {
  const random::RandomStream stream{randomness.history, randomness.stream};
  const auto uniform = [&](std::uint64_t k) {
    return random::open_uniform(random::random_bits_at(stream, randomness.trial, k));
  };
  std::vector<double> levels(static_cast<std::size_t>(history.reversals));
  double outermost = uniform(0) < 0.5 ? -history.torque : history.torque;
  double level = 0.0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    level += uniform(i + 1) * (outermost - level);
    levels[i] = level;
    outermost = -outermost;
  }
  return levels;
}

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
