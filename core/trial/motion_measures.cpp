#include "core/trial/motion_measures.hpp"

#include <algorithm>
#include <cmath>

#include "core/trial/move_measures.hpp"

namespace zerocount::trial {

MotionMeasures::MotionMeasures(const TrialParameters& p, double resolution)
    : resolution_(resolution),
      phase_(p.initial.encoder_phase),
      sample_time_(1.0 / p.controller.sample_rate),
      dwell_(samples_in(p.verdict.dwell, p.controller.sample_rate)),
      window_(samples_in(p.verdict.window, p.controller.sample_rate)),
      band_(p.verdict.rest_band),
      period_(1.0 / p.command.profile.frequency),
      position_before_(-true_error(0, 0.0, resolution, phase_)) {}

void MotionMeasures::start_move(std::int64_t target, std::int64_t samples) {
  from_ = target_;
  target_ = static_cast<double>(target);
  samples_ = samples;
  entered_ = false;
  rest_ = {};
  following_ = {};
  position_sum_ = 0.0;
}

void MotionMeasures::add(const MotionSample& sample, const loop::Reference& reference) {
  const double t = static_cast<double>(sample.number) * sample_time_;
  const double position = -true_error(0, sample.theta, resolution_, phase_);
  const double followed = reference.exact_at(t) - position;
  add_to_rest(sample, reference.moves_for_ever() ? followed : target_ - position);
  if (t < reference.duration()) add_to_following(t, followed, reference);
  if (sample.number >= samples_ - window_) position_sum_ += position - target_;
}

void MotionMeasures::add_to_rest(const MotionSample& sample, double true_error) {
  const bool inside = std::abs(static_cast<double>(sample.error)) <= band_;
  if (!inside && !entered_) {
    rest_ = {};
    return;
  }
  if (rest_.samples > 0) {
    const double change = sample.torque - rest_.last_torque;
    rest_.squared_changes += change * change;
  }
  ++rest_.samples;
  rest_.squared_errors += true_error * true_error;
  rest_.lowest = std::min(rest_.lowest, true_error);
  rest_.highest = std::max(rest_.highest, true_error);
  rest_.squared_torques += sample.torque * sample.torque;
  rest_.last_torque = sample.torque;
  entered_ = entered_ || rest_.samples >= dwell_;
}

/// Adds a sample at the time t (s) with this following error to the measures of following. A sine is followed
/// from the end of its first period on. Its reference turns at the odd quarters of a period; the spike of a
/// reversal is sought in the quarter of a period after it.
void MotionMeasures::add_to_following(double t, double error, const loop::Reference& reference) {
  const double size = std::abs(error);
  if (reference.is_sine()) {
    if (t < period_) return;
    const double quarter = std::floor(4.0 * t / period_);
    const bool after_reversal = std::fmod(quarter, 2.0) == 1.0;
    const bool is_whole = (quarter + 1.0) * period_ <= 4.0 * static_cast<double>(samples_) * sample_time_;
    if (after_reversal && is_whole) following_.spike = std::fmax(following_.spike, size);
  }
  ++following_.samples;
  following_.squared_errors += error * error;
  following_.peak = std::max(following_.peak, size);
}

void MotionMeasures::finish(MoveOutcome& outcome) {
  if (outcome.stopped || outcome.outcome == Outcome::nonfinite) return;
  if (entered_) {
    const auto samples = static_cast<double>(rest_.samples);
    outcome.rest_error_rms = std::sqrt(rest_.squared_errors / samples);
    outcome.rest_error_range = rest_.highest - rest_.lowest;
    outcome.rest_motion_rms = outcome.rest_error_rms * resolution_;
    outcome.rest_motion_range = outcome.rest_error_range * resolution_;
    outcome.rest_torque_power = rest_.squared_torques / samples;
    if (rest_.samples > 1) outcome.rest_torque_noise = rest_.squared_changes / (samples - 1.0);
  }
  if (following_.samples > 0) {
    outcome.following_error_rms =
        std::sqrt(following_.squared_errors / static_cast<double>(following_.samples));
    outcome.following_error_peak = following_.peak;
    outcome.reversal_spike = following_.spike;
  }
  const double position = target_ + position_sum_ / static_cast<double>(window_);
  const double step = target_ - from_;
  outcome.step_motion = position - position_before_;
  outcome.step_made = std::abs(outcome.step_motion - step) <= 0.5 * std::max(1.0, std::abs(step));
  position_before_ = position;
}

}  // namespace zerocount::trial
