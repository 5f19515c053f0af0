// The blocks of the controller in the lanes.
#include "tests/core/batch/expect_agreement.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

std::vector<trial::TrialParameters> trials_with(BlockKind kind, int count) {
  RandomBlocks draw(90000 + static_cast<std::uint64_t>(kind));
  std::vector<trial::TrialParameters> trials;
  for (int i = 0; i < count; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    trials.push_back(trial_for_lanes(i % 4 == 0 ? TrialKind::ringing : TrialKind::calm, 83000 + number));
    trial::TrialParameters& p = trials.back();
    p.controller.blocks = draw.blocks(kind, p.controller.sample_rate);
    if (kind == BlockKind::all && i % 3 == 0)
      p.controller.dither = {draw.log_uniform(1e-5, 3e-3),
                             p.controller.sample_rate * draw.uniform(0.05, 0.5)};
    p.dac.sigma_delta = kind == BlockKind::all && i % 5 == 0;
    if (i % 7 == 0) p.disturbance.torque = draw.uniform(-0.05, 0.05);
    p.initial.holding = i % 14 == 0 && p.initial.preload == 0.0 && p.initial.history.reversals == 0;
    if (i % 3 == 0) p.command.targets.push_back(p.command.targets.back() + 7);
    // Such that some arrive and rest.
    if (i % 2 == 0) {
      p.controller.ki = 1e-5;
      p.controller.kp = p.controller.kd = 0.0;
    }
  }
  return trials;
}

TEST(BatchBlocks, DecideAsThoseOfTheReference) {
  std::vector<trial::TrialParameters> all;
  for (int kind = 0; kind < block_kinds; ++kind) {
    const std::vector<trial::TrialParameters> trials = trials_with(static_cast<BlockKind>(kind), 60);
    all.insert(all.end(), trials.begin(), trials.end());
    const BatchAgreement agreement = agreement_of(trials, block_kind_names[kind]);
    EXPECT_GT(agreement.trials - agreement.slides, 40) << block_kind_names[kind];
  }
  expect_agreement_in_lanes(all, "blocks");
}

// Trials with blocks beside trials without, in few lanes that all of them go through.
TEST(BatchBlocks, MixWithTrialsThatHaveNone) {
  std::vector<trial::TrialParameters> trials;
  for (int kind = 0; kind < block_kinds; ++kind) {
    for (const trial::TrialParameters& p : trials_with(static_cast<BlockKind>(kind), 8)) trials.push_back(p);
  }
  std::vector<trial::TrialParameters> mixed;
  for (std::size_t i = 0; i < trials.size(); ++i) mixed.push_back(trials[i * 37 % trials.size()]);
  const std::vector<BatchedTrial> few = run_batch(mixed, {.lanes = 5});
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    EXPECT_EQ(difference_in_bits(few[i], run_batch({mixed[i]}, {.lanes = 1}).front()), "") << i;
  }
}

// A deadband keeps the torque where the error is 0, so that a lane goes on from event to event; what
// remembers more than the integral is sampled every time.
TEST(BatchBlocks, AMemoryThatFadesIsNotSkipped) {
  std::vector<trial::TrialParameters> trials;
  for (const double leak : {0.02, 0.2, 2.0}) {
    trials.push_back(trial_for_lanes(TrialKind::calm, 84000));
    trial::TrialParameters& p = trials.back();
    p.controller.ki = 1e-5;
    p.controller.kp = p.controller.kd = 0.0;
    p.controller.blocks.integrator_leak = leak;
    p.command.hold = 2.0;
  }
  expect_agreement_in_lanes(trials, "leak");
}

}  // namespace
}  // namespace zerocount::testing
