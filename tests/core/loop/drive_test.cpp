// From decided torque to motor: converter errors, delay, amplifier.
#include "core/loop/drive.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/goodness_of_fit.hpp"

namespace zerocount::loop {
namespace {

constexpr double sample_time = 5e-4;

random::TrialRandomness randomness_of(std::uint64_t trial) {
  random::TrialRandomness randomness;
  randomness.trial = trial;
  randomness.dac_noise = {11, 12};
  return randomness;
}

DacParameters converter_with_errors() {
  DacParameters dac;
  dac.offset = 1.7e-3;
  dac.gain_error = -0.02;
  dac.nonlinearity = 1.5;
  return dac;
}

/// Outputs of the converter for torques drawn over its range.
std::vector<DacOutput> random_outputs(const DacParameters& dac, unsigned seed, int number) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> torque(-0.5, 0.5);
  std::vector<DacOutput> outputs;
  for (int i = 0; i < number; ++i) outputs.push_back(convert(dac, torque(random)));
  return outputs;
}

/// The torque of sample k.
std::span<const TorquePiece> sent(Drive& drive, std::int64_t k, const DacOutput& output) {
  drive.send(k, output);
  return drive.pieces();
}

std::span<const TorquePiece> sent_exactly(Drive& drive, double torque) {
  drive.send_exact(torque);
  return drive.pieces();
}

TEST(Drive, WithoutErrorsHoldsTheDecidedTorqueExactly) {
  const DacParameters dac;
  for (const int delay : {0, 1, 3}) {
    Drive drive(dac, {}, delay, sample_time, randomness_of(1));
    EXPECT_EQ(drive.torque(), 0.0);
    const std::vector<DacOutput> outputs = random_outputs(dac, 21, 200);
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      const motion::TorqueCourse course =
          sent(drive, static_cast<std::int64_t>(k), outputs[k]).front().course;
      const auto late = static_cast<std::size_t>(delay);
      const double expected = k < late ? 0.0 : outputs[k - late].torque;
      EXPECT_EQ(course.now, expected);
      EXPECT_EQ(course.settled, expected);
      EXPECT_EQ(drive.torque(), expected);
    }
  }
}

// Amplifier and delay are both linear and do not change in time: the torque is that of a drive that samples
// four times as fast and holds each input for four samples.
TEST(Drive, DelaysByAFractionOfASample) {
  const DacParameters dac;
  for (const double bandwidth : {0.0, 300.0}) {
    for (const double delay : {0.25, 0.5, 1.75, 3.25}) {
      Drive drive(dac, {bandwidth}, delay, sample_time, randomness_of(1));
      Drive fine(dac, {bandwidth}, 4.0 * delay, sample_time / 4.0, randomness_of(1));
      const std::vector<DacOutput> outputs = random_outputs(dac, 23, 100);
      for (std::size_t k = 0; k < outputs.size(); ++k) {
        double now = 0.0;
        double duration = 0.0;
        const std::span<const TorquePiece> pieces = sent(drive, static_cast<std::int64_t>(k), outputs[k]);
        for (int quarter = 0; quarter < 4; ++quarter) {
          const motion::TorqueCourse expected = sent_exactly(fine, outputs[k].torque).front().course;
          const double time = quarter * sample_time / 4.0;
          const bool second = pieces.size() == 2 && time >= pieces[0].duration * (1.0 - 1e-12);
          const TorquePiece& piece = pieces[second ? 1 : 0];
          const double since = second ? time - pieces[0].duration : time;
          now = piece.course.settled +
                (piece.course.now - piece.course.settled) * std::exp(-piece.course.rate * since);
          EXPECT_NEAR(now, expected.now, 1e-14) << k << " " << quarter;
          EXPECT_EQ(piece.course.settled, expected.settled) << k << " " << quarter;
        }
        for (const TorquePiece& piece : pieces) duration += piece.duration;
        EXPECT_NEAR(duration, sample_time, 1e-18);
      }
    }
  }
}

TEST(Drive, GivesNothingUntilTheFirstTorqueHasComeThrough) {
  DacParameters dac = converter_with_errors();
  dac.noise = 1e-3;
  Drive at_once(dac, {}, 0, sample_time, randomness_of(1));
  Drive late(dac, {}, 4, sample_time, randomness_of(1));
  std::vector<double> torques;
  const std::vector<DacOutput> outputs = random_outputs(dac, 22, 100);
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const auto sample = static_cast<std::int64_t>(k);
    torques.push_back(sent(at_once, sample, outputs[k]).front().course.now);
    EXPECT_EQ(sent(late, sample, outputs[k]).front().course.now, k < 4 ? 0.0 : torques[k - 4]);
  }
}

TEST(Drive, ConverterNoiseIsNormalAndNewAtEverySample) {
  DacParameters dac;
  dac.noise = 3e-4;
  Drive drive(dac, {}, 0, sample_time, randomness_of(1));
  Drive other_trial(dac, {}, 0, sample_time, randomness_of(2));
  constexpr int samples = 50000;
  std::vector<double> probabilities;
  double successive = 0.0;
  double between_trials = 0.0;
  double last = 0.0;
  for (int k = 0; k < samples; ++k) {
    const DacOutput output = convert(dac, 0.1 * std::sin(0.01 * k));
    const double z = (sent(drive, k, output).front().course.now - output.torque) / dac.noise;
    const double other = (sent(other_trial, k, output).front().course.now - output.torque) / dac.noise;
    probabilities.push_back(0.5 * std::erfc(-z / std::sqrt(2.0)));
    successive += z * last;
    between_trials += z * other;
    last = z;
  }
  EXPECT_GT(testing::kolmogorov_probability(probabilities), 1e-3);
  EXPECT_LT(std::abs(successive), 4.0 * std::sqrt(samples));
  EXPECT_LT(std::abs(between_trials), 4.0 * std::sqrt(samples));
}

TEST(Drive, NoiseDependsOnTrialAndSampleAlone) {
  DacParameters dac;
  dac.noise = 3e-4;
  Drive forward(dac, {}, 0, sample_time, randomness_of(9));
  Drive backward(dac, {}, 0, sample_time, randomness_of(9));
  std::vector<double> torques;
  for (int k = 0; k < 50; ++k) torques.push_back(sent(forward, k, {}).front().course.now);
  for (int k = 49; k >= 0; --k)
    EXPECT_EQ(sent(backward, k, {}).front().course.now, torques[static_cast<std::size_t>(k)]);
}

TEST(Drive, ExactTorquePassesTheConverterByButNotDelayAndAmplifier) {
  DacParameters dac = converter_with_errors();
  dac.noise = 1e-3;
  Drive direct(dac, {}, 2, sample_time, randomness_of(1));
  std::vector<double> levels;
  for (int k = 0; k < 50; ++k) {
    levels.push_back(std::sin(0.3 * k) / 7.0);
    EXPECT_EQ(sent_exactly(direct, levels.back()).front().course.now,
              k < 2 ? 0.0 : levels[static_cast<std::size_t>(k - 2)]);
  }
  Drive slow(dac, {40.0}, 0, sample_time, randomness_of(1));
  EXPECT_EQ(sent_exactly(slow, 0.1).front().course.now, 0.0);
  EXPECT_NEAR(sent_exactly(slow, 0.1).front().course.now,
              0.1 * -std::expm1(-2.0 * std::numbers::pi * 40.0 * sample_time), 1e-16);
}

TEST(Drive, BeyondTheHighestBandwidthThereIsNone) {
  AmplifierParameters fast;
  fast.bandwidth = 1e300;
  Drive drive({}, fast, 0, 5e-4, {});
  EXPECT_EQ(sent_exactly(drive, 0.1).front().course.rate, 2.0 * std::numbers::pi * 1e12);
}

TEST(Drive, AmplifierLetsASineOfItsBandwidthThroughAtMinusThreeDecibels) {
  // Sampled finely enough for the steps not to matter; measured over whole periods after the transient.
  constexpr double bandwidth = 50.0;
  constexpr int samples_per_period = 20000;
  constexpr double step = 1.0 / (bandwidth * samples_per_period);
  Drive drive({}, {bandwidth}, 0, step, randomness_of(1));
  double in_phase = 0.0;
  double quadrature = 0.0;
  for (int k = 0; k < 6 * samples_per_period; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / samples_per_period;
    const double torque = sent_exactly(drive, std::sin(angle)).front().course.now;
    if (k < 5 * samples_per_period) continue;
    in_phase += 2.0 * torque * std::sin(angle) / samples_per_period;
    quadrature += 2.0 * torque * std::cos(angle) / samples_per_period;
  }
  EXPECT_NEAR(std::hypot(in_phase, quadrature), std::sqrt(0.5), 1e-3);
  EXPECT_NEAR(std::atan2(quadrature, in_phase), -std::numbers::pi / 4.0, 1e-3);
}

TEST(Drive, AmplifierComesToRest) {
  Drive drive({}, {200.0}, 0, sample_time, randomness_of(1));
  sent_exactly(drive, 0.3);
  motion::TorqueCourse course;
  for (int k = 0; k < 2000; ++k) {
    course = sent_exactly(drive, 0.0).front().course;
    ASSERT_TRUE(course.now == 0.0 || std::isnormal(course.now));
  }
  EXPECT_EQ(course.now, 0.0);
}

}  // namespace
}  // namespace zerocount::loop
