// What is wrong with an encoder, error by error.
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/loop/measurement.hpp"
#include "tests/core/loop/random_encoders.hpp"
#include "tests/support/goodness_of_fit.hpp"

namespace zerocount::testing {
namespace {

struct EncoderErrorProperties : WithRandomEncoders {
  using WithRandomEncoders::WithRandomEncoders;
};

TEST_EACH_SEED(EncoderErrorProperties, EccentricityIsFixedOnTheRotorAndReturnsAfterARevolution) {
  loop::EncoderParameters encoders;
  encoders.fine_errors.eccentricity = uniform(1e-4, 1e-2);
  encoders.fine_errors.eccentricity_angle = uniform(-7.0, 7.0);
  const double phase = random_phase();
  const double start = uniform(0.0, revolution);
  loop::Measurement from_start(encoders, phase, start, randomness_of_encoders(1));
  loop::Measurement from_zero(encoders, phase, 0.0, randomness_of_encoders(1));
  const std::int64_t offset = from_zero.read(0, start).fine;
  for (int i = 1; i < 300; ++i) {
    const double theta = uniform(-10.0, 10.0);
    const std::int64_t count = from_start.read(i, theta).fine;
    EXPECT_NEAR(static_cast<double>(from_zero.read(i, start + theta).fine - offset),
                static_cast<double>(count), 1.0);
    EXPECT_NEAR(static_cast<double>(from_start.read(i, theta + revolution).fine),
                static_cast<double>(count) + encoders.fine, 1.0);
  }
}

TEST_EACH_SEED(EncoderErrorProperties, EccentricityReachesItsAmplitudeAQuarterTurnFromItsAngle) {
  loop::EncoderParameters encoders;
  const double amplitude = uniform(1e-4, 1e-2);
  encoders.fine_errors.eccentricity = amplitude;
  encoders.fine_errors.eccentricity_angle = uniform(-7.0, 7.0);
  loop::Measurement measurement(encoders, 0.5, encoders.fine_errors.eccentricity_angle,
                                randomness_of_encoders(1));
  const double in_counts = amplitude / measurement.fine_resolution();
  EXPECT_NEAR(static_cast<double>(measurement.read(1, revolution / 4.0).fine),
              encoders.fine / 4.0 + in_counts, 1.0);
  EXPECT_NEAR(static_cast<double>(measurement.read(2, -revolution / 4.0).fine),
              -encoders.fine / 4.0 - in_counts, 1.0);
  EXPECT_NEAR(static_cast<double>(measurement.read(3, revolution / 2.0).fine), encoders.fine / 2.0, 1.0);
  // About its angle the error is odd, and so is the reading with an edge half a count on either side.
  for (int i = 4; i < 200; ++i) {
    const double theta = uniform(0.0, 10.0);
    EXPECT_EQ(measurement.read(i, theta).fine, -measurement.read(i, -theta).fine);
  }
}

TEST_EACH_SEED(EncoderErrorProperties, InterpolationMovesTheEdges) {
  // The edge of count n lies where x + A·(s(x) − s(phase)) = n. Weak enough, the left side rises throughout,
  // and the edge is found by bisection: in the readings, and in the equation.
  loop::EncoderParameters encoders;
  loop::EncoderErrors& errors = encoders.fine_errors;
  errors.interpolation_period = uniform(2.0, 20.0);
  errors.interpolation = uniform(0.1, 0.9) * errors.interpolation_period / revolution;
  const double phase = random_phase();
  const double position = uniform(0.0, revolution);
  loop::Measurement measurement(encoders, phase, position, randomness_of_encoders(1));
  const double resolution = measurement.fine_resolution();
  const long double start = std::floor(position / resolution);
  const auto sine = [&](long double x) {
    return std::sin(2.0L * std::numbers::pi_v<long double> * (start + x) / errors.interpolation_period);
  };
  const auto first_where = [](double low, double high, auto reached) {
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (reached(middle) ? high : low) = middle;
    }
    return high;
  };
  for (int n = -20; n < 20; ++n) {
    const double seen = first_where(n - 25.0, n + 25.0, [&](double counts) {
      return measurement.read(0, (counts - phase) * resolution).fine >= n;
    });
    const double expected = first_where(n - 25.0, n + 25.0, [&](double counts) {
      return counts + errors.interpolation * (sine(counts) - sine(phase)) >= n;
    });
    EXPECT_NEAR(seen, expected, 1e-6);
    EXPECT_NEAR(seen, n, 2.0 * errors.interpolation + 1e-6);
  }
}

TEST_EACH_SEED(EncoderErrorProperties, InterpolationRepeatsItselfEveryPeriod) {
  loop::EncoderParameters encoders;
  encoders.coarse_errors.interpolation = uniform(0.1, 5.0);
  encoders.coarse_errors.interpolation_period = static_cast<double>(1 + random_() % 20);
  loop::Measurement measurement(encoders, random_phase(), uniform(0.0, revolution),
                                randomness_of_encoders(1));
  const double period = encoders.coarse_errors.interpolation_period;
  for (int i = 0; i < 500; ++i) {
    const double theta = uniform(-1.0, 1.0);
    EXPECT_EQ(measurement.read(i, theta + period * measurement.coarse_resolution()).coarse,
              measurement.read(i, theta).coarse + std::llround(period));
  }
}

TEST_EACH_SEED(EncoderErrorProperties, NoiseIsNormalBeforeTheRounding) {
  loop::EncoderParameters encoders;
  encoders.fine_errors.noise = uniform(0.1, 3.0);
  encoders.coarse_errors.noise = uniform(0.1, 3.0);
  const double phase = random_phase();
  loop::Measurement measurement(encoders, phase, 0.0, randomness_of_encoders(seed_));
  const double theta = uniform(-1e-3, 1e-3);
  constexpr int samples = 20000;
  const auto centre = [&](double resolution) { return theta / resolution + phase; };
  const auto cells_of = [&](double noise, double x) {
    std::vector<double> cells(41);
    const auto below = [&](double edge) { return 0.5 * std::erfc((x - edge) / (noise * std::sqrt(2.0))); };
    for (int i = 0; i < 41; ++i) {
      const double edge = std::floor(x) + i - 20.0;
      cells[static_cast<std::size_t>(i)] = samples * (below(edge + 1.0) - below(edge));
    }
    return cells;
  };
  std::vector<double> fine(41, 0.0);
  std::vector<double> coarse(41, 0.0);
  double product = 0.0;
  double successive = 0.0;
  double last = 0.0;
  const double fine_centre = centre(measurement.fine_resolution());
  const double coarse_centre = centre(measurement.coarse_resolution());
  const std::vector<double> fine_cells = cells_of(encoders.fine_errors.noise, fine_centre);
  const std::vector<double> coarse_cells = cells_of(encoders.coarse_errors.noise, coarse_centre);
  for (int k = 0; k < samples; ++k) {
    const loop::EncoderReading reading = measurement.read(k, theta);
    const double fine_error = static_cast<double>(reading.fine) + 0.5 - fine_centre;
    const double coarse_error = static_cast<double>(reading.coarse) + 0.5 - coarse_centre;
    ++fine.at(static_cast<std::size_t>(reading.fine - std::llround(std::floor(fine_centre)) + 20));
    ++coarse.at(static_cast<std::size_t>(reading.coarse - std::llround(std::floor(coarse_centre)) + 20));
    product += fine_error * coarse_error;
    successive += fine_error * last;
    last = fine_error;
  }
  EXPECT_GT(chi_square_probability(fine, fine_cells), 1e-4);
  EXPECT_GT(chi_square_probability(coarse, coarse_cells), 1e-4);
  // Noise of one sample says nothing of the other encoder's, nor of the next sample's. (Rounding adds up to
  // half a count of bias, hence the squares.)
  const double fine_square = encoders.fine_errors.noise * encoders.fine_errors.noise + 0.25;
  const double coarse_square = encoders.coarse_errors.noise * encoders.coarse_errors.noise + 0.25;
  double fine_mean = 0.0;
  double coarse_mean = 0.0;
  for (int i = 0; i < 41; ++i) {
    const auto cell = static_cast<std::size_t>(i);
    fine_mean += fine_cells[cell] * (std::floor(fine_centre) + i - 19.5 - fine_centre) / samples;
    coarse_mean += coarse_cells[cell] * (std::floor(coarse_centre) + i - 19.5 - coarse_centre) / samples;
  }
  EXPECT_NEAR(product / samples, fine_mean * coarse_mean,
              4.5 * std::sqrt(fine_square * coarse_square / samples));
  EXPECT_NEAR(successive / samples, fine_mean * fine_mean, 4.5 * fine_square / std::sqrt(samples));
}

TEST_EACH_SEED(EncoderErrorProperties, PassedCountsAreMissedIndependently) {
  loop::EncoderParameters encoders;
  const double p = encoders.fine_errors.missed = uniform(0.01, 0.99);
  loop::Measurement measurement(encoders, 0.5, 0.0, randomness_of_encoders(seed_));
  constexpr int step = 6;  // counts per sample
  constexpr int samples = 5000;
  std::vector<double> observed(step + 1, 0.0);
  std::vector<double> expected(step + 1, 0.0);
  double ways = 1.0;
  for (int j = 0; j <= step; ++j) {
    expected[static_cast<std::size_t>(j)] = samples * ways * std::pow(p, j) * std::pow(1.0 - p, step - j);
    ways *= static_cast<double>(step - j) / (j + 1);
  }
  std::int64_t last = measurement.read(0, 0.0).fine;
  ASSERT_EQ(last, 0);
  std::int64_t raw = 0;
  for (int k = 1; k <= samples; ++k) {
    const int direction = random_() % 2 == 0 ? 1 : -1;
    raw += step * direction;
    const std::int64_t count =
        measurement.read(k, static_cast<double>(raw) * measurement.fine_resolution()).fine;
    const std::int64_t missed =
        step - (count - last) * direction;  // what is left out, in the direction of motion
    ASSERT_GE(missed, 0);
    ASSERT_LE(missed, step);
    ++observed[static_cast<std::size_t>(missed)];
    last = count;
  }
  EXPECT_GT(chi_square_probability(observed, expected), 1e-4);
}

TEST(MissedCounts, AreLostForEverAndOnlyInMotion) {
  loop::EncoderParameters encoders;
  encoders.coarse_errors.missed = 1.0;
  loop::Measurement all_missed(encoders, 0.5, 0.0, randomness_of_encoders(1));
  // What lay before the first sample was not passed.
  EXPECT_EQ(all_missed.read(0, 10.0 * all_missed.coarse_resolution()).coarse, 10);
  for (int k = 1; k < 100; ++k)
    EXPECT_EQ(all_missed.read(k, 3.0 * k * all_missed.coarse_resolution()).coarse, 10);

  encoders.coarse_errors.missed = 0.5;
  loop::Measurement half_missed(encoders, 0.5, 0.0, randomness_of_encoders(1));
  half_missed.read(0, 0.0);
  const std::int64_t count = half_missed.read(1, 1000.0 * half_missed.coarse_resolution()).coarse;
  EXPECT_NEAR(static_cast<double>(count), 500.0, 100.0);
  for (int k = 2; k < 100; ++k)
    EXPECT_EQ(half_missed.read(k, 1000.0 * half_missed.coarse_resolution()).coarse, count);
}

}  // namespace
}  // namespace zerocount::testing
