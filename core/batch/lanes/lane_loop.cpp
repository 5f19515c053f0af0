#include "core/batch/lanes/lane_loop.hpp"

#include <algorithm>
#include <cmath>

#include "core/batch/lanes/lane_needs.hpp"

namespace zerocount::batch {

LaneLoop::LaneLoop(const trial::TrialParameters& p)
    : measurement_(p.encoder, p.initial.encoder_phase, p.initial.position, p.randomness,
                   1.0 / p.controller.sample_rate),
      errors_(p.dac, p.randomness),
      is_certain_(is_certain(p)),
      may_stay_(is_steady_at_zero(p)) {
  if (p.command.torque.levels.empty()) {
    closed_.emplace(p, measurement_);
  } else {
    open_.emplace(p);
  }
}

void LaneLoop::start_move(std::size_t number, std::int64_t target, std::int64_t first_sample) {
  first_sample_ = first_sample;
  target_ = target;
  reference_offset_ = 0;
  disagreements_before_ = measurement_.disagreements();
  closed_ ? closed_->start_move(number) : open_->start_move(number);
}

void LaneLoop::finish(trial::MoveOutcome& outcome) {
  outcome.encoder_disagreement = measurement_.disagreements() - disagreements_before_;
  if (closed_) {
    closed_->finish(outcome);
  } else {
    outcome.travel_time = open_->travel_time();
  }
}

LaneLoop::Decision LaneLoop::decide_open(std::int64_t k, std::int64_t i, std::int64_t count) {
  const trial::OpenLoop::Decision decision = open_->decide(i);
  const loop::DacOutput& output = decision.output;
  const double torque = decision.exact ? output.torque : errors_.torque(k, output);
  return {count, output, torque, false, decision.stays && is_certain_};
}

std::optional<LaneLoop::Decision> LaneLoop::sample(std::int64_t i, double theta, double other) {
  const double finest = measurement_.finest_resolution();
  if (!(std::abs(theta) < 0x1p50 * finest)) return std::nullopt;
  const std::int64_t k = first_sample_ + i;
  const loop::EncoderReading reading = measurement_.read(k, theta);
  if (open_) return decide_open(k, i, reading.fine);
  const trial::SampledLoop::Decision decision = closed_->decide(k, i, reading, theta, other);
  if (closed_->failed()) return std::nullopt;
  const bool twice_in_a_row = decision.ran && ran_before_;
  ran_before_ = decision.ran;
  reference_offset_ = decision.target - target_;
  return Decision{
      reading.fine - reference_offset_, decision.output, errors_.torque(k, decision.output),
      may_stay_ && twice_in_a_row && closed_->phase() == loop::ControlPhase::fine && decision.arrived, false};
}

}  // namespace zerocount::batch
