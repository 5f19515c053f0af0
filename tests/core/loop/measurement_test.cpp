// The two encoders: as ideal ones they read as ever; what they show is their own trial's alone.
#include "core/loop/measurement.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/loop/random_encoders.hpp"

namespace zerocount::testing {
namespace {

/// Errors that are on, but too small to do anything.
loop::EncoderErrors idle_errors() {
  loop::EncoderErrors errors;
  errors.missed = 1e-300;
  return errors;
}

struct MeasurementProperties : WithRandomEncoders {
  using WithRandomEncoders::WithRandomEncoders;

  /// Angles close to edges of either encoder, on them, and one or two roundings beside them.
  std::vector<double> angles_at_edges(const loop::Encoder& fine, const loop::Encoder& coarse) {
    std::vector<double> angles;
    for (int i = 0; i < 500; ++i) {
      const loop::Encoder& encoder = i % 2 == 0 ? fine : coarse;
      const double edge = (std::floor(uniform(-2000.0, 2000.0)) - encoder.phase) * encoder.resolution;
      double below = edge;
      double above = edge;
      angles.push_back(edge);
      for (int step = 0; step < 3; ++step) {
        below = std::nextafter(below, -INFINITY);
        above = std::nextafter(above, INFINITY);
        angles.insert(angles.end(), {below, above});
      }
    }
    return angles;
  }
};

TEST_EACH_SEED(MeasurementProperties, IdealEncodersReadAsTheyAlwaysDid) {
  const loop::EncoderParameters encoders = random_encoders();
  const double phase = random_phase();
  const loop::Encoder fine = loop::fine_encoder(encoders, phase);
  const loop::Encoder coarse = loop::coarse_encoder(encoders, phase);
  loop::Measurement ideal(encoders, phase, uniform(0.0, revolution), randomness_of_encoders(1));
  loop::EncoderParameters with_idle_errors = encoders;
  with_idle_errors.fine_errors = with_idle_errors.coarse_errors = idle_errors();
  loop::Measurement idle(with_idle_errors, phase, uniform(0.0, revolution), randomness_of_encoders(1));

  std::vector<double> angles = angles_at_edges(fine, coarse);
  for (int i = 0; i < 500; ++i) angles.push_back(uniform(-100.0, 100.0));
  std::int64_t k = 0;
  for (const double theta : angles) {
    for (loop::Measurement* measurement : {&ideal, &idle}) {
      const loop::EncoderReading reading = measurement->read(k, theta);
      ASSERT_EQ(reading.fine, loop::read_count(fine, theta));
      ASSERT_EQ(reading.coarse, loop::read_count(coarse, theta));
    }
    ++k;
  }
  EXPECT_EQ(ideal.disagreements(), 0);
  EXPECT_EQ(idle.disagreements(), 0);
  EXPECT_DOUBLE_EQ(ideal.fine_resolution() * ideal.fine_per_coarse(), ideal.coarse_resolution());
}

// Beyond all sense, but not beyond the numbers: a count stays one that others can be taken from.
TEST(Measurement, OfAbsurdErrorsStaysAWholeNumber) {
  for (const double absurd : {1e30, 1e300, 1e308}) {
    loop::EncoderParameters encoders;
    encoders.fine_errors.eccentricity = absurd;
    encoders.fine_errors.interpolation = absurd;
    encoders.coarse_errors.noise = absurd;
    loop::Measurement measurement(encoders, 0.5, 0.0, randomness_of_encoders(1));
    for (std::int64_t k = 0; k < 100; ++k) {
      const loop::EncoderReading reading = measurement.read(k, 0.01 * static_cast<double>(k));
      EXPECT_LE(std::abs(static_cast<double>(reading.fine)), 0x1p52);
      EXPECT_LE(std::abs(static_cast<double>(reading.coarse)), 0x1p52);
    }
  }
}

TEST_EACH_SEED(MeasurementProperties, SystematicErrorsStartAtCountZero) {
  for (int i = 0; i < 100; ++i) {
    loop::EncoderParameters encoders = random_encoders();
    encoders.fine_errors.eccentricity = encoders.coarse_errors.eccentricity = uniform(0.0, 1e-2);
    encoders.fine_errors.eccentricity_angle = uniform(-7.0, 7.0);
    encoders.fine_errors.interpolation = encoders.coarse_errors.interpolation = uniform(0.0, 5.0);
    encoders.fine_errors.interpolation_period = uniform(0.5, 100.0);
    loop::Measurement measurement(encoders, random_phase(), uniform(-10.0, 10.0), randomness_of_encoders(1));
    const loop::EncoderReading reading = measurement.read(0, 0.0);
    EXPECT_EQ(reading.fine, 0);
    EXPECT_EQ(reading.coarse, 0);
  }
}

TEST_EACH_SEED(MeasurementProperties, ReadingDependsOnItsTrialAndItsPastAlone) {
  loop::EncoderParameters encoders = random_encoders();
  for (loop::EncoderErrors* errors : {&encoders.fine_errors, &encoders.coarse_errors}) {
    errors->eccentricity = 1e-3;
    errors->interpolation = 0.3;
    errors->noise = 0.5;
    errors->missed = 0.1;
  }
  std::vector<double> angles;
  for (int k = 0; k < 200; ++k) angles.push_back(uniform(-1.0, 1.0));
  const auto readings = [&](std::uint64_t trial, std::uint32_t stream) {
    random::TrialRandomness randomness = randomness_of_encoders(trial);
    randomness.stream = stream;
    loop::Measurement measurement(encoders, 0.3, 1.0, randomness);
    std::vector<std::int64_t> counts;
    for (std::size_t k = 0; k < angles.size(); ++k) {
      const loop::EncoderReading reading = measurement.read(static_cast<std::int64_t>(k), angles[k]);
      counts.insert(counts.end(), {reading.fine, reading.coarse});
    }
    return counts;
  };
  const std::vector<std::int64_t> alone = readings(5, 0);
  EXPECT_NE(readings(6, 0), alone);
  EXPECT_NE(readings(5, 1), alone);
  EXPECT_EQ(readings(5, 0), alone);

  loop::Measurement one(encoders, 0.3, 1.0, randomness_of_encoders(5));
  loop::Measurement other(encoders, 0.3, 1.0, randomness_of_encoders(6));
  for (std::size_t k = 0; k < angles.size(); ++k) {
    other.read(static_cast<std::int64_t>(k), -angles[k]);
    const loop::EncoderReading reading = one.read(static_cast<std::int64_t>(k), angles[k]);
    ASSERT_EQ(reading.fine, alone[2 * k]);
    ASSERT_EQ(reading.coarse, alone[2 * k + 1]);
  }
}

}  // namespace
}  // namespace zerocount::testing
