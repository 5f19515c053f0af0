// The encoder: floor, at edges and below zero.
#include "core/loop/encoder.hpp"

#include "core/loop/measurement.hpp"
#include "tests/core/loop/random_encoders.hpp"
#include "tests/support/test.hpp"

namespace zerocount::loop {
namespace {

TEST(Encoder, ResolutionIsARevolutionOverTheCounts) {
  EXPECT_DOUBLE_EQ(fine_encoder({}, 0.0).resolution, 2.0 * std::numbers::pi / 1620000);
}

TEST(Encoder, StartsAtCountZeroForEveryPhase) {
  for (const double phase : {0.0, 0.25, 0.5, 0.999999})
    EXPECT_EQ(read_count(fine_encoder({}, phase), 0.0), 0);
}

TEST(Encoder, ChangesItsCountExactlyAtTheEdge) {
  const Encoder encoder = fine_encoder({}, 0.25);
  for (const std::int64_t n : {-3, -1, 0, 1, 2, 1000}) {
    const double edge = (static_cast<double>(n) - 0.25) * encoder.resolution;
    EXPECT_EQ(read_count(encoder, edge + 1e-6 * encoder.resolution), n);
    EXPECT_EQ(read_count(encoder, edge - 1e-6 * encoder.resolution), n - 1);
  }
}

TEST(Encoder, TruncatesDownwardsBelowZero) {
  const Encoder encoder{1.0, 0.0};
  EXPECT_EQ(read_count(encoder, -0.0), 0);
  EXPECT_EQ(read_count(encoder, -1e-9), -1);
  EXPECT_EQ(read_count(encoder, -1.0), -1);
  EXPECT_EQ(read_count(encoder, -1.5), -2);
}

TEST(Encoder, CountDiffersFromThePositionByLessThanOneCount) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-10.0, 10.0);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const Encoder encoder = coarse_encoder({}, unit(random));
    const double theta = angle(random);
    const double remainder =
        theta / encoder.resolution + encoder.phase - static_cast<double>(read_count(encoder, theta));
    EXPECT_GE(remainder, 0.0);
    EXPECT_LT(remainder, 1.0);
  }
}

}  // namespace
}  // namespace zerocount::loop

// The two encoders: as ideal ones they read as ever; what they show is their own trial's alone.

namespace zerocount::testing {
namespace {

/// Encoder errors that are switched on, but too small to change any count.
loop::EncoderErrors idle_errors() {
  loop::EncoderErrors errors;
  errors.missed = 1e-300;
  return errors;
}

struct MeasurementProperties : WithRandomEncoders {
  using WithRandomEncoders::WithRandomEncoders;

  /// Random angles close to edges of either encoder's counts, on the edges, and one or two roundings beside
  /// them.
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

TEST_EACH_SEED(MeasurementProperties, ZeroErrorsReadLikeIdealEncoders) {
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
  EXPECT_DOUBLE_EQ(ideal.fine_resolution() * ideal.fine_per_coarse(), coarse_resolution(encoders));
}

// Beyond all sense, but not beyond the numbers: a count stays one that others can be taken from.
TEST(Measurement, AbsurdErrorsStillGiveWholeCounts) {
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

// Where the two encoders contradict each other, and where they do not.

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

TEST(CountsAgree, DistinguishesCountsAtCoincidingEdges) {
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

}  // namespace
}  // namespace zerocount::testing
