#include "core/batch/lane_loop.hpp"

#include <algorithm>
#include <cmath>

#include "core/batch/batch_state.hpp"

namespace zerocount::batch {
namespace {

/// Whether the angle alone decides the counts, and the code the torque.
bool is_certain(const trial::TrialParameters& p) {
  return !loop::has_errors(p.encoder.fine_errors) && !loop::has_errors(p.encoder.coarse_errors) &&
         p.dac.noise == 0.0;
}

/// Whether the torque stays while count and error stay 0, the controller having run at this sample and the
/// one before: in the fine phase of two.
bool is_steady_at_zero(const trial::TrialParameters& p) {
  const loop::ControllerParameters& c = p.controller;
  const auto has_dwell = [](const loop::ControlBlocks& b) {
    return b.hold.enter >= 0.0 || b.standstill.band >= 0.0;
  };
  const bool all_fine = c.encoder == loop::EncoderChoice::fine && c.coarse.encoder == c.encoder;
  return is_certain(p) && !p.verdict.motion && !c.user.plugin && all_fine && !remembers(p) &&
         !has_dwell(c.blocks) && (!loop::has_coarse_phase(c) || !remembers(c.coarse.blocks));
}

}  // namespace

bool needs_lane_loop(const trial::TrialParameters& p) {
  return !is_certain(p) || p.verdict.motion || p.controller.missed > 0.0 || loop::has_errors(p.dac) ||
         loop::has_coarse_phase(p.controller) || p.controller.encoder != loop::EncoderChoice::fine ||
         p.command.profile.shape != loop::ReferenceShape::step || p.controller.user.plugin ||
         p.controller.blocks.filters.size() > max_lane_filters;
}

LaneLoop::LaneLoop(const trial::TrialParameters& p)
    : p_(p),
      sample_time_(1.0 / p.controller.sample_rate),
      clock_(p.controller, p.randomness),
      measurement_(p.encoder, p.initial.encoder_phase, p.initial.position, p.randomness, sample_time_),
      controller_(p.controller, {measurement_.fine_per_coarse(), measurement_.fine_resolution()},
                  p.initial.integral,
                  {{loop::lowest_torque(p.dac), loop::highest_torque(p.dac)}, p.dac.resolution}),
      converter_(p.dac),
      errors_(p.dac, p.randomness),
      may_stay_(is_steady_at_zero(p)) {
  if (p.verdict.motion) motion_.emplace(p, measurement_.fine_resolution());
}

void LaneLoop::start_move(std::size_t number, std::int64_t first_sample) {
  first_sample_ = first_sample;
  const std::int64_t from = number == 0 ? 0 : target_;
  target_ = p_.command.targets[number];
  reference_.emplace(p_.command.profile, from, target_, measurement_.fine_resolution());
  phase_changes_before_ = controller_.phase_changes();
  disagreements_before_ = measurement_.disagreements();
  reference_offset_ = 0;
  if (motion_) motion_->start_move(target_, trial::samples_of_move(p_, number));
}

void LaneLoop::finish(trial::MoveOutcome& outcome) {
  outcome.travel_time = reference_->travel_time();
  outcome.phase_changes = controller_.phase_changes() - phase_changes_before_;
  outcome.encoder_disagreement = measurement_.disagreements() - disagreements_before_;
  if (motion_) motion_->finish(outcome);
}

std::optional<LaneLoop::Decision> LaneLoop::sample(std::int64_t i, double theta) {
  const double finest = std::min(measurement_.fine_resolution(), measurement_.coarse_resolution());
  if (!(std::abs(theta) < 0x1p50 * finest)) return std::nullopt;
  const std::int64_t k = first_sample_ + i;
  const loop::EncoderReading reading = measurement_.read(k, theta);
  const double t = static_cast<double>(i) * sample_time_;
  const bool runs = clock_.runs(k);
  const bool twice_in_a_row = runs && ran_before_;
  ran_before_ = runs;
  const std::int64_t reference = reference_->at(t);
  reference_offset_ = reference_->is_sine() ? reference - target_ : 0;
  if (runs) {
    loop::ReferenceMotion motion = reference_->motion_at(t);
    if (p_.controller.user.plugin) motion.position = reference_->exact_at(t);
    const bool new_target = last_target_ && *last_target_ != target_;
    last_target_ = target_;
    const double wanted = controller_.update(reference, reading, output_.torque, motion, new_target) +
                          loop::dither_torque(p_.controller.dither.amplitude, p_.controller.dither.frequency,
                                              p_.controller.sample_rate, static_cast<double>(k));
    if (!std::isfinite(wanted)) return std::nullopt;
    output_ = converter_.convert(wanted);
  }
  const std::int64_t count = reading.fine - reference_offset_;
  if (motion_) motion_->add({i, target_ - count, theta, output_.torque}, *reference_);
  return Decision{count, output_, errors_.torque(k, output_),
                  may_stay_ && twice_in_a_row && controller_.phase() == loop::ControlPhase::fine &&
                      t >= reference_->duration()};
}

}  // namespace zerocount::batch
