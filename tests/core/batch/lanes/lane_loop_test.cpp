// Sampled loops beyond those of the ideal encoder in the lanes: noise, errors of encoders and converter,
// missed samples, two phases, profiles, measures of the true motion; and all together.
#include "tests/core/batch/expect_agreement.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

enum class LoopKind { encoder, converter, missed, phases, profile, motion, all, noise };
constexpr int loop_kinds = 8;
constexpr const char* loop_kind_names[loop_kinds] = {
    "encoder", "converter", "missed samples", "phases", "profile", "motion", "all", "noise"};

loop::EncoderErrors random_errors(RandomBlocks& draw) {
  loop::EncoderErrors errors;
  errors.eccentricity = draw.some(draw.log_uniform(1e-6, 1e-4));
  errors.eccentricity_angle = draw.uniform(0.0, 6.0);
  errors.interpolation = draw.some(draw.log_uniform(0.01, 0.3));
  errors.noise = draw.some(draw.log_uniform(0.01, 1.0));
  if (draw.chance(0.5)) errors.noise_bandwidth = draw.log_uniform(10.0, 1000.0);
  if (draw.chance(0.3)) errors.missed = draw.uniform(0.0, 0.1);
  return errors;
}

std::vector<trial::TrialParameters> trials_of(LoopKind kind, int count) {
  RandomBlocks draw(95000 + static_cast<std::uint64_t>(kind));
  std::vector<trial::TrialParameters> trials;
  for (int i = 0; i < count; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    trials.push_back(trial_for_lanes(i % 4 == 0 ? TrialKind::ringing : TrialKind::calm, 87000 + number));
    trial::TrialParameters& p = trials.back();
    const auto has = [&](LoopKind one) { return kind == one || (kind == LoopKind::all && draw.chance(0.6)); };
    if (kind == LoopKind::noise) {  // which the sampling kernels read
      p.encoder.fine_errors.noise = draw.log_uniform(0.01, 3.0);
      if (draw.chance(0.5)) p.encoder.fine_errors.noise_bandwidth = draw.log_uniform(10.0, 1000.0);
      if (draw.chance(0.5)) p.controller.blocks = draw.blocks(BlockKind::all, p.controller.sample_rate);
      if (draw.chance(0.3)) p.amplifier.bandwidth = 500.0;
      if (draw.chance(0.3)) p.verdict.position_error = true;
      p.randomness.stream = static_cast<std::uint32_t>(i % 3);
    }
    if (has(LoopKind::encoder)) p.encoder.fine_errors = random_errors(draw);
    if (has(LoopKind::encoder)) p.encoder.coarse_errors = random_errors(draw);
    if (has(LoopKind::converter)) {
      p.dac.offset = draw.some(draw.uniform(-1e-3, 1e-3));
      p.dac.gain_error = draw.some(draw.uniform(-0.1, 0.1));
      p.dac.nonlinearity = draw.some(draw.uniform(-1.0, 1.0));
      p.dac.noise = draw.some(draw.log_uniform(1e-6, 1e-3));
    }
    if (has(LoopKind::missed)) p.controller.missed = draw.uniform(0.0, 0.3);
    if (has(LoopKind::phases)) {
      p.controller.kd = 0.0;
      p.controller.coarse.coarse_beyond = draw.uniform(5.0, 80.0);
      p.controller.coarse.fine_within = 4.0;
      p.controller.coarse.fine_dwell = 2e-3;
      if (draw.chance(0.3)) p.controller.coarse.encoder = loop::EncoderChoice::coarse;
      if (draw.chance(0.1)) p.controller.encoder = loop::EncoderChoice::coarse;
    }
    if (has(LoopKind::profile)) {
      p.command.profile.shape =
          draw.chance(0.5) ? loop::ReferenceShape::trapezoidal : loop::ReferenceShape::s_curve;
      p.command.profile.velocity_limit = draw.log_uniform(1e-3, 1e-1);
      p.command.profile.acceleration_limit = draw.log_uniform(0.1, 10.0);
      p.controller.blocks.feedforward = draw.blocks(BlockKind::feedforward, 2000.0).feedforward;
    }
    if (has(LoopKind::motion)) {
      p.verdict.motion = true;
      p.verdict.rest_band = std::floor(draw.uniform(0.0, 4.0));
      if (draw.chance(0.4)) {
        p.command.profile.shape = loop::ReferenceShape::sine;
        p.command.profile.amplitude = draw.log_uniform(1e-6, 1e-4);
        p.command.profile.frequency = draw.uniform(2.01, 10.0) / p.command.hold;
      }
    }
    if (kind == LoopKind::all) p.controller.blocks = draw.blocks(BlockKind::all, p.controller.sample_rate);
    if (draw.chance(0.3)) p.controller.delay = draw.uniform(0.0, 3.0);
    p.randomness.fine_noise = {1, 2};
    p.randomness.coarse_noise = {3, 4};
    p.randomness.dac_noise = {5, 6};
    p.randomness.missed_samples = {7, 8};
    p.randomness.trial = number % 2 == 0 ? number : (number << 40) + number;
    if (i % 3 == 0) p.command.targets.push_back(p.command.targets.back() + 7);
    if (i % 2 == 0) {  // such that some arrive and rest
      p.controller.ki = 1e-5;
      p.controller.kp = p.controller.kd = 0.0;
    }
  }
  return trials;
}

TEST(BatchLaneLoop, DecidesAsThatOfTheReference) {
  for (int kind = 0; kind < loop_kinds; ++kind)
    expect_agreement_in_lanes(trials_of(static_cast<LoopKind>(kind), 80), loop_kind_names[kind]);
}

TEST(BatchLaneLoop, DependsOnNoOtherTrial) {
  std::vector<trial::TrialParameters> trials;
  for (int kind = 0; kind < loop_kinds; ++kind) {
    for (const trial::TrialParameters& p : trials_of(static_cast<LoopKind>(kind), 6)) trials.push_back(p);
    trials.push_back(trial_for_lanes(TrialKind::calm, 88000 + static_cast<std::uint64_t>(kind)));
  }
  const std::vector<BatchedTrial> few = run_batch(trials, {.lanes = 5});
  for (std::size_t i = 0; i < trials.size(); ++i)
    EXPECT_EQ(difference_in_bits(few[i], run_batch({trials[i]}, {.lanes = 1}).front()), "") << i;
}

}  // namespace
}  // namespace zerocount::testing
