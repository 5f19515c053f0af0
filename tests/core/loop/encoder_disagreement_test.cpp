// Where the two encoders contradict each other, and where they do not.
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "core/loop/measurement.hpp"
#include "tests/core/loop/random_encoders.hpp"

namespace zerocount::testing {
namespace {

struct EncoderDisagreementProperties : WithRandomEncoders {
  using WithRandomEncoders::WithRandomEncoders;
};

TEST_EACH_SEED(EncoderDisagreementProperties, IdealCountsAgreeAtEveryAngle) {
  const loop::EncoderParameters encoders = random_encoders();
  const double phase = random_phase();
  const loop::Encoder fine = loop::fine_encoder(encoders, phase);
  const loop::Encoder coarse = loop::coarse_encoder(encoders, phase);
  for (int i = 0; i < 2000; ++i) {
    const double theta = uniform(-50.0, 50.0);
    ASSERT_TRUE(
        loop::counts_agree(fine, coarse, {loop::read_count(fine, theta), loop::read_count(coarse, theta)}))
        << theta;
  }
}

TEST_EACH_SEED(EncoderDisagreementProperties, CountsThatNoAngleShowsDisagree) {
  const loop::EncoderParameters encoders = random_encoders();
  const double phase = random_phase();
  const loop::Encoder fine = loop::fine_encoder(encoders, phase);
  const loop::Encoder coarse = loop::coarse_encoder(encoders, phase);
  const double ratio = encoders.coarse / encoders.fine;
  for (int i = 0; i < 2000; ++i) {
    const double theta = uniform(-50.0, 50.0);
    const auto most =
        static_cast<std::int64_t>(std::ceil(ratio) + 1.0);  // coarse counts that a fine one meets
    const loop::EncoderReading reading{loop::read_count(fine, theta), loop::read_count(coarse, theta)};
    ASSERT_FALSE(loop::counts_agree(fine, coarse, {reading.fine, reading.coarse + most}));
    ASSERT_FALSE(loop::counts_agree(fine, coarse, {reading.fine, reading.coarse - most}));
  }
}

TEST(CountsAgree, TellsApartEdgesThatCoincide) {
  // The same encoder twice: one count of difference is impossible everywhere.
  const loop::Encoder encoder = loop::fine_encoder({}, 0.3);
  for (std::int64_t count = -5000000; count < 5000000; count += 99991) {
    EXPECT_TRUE(loop::counts_agree(encoder, encoder, {count, count}));
    EXPECT_FALSE(loop::counts_agree(encoder, encoder, {count, count + 1}));
    EXPECT_FALSE(loop::counts_agree(encoder, encoder, {count, count - 1}));
  }
  // 18.75 fine counts in a coarse one and phase 0: edges coincide at every 75 fine and 4 coarse counts.
  const loop::Encoder fine = loop::fine_encoder({}, 0.0);
  const loop::Encoder coarse = loop::coarse_encoder({}, 0.0);
  for (std::int64_t turn = -5000; turn < 5000; ++turn) {
    EXPECT_TRUE(loop::counts_agree(fine, coarse, {75 * turn, 4 * turn}));
    EXPECT_FALSE(loop::counts_agree(fine, coarse, {75 * turn, 4 * turn - 1}));
    EXPECT_TRUE(loop::counts_agree(fine, coarse, {75 * turn - 1, 4 * turn - 1}));
    EXPECT_FALSE(loop::counts_agree(fine, coarse, {75 * turn - 1, 4 * turn}));
    EXPECT_TRUE(
        loop::counts_agree(fine, coarse, {75 * turn + 18, 4 * turn}));  // 18.75 lies inside this count
    EXPECT_TRUE(loop::counts_agree(fine, coarse, {75 * turn + 18, 4 * turn + 1}));
  }
}

TEST_EACH_SEED(EncoderDisagreementProperties, EncodersThatShareAnEccentricityNeverDisagree) {
  loop::EncoderParameters encoders = random_encoders();
  encoders.fine_errors.eccentricity = encoders.coarse_errors.eccentricity = uniform(1e-4, 1e-1);
  encoders.fine_errors.eccentricity_angle = encoders.coarse_errors.eccentricity_angle = uniform(-7.0, 7.0);
  loop::Measurement measurement(encoders, random_phase(), uniform(0.0, revolution),
                                randomness_of_encoders(1));
  for (int i = 0; i < 3000; ++i) measurement.read(i, uniform(-10.0, 10.0));
  EXPECT_EQ(measurement.disagreements(), 0);
}

TEST(EncoderDisagreement, BeginsWhereTheFineCountLagsBehindTheCoarseOne) {
  // A fine encoder that never counts stays at 0 and stands for the angles [−½, ½) of its counts: the coarse
  // counts (½ − ½/18.75, ½ + ½/18.75) are of count 0 alone, so every other coarse count is impossible.
  loop::EncoderParameters encoders;
  encoders.fine_errors.missed = 1.0;
  loop::Measurement measurement(encoders, 0.5, 0.0, randomness_of_encoders(1));
  std::int64_t expected = 0;
  for (int k = 0; k < 1000; ++k) {
    const double theta = 0.1 * k * measurement.fine_resolution();
    const loop::EncoderReading reading = measurement.read(k, theta);
    ASSERT_EQ(reading.fine, 0);
    if (reading.coarse != 0) ++expected;
    ASSERT_EQ(measurement.disagreements(), expected);
  }
  EXPECT_GT(expected, 900);  // from 18.75/2 fine counts on
}

TEST(EncoderDisagreement, SeesALossOfMoreThanACoarseCountAtEverySample) {
  loop::EncoderParameters encoders;
  encoders.fine_errors.missed = 0.01;
  loop::Measurement measurement(encoders, 0.25, 1.0, randomness_of_encoders(3));
  const double resolution = measurement.fine_resolution();
  int beyond = 0;
  int impossible_before = 0;
  for (int k = 0; k < 3000; ++k) {
    const double theta = 3.3 * k * resolution;
    const std::int64_t before = measurement.disagreements();
    const loop::EncoderReading reading = measurement.read(k, theta);
    const double lag =
        static_cast<double>(loop::read_count(loop::fine_encoder(encoders, 0.25), theta) - reading.fine);
    const bool impossible = measurement.disagreements() > before;
    if (lag == 0.0) {
      EXPECT_FALSE(impossible);
    } else if (lag > measurement.fine_per_coarse() + 1.0) {
      EXPECT_TRUE(impossible);
      ++beyond;
    } else if (impossible) {
      ++impossible_before;
    }
  }
  EXPECT_GT(beyond, 100);
  EXPECT_GT(impossible_before, 10);  // smaller losses show at some angles
}

}  // namespace
}  // namespace zerocount::testing
