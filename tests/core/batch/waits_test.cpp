// Waits between jerks with the premises of real machines. The lanes pass many samples of a wait at once,
// where the reference takes one after the other.
#include "core/trial/trial.hpp"
#include "tests/core/batch/batch_agreement.hpp"
#include "tests/core/batch/bench_trials.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using TrialChange = std::function<void(trial::TrialParameters&, RandomBlocks&)>;

std::vector<trial::TrialParameters> changed_trials(const std::string& workload, std::int64_t count,
                                                   std::uint64_t seed, const TrialChange& change) {
  RandomBlocks draw(seed);
  std::vector<trial::TrialParameters> trials = bench_trials(workload, 0, count);
  for (trial::TrialParameters& p : trials) {
    if (draw.chance(0.3)) p.command.targets.push_back(p.command.targets.back() + 1);
    if (draw.chance(0.3)) p.disturbance.torque = draw.uniform(-0.02, 0.02);
    p.randomness.jitter = {9, 10};
    p.randomness.fine_noise = {13, 14};
    change(p, draw);
  }
  return trials;
}

/// Expects the same outcomes without an observer of the samples. The lanes may then pass over several samples
/// at once.
void expect_same_unobserved(const std::vector<trial::TrialParameters>& trials) {
  const std::vector<BatchedTrial> observed = run_batch(trials);
  for (const batch::InstructionSet instructions : available_instruction_sets()) {
    const std::vector<BatchedTrial> others =
        run_batch(trials, {.lanes = 23, .instructions = instructions}, Observed::jerks);
    for (std::size_t i = 0; i < trials.size(); ++i)
      EXPECT_EQ(difference_in_bits(observed[i], others[i]), "") << i;
  }
}

TEST(WaitInLanes, AgreesWithLateSamples) {
  const auto trials = changed_trials("bench-creep", 32, 1, [](trial::TrialParameters& p, RandomBlocks& draw) {
    p.controller.jitter = draw.uniform(0.0, 0.99) / p.controller.sample_rate;
    if (draw.chance(0.3)) p.amplifier.bandwidth = draw.log_uniform(300.0, 1000.0);
  });
  expect_agreement_in_lanes(trials, "late samples");
  expect_same_unobserved(trials);
}

TEST(WaitInLanes, AgreesWithANoisyEncoder) {
  const auto trials = changed_trials("bench-creep", 32, 2, [](trial::TrialParameters& p, RandomBlocks& draw) {
    p.encoder.fine_errors.noise = draw.log_uniform(0.003, 0.3);
    if (draw.chance(0.3)) p.encoder.fine_errors.noise_bandwidth = draw.log_uniform(10.0, 1000.0);
    if (draw.chance(0.3)) p.controller.delay = draw.chance(0.5) ? 1.0 : 2.0;
    if (draw.chance(0.2)) p.controller.jitter = draw.uniform(0.0, 0.99) / p.controller.sample_rate;
    if (draw.chance(0.3)) p.controller.blocks.error_deadband.band = draw.uniform(0.1, 1.5);
  });
  expect_agreement_in_lanes(trials, "a noisy encoder");
  expect_same_unobserved(trials);
}

/// Expects that the batch engine agrees with the reference in all but the number of remembered reversals,
/// which rounding decides for a rotor that stands still under a varying torque.
void expect_agreement_but_in_depth(const std::vector<trial::TrialParameters>& trials,
                                   const std::string& name) {
  const BatchAgreement agreement = agreement_of(trials, name);
  std::cout << name << ": " << agreement.figures() << "\n";
  EXPECT_EQ(agreement.in_lanes, agreement.trials);
  EXPECT_EQ(agreement.other_counts, 0);
  EXPECT_EQ(agreement.other_measures, 0);
  EXPECT_EQ(agreement.stray, 0);
  EXPECT_LE(agreement.on_edge, 1);
  EXPECT_LE(agreement.other_depth + agreement.depth_by_steps, agreement.trials / 3);
  EXPECT_LE(agreement.depth_apart, 12);
  EXPECT_LT(agreement.theta, 1e-7);
}

TEST(WaitInLanes, AgreesUnderRipples) {
  const auto trials = changed_trials("bench-creep", 32, 3, [](trial::TrialParameters& p, RandomBlocks& draw) {
    do {
      p.disturbance.ripple.push_back({draw.log_uniform(1e-5, 1e-2),
                                      std::round(draw.log_uniform(1.0, 30000.0)), 0.0,
                                      draw.uniform(0.0, 6.28)});
    } while (draw.chance(0.4) && p.disturbance.ripple.size() < 8);
    if (draw.chance(0.3)) p.amplifier.bandwidth = draw.log_uniform(300.0, 1000.0);
    if (draw.chance(0.3)) p.controller.delay = 1.0;
  });
  expect_agreement_but_in_depth(trials, "ripples");
  expect_same_unobserved(trials);
}

TEST(WaitInLanes, AgreesUnderVibration) {
  const auto trials = changed_trials("bench-creep", 24, 4, [](trial::TrialParameters& p, RandomBlocks& draw) {
    do {
      p.disturbance.vibration.push_back(
          {draw.log_uniform(1e-6, 1e-3), draw.log_uniform(0.5, 400.0), draw.uniform(0.0, 6.28)});
    } while (draw.chance(0.8) && p.disturbance.vibration.size() < 12);
    if (draw.chance(0.3)) p.disturbance.ripple = {{1e-3, 36.0, 0.0, 1.0}};
    if (draw.chance(0.3)) p.controller.delay = 1.0;
  });
  expect_agreement_but_in_depth(trials, "lines");
  expect_same_unobserved(trials);
}

/// Number of rounds (steps of all lanes) of the engine per sample, for a single trial in one lane; about 1 if
/// no sample is skipped.
double rounds_by_samples(const trial::TrialParameters& p) {
  batch::BatchEngine engine({.lanes = 1});
  run_batch(engine, {p}, Observed::jerks);
  return static_cast<double>(engine.rounds()) / static_cast<double>(trial::samples_of_move(p, 0));
}

TEST(WaitInLanes, UnderCoulombFrictionNeedsHardlyAnyRoundPerSample) {
  trial::TrialParameters plain;
  plain.friction.model = friction::FrictionModel::coulomb;
  plain.command.targets = {0};
  plain.command.hold = 10.0;
  for (const double delay : {0.0, 1.0, 2.0})
    for (const double bandwidth : {0.0, 500.0}) {
      trial::TrialParameters p = plain;
      p.controller.delay = delay;
      p.amplifier.bandwidth = bandwidth;
      EXPECT_LT(rounds_by_samples(p), 0.01) << delay << ' ' << bandwidth;
    }
}

TEST(WaitInLanes, WithAContactNeedsFewRoundsPerSample) {
  const auto mean_of = [](const TrialChange& change) {
    double sum = 0.0;
    const auto trials = changed_trials("bench-creep", 10, 6, change);
    for (const trial::TrialParameters& p : trials) sum += rounds_by_samples(p);
    return sum / static_cast<double>(trials.size());
  };
  const auto expect_fewer = [&](double than, const std::string& name, const TrialChange& change) {
    const double rounds = mean_of(change);
    std::cout << name << ": " << rounds << "\n";
    EXPECT_LT(rounds, than) << name;
  };
  expect_fewer(0.5, "constant", [](trial::TrialParameters&, RandomBlocks&) {});
  expect_fewer(0.5, "late samples",
               [](trial::TrialParameters& p, RandomBlocks&) { p.controller.jitter = 1e-4; });
  expect_fewer(0.5, "noise",
               [](trial::TrialParameters& p, RandomBlocks&) { p.encoder.fine_errors.noise = 0.1; });
  expect_fewer(0.5, "ripple", [](trial::TrialParameters& p, RandomBlocks&) {
    p.disturbance.ripple = {{1e-3, 36.0, 0.0, 1.0}};
  });
  expect_fewer(0.5, "line", [](trial::TrialParameters& p, RandomBlocks&) {
    p.disturbance.vibration = {{1e-4, 50.0, 1.0}};
  });
}

/// Four of five trials slide, most of them fast.
TEST(SecondMassInLanes, SlidesAsInTheReference) {
  for (const bool bristles : {false, true}) {
    const auto trials =
        changed_trials("bench-marginal", 120, 5, [&](trial::TrialParameters& p, RandomBlocks& draw) {
          motion::LoadParameters& load = p.plant.load;
          load.inertia = p.plant.inertia * draw.log_uniform(0.05, 3.0);
          load.stiffness = draw.log_uniform(300.0, 30000.0);
          load.encoder = draw.chance(0.5) ? motion::EncoderPlace::motor : motion::EncoderPlace::load;
          if (draw.chance(0.3)) p.amplifier.bandwidth = draw.log_uniform(300.0, 1000.0);
          if (!bristles) return;
          p.friction.model = friction::FrictionModel::lugre;
          p.friction.uniform.sigma0 = 400.0;
        });
    const BatchAgreement agreement = agreement_of(trials, bristles ? "bristles" : "a hook");
    std::cout << agreement.figures() << "\n";
    EXPECT_EQ(agreement.in_lanes, agreement.trials);
    EXPECT_GT(agreement.slides, 20);
    EXPECT_EQ(agreement.other_counts, 0);
    EXPECT_EQ(agreement.other_measures, 0);
    EXPECT_EQ(agreement.stray, 0);
    EXPECT_LE(agreement.on_edge, 1);
    EXPECT_LE(agreement.other_depth + agreement.depth_by_steps, agreement.trials / 20);
    EXPECT_LE(agreement.depth_apart, 2);
    EXPECT_LE(agreement.part, 1 + agreement.slides / 20);
  }
}

// Coulomb's friction in lanes where the torque on a standing rotor varies: by a second mass, a ripple, a
// vibration, an amplifier, late samples. Rounding puts such a torque on either side of that of breakaway at
// the instant of a release; no lane may wait there.

double random_gain(RandomBlocks& draw, double stable) {
  if (draw.chance(0.15)) return 0.0;
  const double gain = stable * draw.log_uniform(0.03, 1.0);
  if (draw.chance(0.1)) return -gain;
  return draw.chance(0.2) ? gain * draw.log_uniform(10.0, 1e4) : gain;
}

/// A random breakaway torque, N m; in some cases it is exactly a code of the converter.
double random_level(RandomBlocks& draw, double dac_resolution) {
  const double level = draw.log_uniform(0.02, 0.5);
  return draw.chance(0.3) ? std::round(level / dac_resolution) * dac_resolution : level;
}

void vary_torque(trial::TrialParameters& p, RandomBlocks& draw) {
  if (draw.chance(0.3))
    p.disturbance.ripple.push_back({draw.log_uniform(1e-5, 0.1), std::round(draw.log_uniform(1.0, 3000.0)),
                                    0.0, draw.uniform(0.0, 6.28)});
  if (draw.chance(0.2)) p.controller.jitter = draw.uniform(0.0, 0.9) / p.controller.sample_rate;
  if (draw.chance(0.4)) {
    const double most = 0.49 / (1.0 / p.controller.sample_rate + p.controller.jitter);
    p.disturbance.vibration.push_back(
        {draw.log_uniform(1e-5, 0.2), draw.log_uniform(1.0, most), draw.uniform(0.0, 6.28)});
  }
  if (draw.chance(0.2)) p.amplifier.bandwidth = draw.log_uniform(20.0, 3000.0);
  if (draw.chance(0.2)) p.controller.delay = draw.chance(0.5) ? 1.0 : draw.uniform(0.0, 3.0);
  if (draw.chance(0.2)) p.disturbance.torque = draw.uniform(-0.1, 0.1);
}

trial::TrialParameters standing_trial(std::uint64_t number) {
  RandomBlocks draw(43000 + number);
  trial::TrialParameters p;
  p.friction.model = friction::FrictionModel::coulomb;
  friction::FrictionParameters& f = p.friction.uniform;
  f.breakaway = random_level(draw, p.dac.resolution);
  f.coulomb_ratio = draw.chance(0.3) ? 1.0 : draw.uniform(0.1, 1.0);
  f.stribeck_velocity = draw.log_uniform(1e-3, 1.0);
  if (draw.chance(0.2)) p.plant.sliding_damping = 0.0;
  if (draw.chance(0.7)) {
    p.plant.load = {p.plant.inertia * draw.log_uniform(0.01, 30.0), draw.log_uniform(1.0, 1e5),
                    draw.chance(0.2) ? 0.0 : draw.log_uniform(1e-6, 0.1)};
    if (draw.chance(0.3)) p.plant.load.encoder = motion::EncoderPlace::load;
  }
  vary_torque(p, draw);
  p.controller.ki = random_gain(draw, 1e-4);
  p.controller.kp = random_gain(draw, 2e-3);
  p.controller.kd = random_gain(draw, 5e-3);
  if (draw.chance(0.2)) p.encoder.fine_errors.noise = draw.log_uniform(0.01, 10.0);
  if (draw.chance(0.3)) p.initial.velocity = draw.uniform(-2.0, 2.0);
  p.command.targets = {static_cast<std::int64_t>(draw.uniform(-300.0, 300.0)), 0};
  p.command.hold = 0.05;
  p.randomness.trial = number;
  p.randomness.jitter = {9, 10};
  return p;
}

/// A trial without control under `lines` lines of a vibration, whose amplitudes add up to `peak` times the
/// breakaway torque.
trial::TrialParameters vibrated_trial(RandomBlocks& draw, double peak, int lines, int number) {
  trial::TrialParameters p;
  p.friction.model = friction::FrictionModel::coulomb;
  p.friction.uniform.breakaway = 0.1;
  p.controller.kp = p.controller.ki = p.controller.kd = 0.0;
  p.command.targets = {0};
  p.command.hold = 0.02;
  constexpr double by_rate[] = {0.25, 0.5, 1.25, 1.5, 2.25};
  for (int i = 0; i < lines; ++i) {
    const double proportion = lines == 1 ? by_rate[number % 5] : draw.uniform(0.05, 0.5);
    const double phase = number % 3 == 2 ? draw.uniform(0.0, 6.28) : 0.5 * M_PI * (number % 4);
    p.disturbance.vibration.push_back({0.1 * peak / lines, proportion * p.controller.sample_rate, phase});
  }
  return p;
}

// The amplitudes of the lines bound the torque, that of a single one is its peak.
TEST(LanesThatStand, AreReleasedOnlyByAVibrationWhosePeakExceedsBreakaway) {
  RandomBlocks draw(44);
  std::vector<trial::TrialParameters> trials;
  std::vector<double> peaks;
  int in_lanes = 0;
  for (const double peak : {0.2, 0.9, 0.999, 1.001})
    for (const int lines : {1, 2, 3, 8, 12})
      for (int i = 0; i < 60 && (peak < 1.0 || lines == 1); ++i) {
        trials.push_back(vibrated_trial(draw, peak, lines, i));
        in_lanes += batch::runs_in_lanes(trials.back()) ? 1 : 0;
        peaks.push_back(peak);
      }
  EXPECT_GT(in_lanes, 600);
  const std::vector<BatchedTrial> batched = run_batch(trials);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    EXPECT_EQ(batched[i].outcome.moves.at(0).broke_away, peaks[i] > 1.0) << i;
    EXPECT_EQ(run_by_reference(trials[i]).outcome.moves.at(0).broke_away, peaks[i] > 1.0) << i;
  }
}

TEST(LanesThatStand, AgreeWithTheReferenceUnderEveryTorque) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 1000; ++i) trials.push_back(standing_trial(i));
  const std::vector<BatchedTrial> batched = run_batch(trials);
  int parted = 0;
  int slid = 0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    ASSERT_TRUE(batch::runs_in_lanes(trials[i]))
        << ::testing::PrintToString(batch::lacking_in_lanes(trials[i]));
    const BatchedTrial reference = run_by_reference(trials[i]);
    const PathAgreement path = path_agreement(trials[i], batched[i], reference);
    EXPECT_EQ(path.astray, "") << i;
    const bool is_compared = !path.parts && !path.amplifies;
    parted += is_compared ? 0 : 1;
    for (std::size_t m = 0; m < reference.outcome.moves.size() && is_compared; ++m) {
      const trial::MoveOutcome& one = batched[i].outcome.moves[m];
      const trial::MoveOutcome& other = reference.outcome.moves[m];
      EXPECT_NE(other.outcome, trial::Outcome::nonfinite) << i;
      EXPECT_EQ(one.outcome, other.outcome) << i;
      EXPECT_EQ(one.broke_away, other.broke_away) << i;
      slid += one.broke_away ? 1 : 0;
    }
  }
  std::cout << slid << " moves slide, " << parted << " trials part\n";
  EXPECT_LE(parted, 5);
  EXPECT_GT(slid, 500);
}

}  // namespace
}  // namespace zerocount::testing
