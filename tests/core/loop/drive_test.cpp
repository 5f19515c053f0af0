// From decided torque to motor: converter errors, delay, amplifier.
#include "core/loop/drive.hpp"

#include "core/loop/dac.hpp"
#include "tests/support/test.hpp"

namespace zerocount::loop {
namespace {

constexpr double sample_time = 5e-4;

random::TrialRandomness randomness_of(std::uint64_t trial) {
  random::TrialRandomness randomness;
  randomness.trial = trial;
  randomness.dac_noise = {11, 12};
  return randomness;
}

std::span<const TorquePiece> sent_exactly(Drive& drive, double torque) {
  drive.send_exact(torque);
  return drive.pieces();
}

TEST(Drive, BandwidthIsLimited) {
  AmplifierParameters fast;
  fast.bandwidth = 1e300;
  Drive drive({}, fast, 0, 5e-4, {});
  EXPECT_EQ(sent_exactly(drive, 0.1).front().course.rate, 2.0 * std::numbers::pi * 1e12);
}

TEST(Drive, AmplifierAttenuatesASineAtItsBandwidthByThreeDecibels) {
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

// The DAC: rounding to even, clipping at and beyond the range; what it really gives.

TEST(Dac, RoundsHalvesToEven) {
  const DacParameters dac{12, 0.5};  // halves of a code are exact in binary
  EXPECT_EQ(convert(dac, 0.25).code, 0);
  EXPECT_EQ(convert(dac, 0.75).code, 2);
  EXPECT_EQ(convert(dac, 1.25).code, 2);
  EXPECT_EQ(convert(dac, -0.25).code, 0);
  EXPECT_EQ(convert(dac, -0.75).code, -2);
  EXPECT_EQ(convert(dac, 0.7500001).code, 2);
  EXPECT_EQ(convert(dac, 0.2500001).code, 1);
}

TEST(Dac, ReportsClipping) {
  const DacParameters dac{12, 0.5};
  EXPECT_EQ(convert(dac, 2047 * 0.5).code, 2047);
  EXPECT_FALSE(convert(dac, 2047 * 0.5).clipped);
  EXPECT_FALSE(convert(dac, 2047.4 * 0.5).clipped);
  EXPECT_EQ(convert(dac, 2048 * 0.5).code, 2047);
  EXPECT_TRUE(convert(dac, 2048 * 0.5).clipped);
  EXPECT_EQ(convert(dac, -2048 * 0.5).code, -2048);
  EXPECT_FALSE(convert(dac, -2048 * 0.5).clipped);
  EXPECT_EQ(convert(dac, -1e300).code, -2048);
  EXPECT_TRUE(convert(dac, -1e300).clipped);
  EXPECT_EQ(convert(dac, 1e300).torque, 2047 * 0.5);
}

TEST(Dac, ErrorsDoNotChangeTheCode) {
  const DacParameters ideal;
  DacParameters dac;
  dac.offset = 0.3;
  dac.gain_error = 0.1;
  dac.nonlinearity = 20.0;
  dac.noise = 0.5;
  EXPECT_FALSE(has_errors(ideal));
  std::mt19937 random(2);
  std::uniform_real_distribution<double> torque(-0.6, 0.6);
  for (int i = 0; i < 1000; ++i) {
    const double wanted = torque(random);
    EXPECT_EQ(convert(dac, wanted).code, convert(ideal, wanted).code);
    EXPECT_EQ(convert(dac, wanted).torque, convert(ideal, wanted).torque);
  }
}

TEST(Dac, EachErrorParameterCountsAsAnError) {
  EXPECT_TRUE(has_errors({.offset = 1e-9}));
  EXPECT_TRUE(has_errors({.gain_error = -1e-9}));
  EXPECT_TRUE(has_errors({.nonlinearity = 1e-9}));
  EXPECT_TRUE(has_errors({.noise = 1e-9}));
}

}  // namespace
}  // namespace zerocount::loop
