#include "core/trial/parameters.hpp"

#include <cmath>
#include <utility>

#include "core/trial/torque_record.hpp"

namespace zerocount::trial {

void exchange_encoders(TrialParameters& p) {
  loop::EncoderParameters& encoder = p.encoder;
  std::swap(encoder.fine, encoder.other.counts);
  std::swap(encoder.fine_length, encoder.other.length);
  std::swap(encoder.fine_errors, encoder.other.errors);
  std::swap(p.initial.encoder_phase, p.initial.other_encoder_phase);
  std::swap(p.randomness.fine_noise, p.randomness.other_noise);
  std::swap(p.randomness.fine_missed, p.randomness.other_missed);
}

std::int64_t samples_in(double duration, double sample_rate) {
  return std::llround(duration * sample_rate);
}

std::size_t move_count(const TrialParameters& parameters) {
  const CommandParameters& command = parameters.command;
  return command.torque.levels.empty() ? command.targets.size() : command.torque.levels.size();
}

std::int64_t target_of_move(const TrialParameters& parameters, std::size_t move) {
  const CommandParameters& command = parameters.command;
  return command.torque.levels.empty() ? command.targets[move] : 0;
}

std::int64_t samples_of_move(const TrialParameters& parameters, std::size_t move) {
  const double sample_rate = parameters.controller.sample_rate;
  const TorqueCommand& torque = parameters.command.torque;
  const std::int64_t held = samples_in(parameters.command.hold, sample_rate);
  if (torque.levels.empty()) return held;
  const double from = move == 0 ? 0.0 : torque.levels[move - 1];
  return held + make_torque_ramp(from, torque.levels[move], torque.rate, sample_rate).samples;
}

std::int64_t samples_of_trial(const TrialParameters& parameters) {
  const auto moves = static_cast<std::int64_t>(move_count(parameters));
  if (parameters.command.torque.levels.empty())
    return moves == 0 ? 0 : moves * samples_of_move(parameters, 0);
  std::int64_t samples = 0;
  for (std::int64_t move = 0; move < moves; ++move) {
    samples += samples_of_move(parameters, static_cast<std::size_t>(move));
  }
  return samples;
}

}  // namespace zerocount::trial
