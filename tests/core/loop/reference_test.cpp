// The reference of a move: its ends, its limits, its symmetry, that it is the fastest, and every count of it
// against the seven segments integrated one after the other.
#include "core/loop/reference.hpp"

#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::loop {
namespace {

constexpr double paper_resolution = 2.0 * std::numbers::pi / 1620000.0;

/// A move from rest to rest, and the limits of velocity, acceleration and jerk in the same unit of length.
struct Move {
  ReferenceProfile profile;
  long double travel;
};

/// The largest velocity and acceleration of a move, and the duration of its jerk, s.
struct Segments {
  long double jerk, jerk_time, acceleration_time, cruise_time;
  long double duration() const { return 4 * jerk_time + 2 * acceleration_time + cruise_time; }
};

/// The fastest symmetric move within the limits, found without the formulas under test: the highest velocity
/// that can be reached and left within the travel, by bisection.
Segments fastest_segments(const Move& move) {
  const long double acceleration_limit = move.profile.acceleration_limit;
  const long double jerk_limit = move.profile.jerk_limit;
  const bool trapezoidal = move.profile.shape == ReferenceShape::trapezoidal;
  const auto segments_with = [&](long double velocity) {
    Segments s{jerk_limit, 0, velocity / acceleration_limit, 0};
    if (!trapezoidal) {
      const long double acceleration = std::min(acceleration_limit, std::sqrt(velocity * jerk_limit));
      s.jerk_time = acceleration / jerk_limit;
      s.acceleration_time = std::max(0.0L, velocity / acceleration - s.jerk_time);
    }
    s.cruise_time = move.travel / velocity - 2 * s.jerk_time - s.acceleration_time;
    return s;
  };
  long double low = 0;
  long double high = move.profile.velocity_limit;
  if (segments_with(high).cruise_time >= 0) return segments_with(high);
  for (int i = 0; i < 200; ++i) {
    const long double middle = (low + high) / 2;
    (segments_with(middle).cruise_time >= 0 ? low : high) = middle;
  }
  return segments_with(low);
}

/// Position of the move at the time t, integrated over segments of constant jerk.
long double integrated_position(const Segments& s, long double acceleration_limit, long double t) {
  const bool trapezoidal = s.jerk_time == 0;
  long double position = 0;
  long double velocity = 0;
  const auto go = [&](long double time, long double jerk, long double acceleration) {
    time = std::clamp(t, 0.0L, time);
    t -= time;
    position += time * (velocity + time * (acceleration / 2 + time * jerk / 6));
    velocity += time * (acceleration + time * jerk / 2);
  };
  const long double a = trapezoidal ? acceleration_limit : s.jerk * s.jerk_time;
  go(s.jerk_time, s.jerk, 0);
  go(s.acceleration_time, 0, a);
  go(s.jerk_time, -s.jerk, a);
  go(s.cruise_time, 0, 0);
  go(s.jerk_time, -s.jerk, 0);
  go(s.acceleration_time, 0, -a);
  go(s.jerk_time, s.jerk, -a);
  return position;
}

class Sampler {
 public:
  explicit Sampler(unsigned seed) : random_(seed) {}
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  double power_of_ten(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  std::int64_t integer(std::int64_t a, std::int64_t b) {
    return std::uniform_int_distribution<std::int64_t>(a, b)(random_);
  }

  /// Random limits over orders of magnitude: for a travel around 1, each limit may or may not be reached.
  ReferenceProfile profile() {
    ReferenceProfile p;
    p.shape = integer(0, 3) == 0 ? ReferenceShape::trapezoidal : ReferenceShape::s_curve;
    p.velocity_limit = power_of_ten(-2, 2);
    p.acceleration_limit = power_of_ten(-3, 3);
    p.jerk_limit = power_of_ten(-3, 5);
    return p;
  }

 private:
  std::mt19937_64 random_;
};

TEST(Reference, AStepIsImmediatelyAtTheTarget) {
  const Reference step({.shape = ReferenceShape::step}, -5, 20, paper_resolution);
  EXPECT_EQ(step.duration(), 0.0);
  for (const double t : {0.0, 1e-9, 1.0, 1e9}) EXPECT_EQ(step.at(t), 20);
}

TEST(Reference, NoTravelTakesNoTime) {
  for (const auto shape : {ReferenceShape::step, ReferenceShape::trapezoidal, ReferenceShape::s_curve}) {
    const Reference still({.shape = shape}, -7, -7, paper_resolution);
    EXPECT_EQ(still.duration(), 0.0);
    for (const double t : {-1.0, 0.0, 1e-9, 1.0}) EXPECT_EQ(still.at(t), -7);
  }
}

TEST(Reference, SineOscillatesAboutTheTargetWithoutEnd) {
  Sampler draw(8);
  for (int i = 0; i < 100; ++i) {
    const double amplitude = draw.power_of_ten(-5, -1);
    const double frequency = draw.power_of_ten(-1, 2);
    const std::int64_t target = draw.integer(-1000, 1000);
    const Reference sine({.shape = ReferenceShape::sine, .amplitude = amplitude, .frequency = frequency}, 7,
                         target, paper_resolution);
    EXPECT_TRUE(std::isinf(sine.duration()));
    EXPECT_TRUE(std::isnan(sine.travel_time()));
    for (int k = 0; k < 50; ++k) {
      const double t = draw.uniform(0.0, 10.0 / frequency);
      const long double w = 2 * std::numbers::pi_v<long double> * frequency;
      const long double counts = amplitude / paper_resolution * std::sin(w * t);
      const double tolerance = 1e-10 * amplitude / paper_resolution;
      EXPECT_NEAR(sine.exact_at(t), static_cast<double>(static_cast<long double>(target) + counts),
                  tolerance + 1e-9);
      EXPECT_LE(std::abs(static_cast<double>(sine.at(t)) - sine.exact_at(t)), 0.5 + tolerance);
      const ReferenceMotion motion = sine.motion_at(t);
      EXPECT_NEAR(motion.velocity, static_cast<double>(amplitude * w * std::cos(w * t)),
                  1e-10 * amplitude * static_cast<double>(w));
      EXPECT_NEAR(motion.acceleration, static_cast<double>(-amplitude * w * w * std::sin(w * t)),
                  1e-10 * amplitude * static_cast<double>(w * w));
    }
  }
}

TEST(Reference, EveryCountIsNearestToTheIntegratedSegments) {
  Sampler draw(1);
  std::int64_t compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const Move move{draw.profile(), draw.power_of_ten(-3, 3)};
    const std::int64_t from = draw.integer(-1000000, 1000000);
    const auto counts = static_cast<std::int64_t>(draw.power_of_ten(0, 7));
    const bool down = draw.integer(0, 1) == 1;
    const double resolution = static_cast<double>(move.travel) / static_cast<double>(counts);
    const Reference reference(move.profile, from, down ? from - counts : from + counts, resolution);
    const Segments segments = fastest_segments(move);
    ASSERT_NEAR(reference.duration(), static_cast<double>(segments.duration()), 1e-12 * reference.duration());
    for (int k = 0; k < 50; ++k) {
      const double t = reference.duration() * draw.uniform(0.0, 1.0);
      const long double exact =
          integrated_position(segments, move.profile.acceleration_limit, t) / resolution;
      if (std::abs(exact - std::floor(exact) - 0.5L) < 1e-5L) continue;  // either count is as near
      const std::int64_t forwards = std::llround(exact);
      ASSERT_EQ(reference.at(t), down ? from - forwards : from + forwards) << "move " << i << ", t " << t;
      ++compared;
    }
  }
  EXPECT_GT(compared, 99000);
}

TEST(Reference, EveryMoveEndsExactlyAndIsMonotone) {
  Sampler draw(5);
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t from = draw.integer(-100, 100);
    const auto counts = static_cast<std::int64_t>(draw.power_of_ten(0, 12)) * (i % 2 == 0 ? 1 : -1);
    const std::int64_t to = from + counts;
    const Reference reference(draw.profile(), from, to, paper_resolution * draw.power_of_ten(-2, 2));
    const double duration = reference.duration();
    ASSERT_TRUE(std::isfinite(duration));
    ASSERT_GT(duration, 0.0);
    EXPECT_EQ(reference.at(-1.0), from);
    EXPECT_EQ(reference.at(0.0), from);
    EXPECT_EQ(reference.at(std::nextafter(duration, 0.0)), to);
    for (const double t : {duration, std::nextafter(duration, 2 * duration), 2 * duration, 1e300})
      EXPECT_EQ(reference.at(t), to);
    std::int64_t last = from;
    for (int k = 0; k <= 1000; ++k) {
      const std::int64_t now = reference.at(duration * k / 1000.0);
      ASSERT_GE((now - last) * (counts > 0 ? 1 : -1), 0);
      last = now;
    }
    EXPECT_EQ(last, to);
  }
}

TEST(Reference, OddTravelsAreMonotoneAtTheMiddle) {
  Sampler draw(7);
  for (int i = 0; i < 500; ++i) {
    const std::int64_t to = 2 * draw.integer(0, 5) + 1;
    const Reference reference(draw.profile(), 0, to, draw.power_of_ten(-6, 0));
    double t = reference.duration() / 2;
    for (int k = 0; k < 10; ++k) t = std::nextafter(t, 0.0);
    std::int64_t last = reference.at(t);
    for (int k = 0; k < 20; ++k) {
      t = std::nextafter(t, 1e300);
      ASSERT_GE(reference.at(t), last);
      last = reference.at(t);
    }
    EXPECT_EQ(last, (to + 1) / 2);
  }
}

// The motion of the reference integrated twice, with the trapezoidal rule between samples, leads to its
// target.
TEST(Reference, VelocityAndAccelerationAreDerivativesOfThePath) {
  Sampler sampler(44);
  for (int i = 0; i < 100; ++i) {
    ReferenceProfile profile;
    profile.shape = i % 2 == 0 ? ReferenceShape::trapezoidal : ReferenceShape::s_curve;
    profile.velocity_limit = sampler.uniform(0.01, 1.0);
    profile.acceleration_limit = sampler.uniform(0.1, 10.0);
    profile.jerk_limit = sampler.uniform(1.0, 500.0);
    constexpr double resolution = 1e-4;
    const std::int64_t to = i % 3 == 0 ? -2000 : 1000;
    const Reference reference(profile, 0, to, resolution);
    constexpr int steps = 20000;
    const double h = reference.duration() / steps;
    double position = 0.0;
    double velocity = 0.0;
    for (int k = 0; k < steps; ++k) {
      const ReferenceMotion now = reference.motion_at(k * h);
      const ReferenceMotion next = reference.motion_at((k + 1) * h);
      ASSERT_NEAR(now.velocity, velocity, 3.0 * h * profile.acceleration_limit) << k;  // at its jumps
      ASSERT_NEAR(static_cast<double>(reference.at(k * h)), position / resolution, 0.7) << k;
      position += 0.5 * h * (now.velocity + next.velocity);
      velocity += 0.5 * h * (now.acceleration + next.acceleration);
    }
    EXPECT_NEAR(position, static_cast<double>(to) * resolution, 1e-4 * std::abs(position));
    const ReferenceMotion at_end = reference.motion_at(reference.duration());
    EXPECT_EQ(at_end.velocity, 0.0);
    EXPECT_EQ(at_end.acceleration, 0.0);
    EXPECT_EQ(reference.motion_at(0.0).velocity, 0.0);
  }
  EXPECT_EQ(Reference({}, 0, 5, 1e-4).motion_at(0.0).velocity, 0.0);
}

// A trapezoidal move that reaches no limit of the velocity: the acceleration is that just after a switch.
TEST(Reference, AccelerationAtASwitchIsTheOneAfterIt) {
  const ReferenceProfile profile{ReferenceShape::trapezoidal, 0.02, 0.5, 1.0};
  const Reference reference(profile, 0, 1000, 2e-6);  // 0.04 s up, 0.06 s cruise, 0.04 s down
  ASSERT_NEAR(reference.duration(), 0.14, 1e-12);
  for (const auto& [t, acceleration] : {std::pair{0.0, 0.5},
                                        {0.039, 0.5},
                                        {0.04, 0.0},
                                        {0.099, 0.0},
                                        {0.1, -0.5},
                                        {0.139, -0.5},
                                        {0.14, 0.0}}) {
    EXPECT_EQ(reference.motion_at(t).acceleration, acceleration) << t;
  }
  EXPECT_NEAR(reference.motion_at(0.02).velocity, 0.01, 1e-15);
  EXPECT_NEAR(Reference(profile, 0, -1000, 2e-6).motion_at(0.12).velocity, -0.01, 1e-15);
}

TEST(Reference, VeryLargeLimitsHaveNoEffect) {
  constexpr double none = 1e308;
  const auto duration = [](ReferenceShape shape, double v, double a, double j) {
    return Reference({shape, v, a, j}, 0, 4000, 1e-3).duration();
  };
  EXPECT_NEAR(duration(ReferenceShape::trapezoidal, 2.0, none, 1.0), 2.0, 1e-15);
  EXPECT_NEAR(duration(ReferenceShape::trapezoidal, none, 4.0, 1.0), 2.0, 1e-15);
  EXPECT_NEAR(duration(ReferenceShape::s_curve, 2.0, none, none), 2.0, 1e-15);
  EXPECT_NEAR(duration(ReferenceShape::s_curve, none, 4.0, none), 2.0, 1e-15);
  EXPECT_NEAR(duration(ReferenceShape::s_curve, none, none, 16.0), 2.0, 1e-15);
  EXPECT_NEAR(duration(ReferenceShape::s_curve, none, none, none), 0.0, 1e-100);
}

TEST(Reference, AnyLimitsGiveAMoveBetweenItsEnds) {
  Sampler draw(8);
  for (int i = 0; i < 10000; ++i) {
    const auto limit = [&draw] { return draw.power_of_ten(-307, 308); };
    const auto shape = i % 3 == 0 ? ReferenceShape::trapezoidal : ReferenceShape::s_curve;
    const Reference reference({shape, limit(), limit(), limit()}, 0, 1000, paper_resolution);
    ASSERT_GT(reference.duration(), 0.0);  // and not NaN; it may be more than any number
    std::int64_t last = 0;
    for (int k = 0; k <= 20; ++k) {
      const std::int64_t now = reference.at(std::min(reference.duration(), 1e300) * k / 20.0);
      ASSERT_GE(now, last);
      ASSERT_LE(now, 1000);
      last = now;
    }
  }
}

TEST(Reference, HugeTravelsEndExactly) {
  constexpr std::int64_t huge = 1'000'000'000'000;
  for (const std::int64_t to : {huge, -huge}) {
    const Reference reference({ReferenceShape::s_curve, 2.0, 100.0, 1e4}, -to, to, paper_resolution);
    const double travel = 2.0 * static_cast<double>(huge) * paper_resolution;
    EXPECT_NEAR(reference.duration(), travel / 2.0 + 0.03, 1e-6);
    EXPECT_EQ(reference.at(reference.duration()), to);
    EXPECT_EQ(reference.at(reference.duration() / 2), 0);
    const double v = 2.0 / paper_resolution;  // counts/s, after 0.03 s
    EXPECT_NEAR(static_cast<double>(std::abs(reference.at(1000.0) + to)), v * (1000.0 - 0.015), 1.0);
  }
}

// A record is straight between its rows, and lasts after its last one; its rates are central differences.
TEST(Reference, ARecordIsStraightBetweenItsRows) {
  testing::Draws draw(8);
  for (int i = 0; i < 300; ++i) {
    ReferenceRecord record;
    for (int row = 0; row < 12; ++row) {
      record.time.push_back(row == 0 ? 0.0 : record.time.back() + draw.uniform(1e-3, 2e-3));
      record.position.push_back(draw.uniform(-1e-2, 1e-2));
    }
    ReferenceProfile profile;
    profile.shape = ReferenceShape::record;
    profile.record = std::make_shared<const ReferenceRecord>(record);
    const Reference reference(profile, 0, 0, paper_resolution);
    EXPECT_TRUE(reference.moves_for_ever());
    const auto row = static_cast<std::size_t>(draw.integer(1, 9));
    const double t0 = record.time[row], t1 = record.time[row + 1];
    const double x0 = record.position[row], x1 = record.position[row + 1];
    const double t = draw.uniform(t0, t1);
    const double exact = (x0 + (x1 - x0) * (t - t0) / (t1 - t0)) / paper_resolution;
    EXPECT_NEAR(reference.exact_at(t), exact, 1e-9 * std::abs(exact) + 1e-9);
    EXPECT_NEAR(static_cast<double>(reference.at(t)), exact, 0.5 + 1e-6);
    const double before = record.time[row - 1], xb = record.position[row - 1];
    const ReferenceMotion motion = reference.motion_at(t0);
    EXPECT_NEAR(motion.velocity, (x1 - xb) / (t1 - before), 1e-9 * std::abs(motion.velocity));
    const double curvature = (x1 - x0) / (t1 - t0) - (x0 - xb) / (t0 - before);
    EXPECT_NEAR(motion.acceleration, 2.0 * curvature / (t1 - before), 1e-9 * std::abs(motion.acceleration));
    EXPECT_EQ(reference.exact_at(9.0), record.position.back() / paper_resolution);
  }
}

// At its last row a record has the velocity with which it came there; after it it stands.
TEST(Reference, ARecordStandsAfterItsLastRow) {
  testing::Draws draw(9);
  for (int i = 0; i < 100; ++i) {
    const double rate = draw.log_uniform(100.0, 20000.0);
    const std::int64_t rows = draw.integer(2, 400);
    ReferenceRecord record;
    for (std::int64_t row = 0; row < rows; ++row) {
      record.time.push_back(static_cast<double>(row) / rate);
      record.position.push_back(draw.uniform(-1e-2, 1e-2));
    }
    ReferenceProfile profile{.shape = ReferenceShape::record};
    profile.record = std::make_shared<const ReferenceRecord>(record);
    const Reference reference(profile, 0, 0, paper_resolution);
    const double sample_time = 1.0 / rate;
    const auto at = [&](std::int64_t k) { return reference.motion_at(static_cast<double>(k) * sample_time); };
    const double last = (record.position[static_cast<std::size_t>(rows - 1)] -
                         record.position[static_cast<std::size_t>(rows - 2)]) *
                        rate;
    EXPECT_NEAR(at(rows - 1).velocity, last, 1e-6 * std::abs(last));
    EXPECT_NEAR(at(rows - 1).acceleration, 0.0, 1e-8 * rate * rate);
    for (const std::int64_t k : {rows, rows + 1, 10 * rows}) {
      EXPECT_EQ(at(k).velocity, 0.0) << rows << " rows, sample " << k;
      EXPECT_EQ(at(k).acceleration, 0.0);
      EXPECT_EQ(reference.exact_at(static_cast<double>(k) * sample_time),
                record.position.back() / paper_resolution);
    }
    EXPECT_EQ(std::llround(record_duration(record.time, sample_time) * rate), rows);
  }
}

// Half a count goes to the even one: with a count of 1 rad, 0.5 is 0 and 1.5 is 2.
TEST(Reference, ARecordIsRoundedHalfToEven) {
  ReferenceProfile profile{.shape = ReferenceShape::record};
  profile.record =
      std::make_shared<const ReferenceRecord>(ReferenceRecord{{0.0, 1.0, 2.0}, {0.5, 1.5, -2.5}});
  const Reference reference(profile, 0, 0, 1.0);
  EXPECT_EQ(reference.at(0.0), 0);
  EXPECT_EQ(reference.at(1.0), 2);
  EXPECT_EQ(reference.at(2.0), -2);
}

}  // namespace
}  // namespace zerocount::loop
