// Torque levels and recorded torques in the lanes: counts, codes and measures are those of the reference.
#include "core/loop/encoder.hpp"
#include "tests/core/batch/batch_agreement.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

std::shared_ptr<const trial::TorqueRecord> random_record(RandomBlocks& draw) {
  trial::TorqueRecord record;
  double time = 0.0;
  for (int row = 0; row < 30; ++row) {
    record.time.push_back(time);
    record.torque.push_back(draw.uniform(-0.1, 0.1));
    time += draw.log_uniform(1e-4, 3e-2);
  }
  return std::make_shared<const trial::TorqueRecord>(record);
}

/// Replaces the targets of a trial by torque levels, some of which exceed the breakaway torque.
void replace_targets(trial::TrialParameters& p, RandomBlocks& draw) {
  trial::CommandParameters& command = p.command;
  command.targets = {};
  command.hold = draw.chance(0.1) ? 0.0 : draw.log_uniform(1e-3, 0.5);
  command.torque.rate = draw.log_uniform(0.05, 50.0);
  command.torque.through = draw.chance(0.3) ? trial::TorquePath::exact : trial::TorquePath::dac;
  const double most = draw.chance(0.3) ? 1.1 * p.friction.uniform.breakaway : 0.1;
  for (int i = 0; i < 4; ++i) command.torque.levels.push_back(draw.uniform(-most, most));
  if (!draw.chance(0.2)) return;
  command.torque.levels = {0.0};
  command.torque.record = random_record(draw);
  command.hold = 0.3;
}

/// Adds random effects between the commanded torque and the rotor, and between the rotor and its reading.
void add_features(trial::TrialParameters& p, RandomBlocks& draw) {
  if (draw.chance(0.3)) p.controller.delay = draw.uniform(0.0, 3.0);
  if (draw.chance(0.3)) p.amplifier.bandwidth = draw.log_uniform(50.0, 3000.0);
  if (draw.chance(0.2)) p.controller.jitter = 0.5 / p.controller.sample_rate;
  if (draw.chance(0.2)) p.encoder.fine_errors.noise = 0.3;
  if (draw.chance(0.2)) p.dac.noise = 1e-4;
  if (draw.chance(0.2)) p.dac.sigma_delta = true;
  if (draw.chance(0.2)) p.disturbance.torque = draw.uniform(-0.03, 0.03);
  // These measure errors and torques of a closed loop alone.
  if (draw.chance(0.3)) p.verdict.stop = true, p.verdict.limit = 2.0;
  if (draw.chance(0.3)) p.verdict.position_error = p.verdict.motion = true;
  p.randomness.jitter = {9, 10};
}

std::vector<trial::TrialParameters> level_trials(TrialKind kind, int count) {
  RandomBlocks draw(96000 + static_cast<std::uint64_t>(kind));
  std::vector<trial::TrialParameters> trials;
  for (int i = 0; i < count; ++i) {
    trial::TrialParameters p = trial_with_any_exponent(kind, 96000 + static_cast<std::uint64_t>(i));
    p.randomness.trial = static_cast<std::uint64_t>(i);
    replace_targets(p, draw);
    if (i % 3 != 0) add_features(p, draw);
    trials.push_back(p);
  }
  return trials;
}

TEST(TorqueLevels, LoadTheContactAsInTheReference) {
  for (const TrialKind kind : {TrialKind::calm, TrialKind::ringing, TrialKind::arriving, TrialKind::loaded})
    expect_agreement_in_lanes(level_trials(kind, 300),
                              "levels of kind " + std::to_string(static_cast<int>(kind)));
}

/// Expects that the rotor angle θ of two runs of a trial agrees to 1e-6 count plus 1e-9 of the travel, up to
/// the first sample with different counts.
/// @returns whether there is such a sample
bool expect_same_samples(const BatchedTrial& one, const BatchedTrial& other, double resolution,
                         std::size_t trial) {
  EXPECT_EQ(one.samples.size(), other.samples.size()) << trial;
  double travel = 0.0;
  for (std::size_t k = 0; k < other.samples.size(); ++k) {
    const batch::BatchSample& a = one.samples[k];
    const batch::BatchSample& b = other.samples[k];
    if (k > 0) travel += std::abs(b.theta - other.samples[k - 1].theta) / resolution;
    EXPECT_EQ(a.code, b.code) << trial;
    EXPECT_LT(std::abs(a.theta - b.theta) / resolution, 1e-6 + 1e-9 * travel) << trial << ", " << k;
    if (a.count != b.count) return true;
    if (::testing::Test::HasFailure()) return true;
  }
  return false;
}

TEST(TorqueLevels, LoadOtherLawsAsInTheReference) {
  for (const friction::FrictionModel model :
       {friction::FrictionModel::none, friction::FrictionModel::coulomb, friction::FrictionModel::dahl,
        friction::FrictionModel::lugre}) {
    std::vector<trial::TrialParameters> trials = level_trials(TrialKind::calm, 80);
    for (trial::TrialParameters& p : trials) {
      p.friction.model = model;
      p.friction.uniform.sigma0 = p.friction.uniform.k1 + 0.5 * p.friction.uniform.k2;
      p.friction.uniform.sigma1 = 0.4 * p.plant.presliding_damping;
    }
    const std::vector<BatchedTrial> batched = run_batch(trials);
    int parted = 0;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      ASSERT_TRUE(batch::runs_in_lanes(trials[i]))
          << ::testing::PrintToString(batch::lacking_in_lanes(trials[i]));
      const BatchedTrial reference = run_by_reference(trials[i]);
      parted +=
          expect_same_samples(batched[i], reference, loop::fine_resolution(trials[i].encoder), i) ? 1 : 0;
      for (std::size_t m = 0; m < reference.outcome.moves.size(); ++m) {
        const trial::MoveOutcome& one = batched[i].outcome.moves[m];
        const trial::MoveOutcome& other = reference.outcome.moves[m];
        EXPECT_EQ(one.outcome, trial::Outcome::open_loop) << i;
        EXPECT_EQ(one.broke_away, other.broke_away) << i;
        EXPECT_EQ(one.saturated, other.saturated) << i;
        EXPECT_EQ(one.peak_torque, other.peak_torque) << i;
        EXPECT_EQ(one.travel_time, other.travel_time) << i;
      }
    }
    EXPECT_LE(parted, 3);
  }
}

TEST(TorqueLevels, DoNotDependOnOtherTrialsOrInstructionSet) {
  std::vector<trial::TrialParameters> trials = level_trials(TrialKind::calm, 20);
  for (std::uint64_t i = 0; i < 20; ++i) trials.push_back(trial_for_lanes(TrialKind::calm, 96500 + i));
  expect_independent(trials);
}

// Unobserved samples of a held torque are passed at once.
TEST(TorqueLevels, AreTheSameWithoutAnObserver) {
  const std::vector<trial::TrialParameters> trials = level_trials(TrialKind::ringing, 60);
  const std::vector<BatchedTrial> observed = run_batch(trials);
  const std::vector<BatchedTrial> others = run_batch(trials, {}, Observed::jerks);
  for (std::size_t i = 0; i < trials.size(); ++i)
    EXPECT_EQ(difference_in_bits(others[i], observed[i]), "") << i;
}

}  // namespace
}  // namespace zerocount::testing
