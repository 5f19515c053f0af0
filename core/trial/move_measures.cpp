#include "core/trial/move_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/numerics/sign.hpp"

namespace zerocount {
namespace {

/// @param largest_error max |e| in the window, counts.
Outcome verdict(std::int64_t largest_error, std::int64_t target, const LastHalf& last_half) {
  if (largest_error == 0) return Outcome::zero_count;
  if (largest_error == 1) return Outcome::one_count;
  return last_half.only_approaches(target) ? Outcome::off_target : Outcome::oscillating;
}

}  // namespace

MoveTiming move_timing(const TrialParameters& parameters, std::size_t move) {
  const double rate = parameters.controller.sample_rate;
  return {1.0 / rate, samples_of_move(parameters, move), samples_in(parameters.verdict.dwell, rate),
          samples_in(parameters.verdict.window, rate), parameters.command.torque.levels.empty()};
}

void judge_end(const MoveTiming& timing, const MoveEnd& end, const LastHalf& last_half,
               MoveOutcome& outcome) {
  if (outcome.stopped) {
    outcome.outcome = Outcome::oscillating;
  } else if (!end.finite) {
    outcome.outcome = Outcome::nonfinite;
  } else {
    outcome.outcome = verdict(end.largest_in_window, end.target, last_half);
    outcome.midway_error = end.target - last_half.first();
    if (end.zeros_in_a_row > 0) {
      outcome.final_settling_time =
          static_cast<double>(end.samples - end.zeros_in_a_row) * timing.sample_time;
    }
    if (outcome.outcome == Outcome::oscillating) {
      outcome.oscillation_amplitude = last_half.amplitude();
      outcome.oscillation_period = last_half.period(timing.sample_time);
    }
  }
  if (!outcome.arrived) return;
  const auto since_arrival = static_cast<double>(end.samples - outcome.arrival);
  outcome.zero_fraction = (since_arrival - static_cast<double>(end.jerk_samples)) / since_arrival;
}

bool MoveMeasures::add(const MoveSample& sample) {
  const std::int64_t error = sample.target - sample.count;
  outcome_.final_error = error;
  outcome_.holding_torque = sample.torque;
  outcome_.peak_torque = std::max(outcome_.peak_torque, std::abs(sample.torque));
  outcome_.saturated = outcome_.saturated || sample.clipped;
  outcome_.creep = sample.creep;
  outcome_.final_position = sample.theta;
  const bool jerk_ended = timing_.judged && judge(sample);
  ++k_;
  return jerk_ended;
}

/// What the error says of the move so far. Returns whether a jerk ended before this sample.
bool MoveMeasures::judge(const MoveSample& sample) {
  const std::int64_t error = sample.target - sample.count;
  if (k_ == 0) direction_ = sign_of(error);

  const bool dwelt = outcome_.arrived;  // the dwell ended before this sample
  zeros_in_a_row_ = error == 0 ? zeros_in_a_row_ + 1 : 0;
  if (!outcome_.arrived && zeros_in_a_row_ == timing_.dwell) {
    outcome_.arrived = true;
    outcome_.arrival = k_ - timing_.dwell + 1;
    outcome_.settling_time = static_cast<double>(outcome_.arrival) * timing_.sample_time;
  }
  if (dwelt) largest_since_arrival_ = std::max(largest_since_arrival_, std::abs(error));
  if (k_ >= timing_.samples - timing_.window)
    largest_in_window_ = std::max(largest_in_window_, std::abs(error));

  outcome_.overshoot = std::max(outcome_.overshoot, -direction_ * error);
  follow_last_half(sample.count);
  target_ = sample.target;
  count_ = sample.count;
  return dwelt && track_jerk(error);
}

void MoveMeasures::follow_last_half(std::int64_t count) {
  const std::int64_t half = first_of_last_half(timing_.samples);
  if (k_ >= half) last_half_.add(k_, k_ == half ? count : count_, count);
}

bool MoveMeasures::track_jerk(std::int64_t error) {
  if (error == 0) {
    if (!in_jerk_) return false;
    end_jerk();
    return true;
  }
  if (!in_jerk_) {
    in_jerk_ = true;
    jerk_start_ = k_;
    jerk_ = {move_, static_cast<double>(k_) * timing_.sample_time, 0.0, 0, -sign_of(error)};
  }
  jerk_.magnitude = std::max(jerk_.magnitude, std::abs(error));
  return false;
}

void MoveMeasures::end_jerk() {
  in_jerk_ = false;
  jerk_.duration = static_cast<double>(k_ - jerk_start_) * timing_.sample_time;
  jerk_samples_ += k_ - jerk_start_;
  ++outcome_.jerk_count;
  ++(jerk_.direction > 0 ? jerks_up_ : jerks_down_);
}

bool MoveMeasures::finish(bool broke_away, std::int64_t reversal_depth, bool finite) {
  const bool jerk_cut = in_jerk_;
  if (jerk_cut) end_jerk();
  outcome_.broke_away = broke_away;
  outcome_.reversal_depth = reversal_depth;
  if (timing_.judged) {
    last_half_.finish(count_);
    judge_end(timing_, {target_, k_, zeros_in_a_row_, jerk_samples_, largest_in_window_, finite}, last_half_,
              outcome_);
  } else {
    outcome_.outcome = finite ? Outcome::open_loop : Outcome::nonfinite;
  }
  outcome_.stable = finite && outcome_.arrived && largest_since_arrival_ <= 1;
  if (outcome_.jerk_count > 0) {
    const std::int64_t agreeing =
        outcome_.holding_torque > 0.0 ? jerks_up_ : (outcome_.holding_torque < 0.0 ? jerks_down_ : 0);
    outcome_.jerk_agreement = static_cast<double>(agreeing) / static_cast<double>(outcome_.jerk_count);
  }
  return jerk_cut;
}

}  // namespace zerocount
