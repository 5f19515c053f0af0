// Sampled loops beyond those of the ideal encoder in the lanes: noise, errors of encoders and converter,
// missed samples, two phases, profiles, measures of the true motion; and all together.
#include "core/batch/lanes/lane_drive.hpp"
#include "core/trial/disturbance.hpp"
#include "tests/core/batch/batch_agreement.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

enum class LoopKind { encoder, converter, missed, phases, profile, motion, drive, all, noise };
constexpr int loop_kinds = 9;
constexpr const char* loop_kind_names[loop_kinds] = {
    "encoder", "converter", "missed samples", "phases", "profile", "motion", "drive", "all", "noise"};

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
    if (has(LoopKind::drive)) {
      if (draw.chance(0.7)) p.controller.blocks = draw.blocks(BlockKind::cascade, p.controller.sample_rate);
      draw.add_drive(p.controller.blocks);
      if (draw.chance(0.3)) p.dac.limit = draw.log_uniform(1e-2, 1.0);
    }
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

TEST(BatchLaneLoop, AgreesWithTheReference) {
  for (int kind = 0; kind < loop_kinds; ++kind)
    expect_agreement_in_lanes(trials_of(static_cast<LoopKind>(kind), 80), loop_kind_names[kind]);
}

TEST(BatchLaneLoop, DoesNotDependOnOtherTrials) {
  std::vector<trial::TrialParameters> trials;
  for (int kind = 0; kind < loop_kinds; ++kind) {
    for (const trial::TrialParameters& p : trials_of(static_cast<LoopKind>(kind), 6)) trials.push_back(p);
    trials.push_back(trial_for_lanes(TrialKind::calm, 88000 + static_cast<std::uint64_t>(kind)));
  }
  expect_independent(trials);
}

// Torques that vary between samples in the lanes: amplifiers, delays, late samples, ripples and vibrations,
// under all laws that lanes have; and all together.

enum class DriveKind { amplifier, fast_amplifier, jitter, ripple, vibration, spectrum, all };
constexpr DriveKind drive_kinds[] = {DriveKind::amplifier, DriveKind::fast_amplifier, DriveKind::jitter,
                                     DriveKind::ripple,    DriveKind::vibration,      DriveKind::spectrum,
                                     DriveKind::all};
constexpr const char* drive_kind_names[] = {"amplifier", "fast amplifier", "jitter", "ripple",
                                            "vibration", "spectrum",       "all"};

std::shared_ptr<const trial::SpectrumParameters> random_spectrum(RandomBlocks& draw, double most) {
  const double density = draw.log_uniform(1e-12, 1e-8);
  return std::make_shared<const trial::SpectrumParameters>(
      trial::SpectrumParameters{{{1.0, density},
                                 {20.0, density * draw.log_uniform(0.1, 10.0)},
                                 {draw.uniform(100.0, std::min(450.0, most)), density}},
                                static_cast<int>(draw.uniform(1.0, 40.0))});
}

trial::TrialParameters with_drive(DriveKind kind, trial::TrialParameters p, RandomBlocks& draw) {
  const auto has = [&](DriveKind one) { return kind == one || (kind == DriveKind::all && draw.chance(0.5)); };
  if (has(DriveKind::amplifier)) p.amplifier.bandwidth = draw.log_uniform(20.0, 3000.0);
  if (kind == DriveKind::fast_amplifier) p.amplifier.bandwidth = draw.log_uniform(1e4, 1e6);
  if (has(DriveKind::jitter)) p.controller.jitter = draw.uniform(0.0, 0.99) / p.controller.sample_rate;
  if (has(DriveKind::ripple)) {
    for (int i = 0; i < 2; ++i) {
      p.disturbance.ripple.push_back({draw.log_uniform(1e-5, 3e-2), std::round(draw.log_uniform(1.0, 3000.0)),
                                      0.0, draw.uniform(0.0, 6.28)});
    }
  }
  const double most = 0.49 / (1.0 / p.controller.sample_rate + p.controller.jitter);
  if (has(DriveKind::vibration)) {
    p.disturbance.vibration.push_back(
        {draw.log_uniform(1e-5, 1e-2), draw.log_uniform(0.5, most), draw.uniform(0.0, 6.28)});
  }
  if (has(DriveKind::spectrum)) p.disturbance.spectra.push_back(random_spectrum(draw, most));
  if (draw.chance(0.4)) p.controller.delay = draw.chance(0.3) ? 1.0 : draw.uniform(0.0, 3.0);
  if (draw.chance(0.2)) p.disturbance.torque = draw.uniform(-0.05, 0.05);
  p.randomness.jitter = {9, 10};
  p.randomness.spectrum = {11, 12};
  return p;
}

std::vector<trial::TrialParameters> trials_of(DriveKind kind, int count) {
  RandomBlocks draw(97000 + static_cast<std::uint64_t>(kind));
  std::vector<trial::TrialParameters> trials;
  for (int i = 0; i < count; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    trial::TrialParameters p =
        trial_for_lanes(i % 4 == 0 ? TrialKind::ringing : TrialKind::calm, 91000 + number);
    p.randomness.trial = number;
    if (i % 3 == 0) p.command.targets.push_back(p.command.targets.back() + 7);
    if (i % 2 == 0) {  // such that some arrive and rest
      p.controller.ki = 1e-5;
      p.controller.kp = p.controller.kd = 0.0;
    }
    if (kind == DriveKind::all && i % 5 == 0) p.controller.missed = 0.05;
    if (kind == DriveKind::all && i % 7 == 0) p.encoder.fine_errors.noise = 0.1;
    trials.push_back(with_drive(kind, p, draw));
  }
  return trials;
}

/// Expects that the batch engine agrees with the reference on trials under a varying disturbance, except in
/// the few measures that rounding may decide. Such trials have no rest rule, and their rotor is never still.
void expect_agreement_in_motion(const std::vector<trial::TrialParameters>& trials, const std::string& name) {
  const BatchAgreement agreement = agreement_of(trials, name);
  std::cout << name << ": " << agreement.figures() << "\n";
  EXPECT_EQ(agreement.in_lanes, agreement.trials) << name;
  EXPECT_EQ(agreement.other_counts, 0) << name;
  EXPECT_EQ(agreement.other_measures, 0) << name;
  EXPECT_EQ(agreement.stray, 0) << name;
  EXPECT_LE(agreement.on_edge, 1 + agreement.trials / 100) << name;
  EXPECT_LE(agreement.part, 1 + agreement.slides / 20) << name;
  EXPECT_LT(agreement.theta, 1e-6) << name;
  for (const std::string& failure : agreement.failures) {
    if (failure.find("reversal_depth") == std::string::npos) ADD_FAILURE() << failure;
  }
}

TEST(LaneDrive, MovesTheRotorLikeTheReference) {
  for (std::size_t i = 0; i < std::size(drive_kinds); ++i) {
    const std::vector<trial::TrialParameters> trials = trials_of(drive_kinds[i], 100);
    if (drive_kinds[i] <= DriveKind::jitter) {
      expect_agreement_in_lanes(trials, drive_kind_names[i]);
    } else {
      expect_agreement_in_motion(trials, drive_kind_names[i]);
    }
  }
}

// In exact equilibrium under a ripple nothing moves the rotor until the first delayed torque arrives.
TEST(LaneDrive, KeepsARotorInEquilibriumAtRest) {
  for (const friction::FrictionModel model :
       {friction::FrictionModel::presliding, friction::FrictionModel::lugre, friction::FrictionModel::dahl,
        friction::FrictionModel::gms}) {
    trial::TrialParameters p;
    p.friction.model = model;
    p.controller.delay = 4.0;
    p.disturbance.ripple = {{1e-3, 36.0, 0.0, 0.0}};
    p.command.targets = {5};
    p.command.hold = 0.05;
    const BatchedTrial batched = run_batch({p}, {.lanes = 1}).front();
    const BatchedTrial reference = run_by_reference(p);
    ASSERT_EQ(batched.samples.size(), reference.samples.size());
    for (std::size_t k = 0; k < reference.samples.size(); ++k) {
      EXPECT_EQ(batched.samples[k].code, reference.samples[k].code) << k;
      EXPECT_NEAR(batched.samples[k].theta, reference.samples[k].theta, 4e-12) << k;
    }
  }
}

TEST(LaneDrive, DoesNotDependOnOtherTrialsOrInstructionSet) {
  std::vector<trial::TrialParameters> trials;
  for (const DriveKind kind : drive_kinds) {
    for (const trial::TrialParameters& p : trials_of(kind, 6)) trials.push_back(p);
    trials.push_back(trial_for_lanes(TrialKind::calm, 92000 + trials.size()));
  }
  expect_independent(trials);
}

// Other friction under the same torques. Trial 14 of the kinds is a limit cycle under Coulomb's friction that
// grows to 300 counts a sample: from sample 846 on, its difference and that between the reference and one
// with another inertia grow by the same factor, about 5 in 282 samples, from 1e-9 count to 1e-3 after 9e5
// counts of travel. It is not the stops that amplify: the rotor stands once, before.
TEST(LaneDrive, MovesOtherLawsLikeTheReference) {
  int parted = 0;
  int amplifying = 0;
  int trials = 0;
  for (const friction::FrictionModel model :
       {friction::FrictionModel::lugre, friction::FrictionModel::dahl, friction::FrictionModel::gms,
        friction::FrictionModel::coulomb, friction::FrictionModel::none}) {
    for (const DriveKind kind : drive_kinds) {
      const bool varies =
          kind != DriveKind::amplifier && kind != DriveKind::fast_amplifier && kind != DriveKind::jitter;
      if (model == friction::FrictionModel::none && varies) continue;
      std::vector<trial::TrialParameters> all = trials_of(kind, 30);
      for (trial::TrialParameters& p : all) {
        p.friction.model = model;
        p.friction.uniform.sigma0 = p.friction.uniform.k1 + 0.5 * p.friction.uniform.k2;
        p.friction.uniform.sigma1 = 0.4 * p.plant.presliding_damping;
      }
      const std::vector<BatchedTrial> batched = run_batch(all);
      for (std::size_t i = 0; i < all.size(); ++i, ++trials) {
        ASSERT_TRUE(batch::runs_in_lanes(all[i]))
            << ::testing::PrintToString(batch::lacking_in_lanes(all[i]));
        const PathAgreement path = path_agreement(all[i], batched[i], run_by_reference(all[i]));
        EXPECT_EQ(path.astray, "") << "law " << static_cast<int>(model) << ", kind " << static_cast<int>(kind)
                                   << ", trial " << i;
        parted += path.parts ? 1 : 0;
        amplifying += path.amplifies ? 1 : 0;
      }
    }
  }
  std::cout << parted << " of " << trials << " trials part, " << amplifying << " amplify rounding\n";
  EXPECT_LE(parted, 1 + trials / 50);
  EXPECT_LE(amplifying, 4);
}

TEST(VibrationSeries, IsTheSumOfItsLinesBetweenSamples) {
  RandomBlocks draw(98000);
  const double sample_time = 1.0 / 2000.0;
  std::vector<motion::Vibration> lines;
  double amplitudes = 0.0;
  for (int i = 0; i < 30; ++i) {
    lines.push_back(
        {draw.uniform(0.1, 1.0), 2.0 * M_PI * draw.log_uniform(0.1, 1000.0), draw.uniform(0.0, 6.28)});
    amplitudes += lines.back().amplitude;
  }
  batch::VibrationSeries series(lines, sample_time);
  for (std::int64_t k = 0; k < 1000; k += k == 700 ? 50 : 1) {
    const batch::VibrationSeries::Coefficients c = series.about_sample(k);
    const double x = draw.uniform(0.0, 1.0);
    double sum = 0.0;
    for (std::size_t j = c.size(); j-- > 0;) sum = sum * x + c[j];
    double expected = 0.0;
    for (const motion::Vibration& line : lines)
      expected +=
          line.amplitude * std::sin(line.rate * (static_cast<double>(k) + x) * sample_time + line.phase);
    EXPECT_NEAR(sum, expected, 3e-12 * amplitudes) << k;
  }
}

}  // namespace
}  // namespace zerocount::testing
