#include "core/batch/lanes/lane_loop.hpp"

#include <algorithm>
#include <cmath>

#include "core/batch/lanes/lane_needs.hpp"

namespace zerocount::batch {

LaneLoop::LaneLoop(const trial::TrialParameters& p)
    : measurement_(p.encoder, p.initial.encoder_phase, p.initial.position, p.randomness,
                   1.0 / p.controller.sample_rate),
      loop_(p, measurement_),
      errors_(p.dac, p.randomness),
      may_stay_(is_steady_at_zero(p)) {}

void LaneLoop::start_move(std::size_t number, std::int64_t target, std::int64_t first_sample) {
  first_sample_ = first_sample;
  target_ = target;
  reference_offset_ = 0;
  disagreements_before_ = measurement_.disagreements();
  loop_.start_move(number);
}

void LaneLoop::finish(trial::MoveOutcome& outcome) {
  outcome.encoder_disagreement = measurement_.disagreements() - disagreements_before_;
  loop_.finish(outcome);
}

std::optional<LaneLoop::Decision> LaneLoop::sample(std::int64_t i, double theta) {
  const double finest = std::min(measurement_.fine_resolution(), measurement_.coarse_resolution());
  if (!(std::abs(theta) < 0x1p50 * finest)) return std::nullopt;
  const std::int64_t k = first_sample_ + i;
  const loop::EncoderReading reading = measurement_.read(k, theta);
  const trial::SampledLoop::Decision decision = loop_.decide(k, i, reading, theta);
  if (loop_.failed()) return std::nullopt;
  const bool twice_in_a_row = decision.ran && ran_before_;
  ran_before_ = decision.ran;
  reference_offset_ = decision.target - target_;
  return Decision{
      reading.fine - reference_offset_, decision.output, errors_.torque(k, decision.output),
      may_stay_ && twice_in_a_row && loop_.phase() == loop::ControlPhase::fine && decision.arrived};
}

}  // namespace zerocount::batch
