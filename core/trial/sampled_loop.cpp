#include "core/trial/sampled_loop.hpp"

#include <cmath>

#include "core/trial/machine.hpp"

namespace zerocount::trial {

SampledLoop::SampledLoop(const TrialParameters& p, const loop::Measurement& measurement)
    : p_(p),
      sample_time_(1.0 / p.controller.sample_rate),
      clock_(p.controller, p.randomness),
      controller_(p.controller, p.encoder, initial_integral(p),
                  {{loop::lowest_torque(p.dac), loop::highest_torque(p.dac)}, p.dac.resolution},
                  start_of_motion(p)),
      converter_(p.dac),
      resolution_(measurement.fine_resolution()) {
  if (const double held = held_torque(p); held != 0.0) {
    controller_.hold(held);
    output_ = loop::Converter(p.dac).convert(held);
  }
  if (p.verdict.motion) motion_.emplace(p, resolution_);
  if (p.verdict.position_error) position_error_.emplace(p, resolution_);
  if (p.verdict.other_mass) other_mass_.emplace(p, resolution_);
}

void SampledLoop::start_move(std::size_t number) {
  const std::int64_t from = number == 0 ? 0 : target_;
  target_ = p_.command.targets[number];
  reference_.emplace(p_.command.profile, from, target_, resolution_);
  phase_changes_before_ = controller_.phase_changes();
  if (motion_) motion_->start_move(target_, samples_of_move(p_, number));
  if (position_error_) position_error_->start_move(number);
  if (other_mass_) other_mass_->start_move(number);
}

SampledLoop::Decision SampledLoop::decide(std::int64_t k, std::int64_t i, const loop::EncoderReading& reading,
                                          double theta, double other) {
  const double t = static_cast<double>(i) * sample_time_;
  const std::int64_t reference = reference_->at(t);
  const std::int64_t target = reference_->moves_for_ever() ? reference : target_;
  const bool runs = clock_.runs(k);
  if (runs) {
    loop::ReferenceMotion motion = reference_->motion_at(t);
    if (p_.controller.user.plugin) motion.position = reference_->exact_at(t);
    const bool new_target = last_target_ && *last_target_ != target_;
    last_target_ = target_;
    const loop::Dither& dither = p_.controller.dither;
    wanted_ = controller_.update(reference, reading, output_.torque, motion, new_target, k);
    const double torque = wanted_ + loop::dither_torque(dither.amplitude, dither.frequency,
                                                        p_.controller.sample_rate, static_cast<double>(k));
    failed_ = !std::isfinite(torque);
    output_ = converter_.convert(failed_ ? 0.0 : torque);
  }
  if (motion_) motion_->add({i, target - reading.fine, theta, output_.torque}, *reference_);
  if (position_error_) position_error_->add(i, theta, *reference_);
  if (other_mass_) {
    const bool closes = !motion::has_load(p_.plant) || p_.plant.load.encoder == p_.verdict.other_mass;
    other_mass_->add(i, closes ? theta : other, *reference_);
  }
  return {reference, target, output_, runs, t >= reference_->duration(), wanted_};
}

void SampledLoop::finish(MoveOutcome& outcome) {
  outcome.travel_time = reference_->travel_time();
  outcome.phase_changes = controller_.phase_changes() - phase_changes_before_;
  outcome.controller_failed = failed_;
  if (motion_) motion_->finish(outcome);
  MoveOutcome other = outcome;
  if (position_error_) position_error_->finish(outcome);
  if (!other_mass_) return;
  other_mass_->finish(other);
  outcome.other_tolerance_settling_times = other.tolerance_settling_times;
  outcome.other_true_overshoot = other.true_overshoot;
  outcome.other_true_error =
      outcome.true_error + (other_mass_->last() - position_error_->last()) / resolution_;
}

}  // namespace zerocount::trial
