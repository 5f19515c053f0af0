// Coulomb's friction in lanes where the torque on a standing rotor varies: by a second mass, a ripple, a
// vibration, an amplifier, late samples. Rounding puts such a torque on either side of that of breakaway at
// the instant of a release; no lane may wait there.
#include "tests/core/batch/path_agreement.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

double random_gain(RandomBlocks& draw, double stable) {
  if (draw.chance(0.15)) return 0.0;
  const double gain = stable * draw.log_uniform(0.03, 1.0);
  if (draw.chance(0.1)) return -gain;
  return draw.chance(0.2) ? gain * draw.log_uniform(10.0, 1e4) : gain;
}

/// A level of breakaway that is a code of the converter now and then.
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

/// Of `lines` lines whose amplitudes add up to `peak` of the torque of breakaway; without control.
trial::TrialParameters vibrated_trial(RandomBlocks& draw, double peak, int lines, int number) {
  trial::TrialParameters p;
  p.friction.model = friction::FrictionModel::coulomb;
  p.friction.uniform.breakaway = 0.1;
  p.controller.kp = p.controller.ki = p.controller.kd = 0.0;
  p.command.targets = {0};
  p.command.hold = 0.02;
  constexpr double by_rate[] = {0.25, 0.5, 1.25, 1.5, 2.25};
  for (int i = 0; i < lines; ++i) {
    const double share = lines == 1 ? by_rate[number % 5] : draw.uniform(0.05, 0.5);
    const double phase = number % 3 == 2 ? draw.uniform(0.0, 6.28) : 0.5 * M_PI * (number % 4);
    p.disturbance.vibration.push_back({0.1 * peak / lines, share * p.controller.sample_rate, phase});
  }
  return p;
}

// The amplitudes of the lines bound the torque, that of a single one is its peak.
TEST(LanesThatStand, AreReleasedByAVibrationWhosePeakIsBeyondTheLevelAlone) {
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

TEST(LanesThatStand, GoOnAsTheReferenceDoesUnderEveryTorque) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 1000; ++i) trials.push_back(standing_trial(i));
  const std::vector<BatchedTrial> batched = run_batch(trials);
  int parted = 0;
  int slid = 0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    ASSERT_TRUE(batch::runs_in_lanes(trials[i])) << batch::lacking_in_lanes(trials[i]);
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
