// The course of a first-order amplifier: its value, its rest, its instants and its series.
#include "core/motion/torque_course.hpp"

#include "tests/support/test.hpp"

namespace zerocount::motion {
namespace {

const TorqueCourse rising{-0.05, 0.3, 2000.0};

double exact(const TorqueCourse& course, double t) {
  return course.settled + (course.now - course.settled) * std::exp(-course.rate * t);
}

TEST(TorqueCourse, IsConstantWithoutRateOrDistance) {
  EXPECT_TRUE(is_constant(constant_torque(0.2)));
  EXPECT_TRUE(is_constant({0.2, 0.2, 500.0}));
  EXPECT_TRUE(is_constant({0.2, 0.3, 0.0}));
  EXPECT_FALSE(is_constant(rising));
  EXPECT_EQ(course_after({0.2, 0.3, 0.0}, 1.0).now, 0.2);
}

TEST(TorqueCourse, ContinuesConsistentlyInPieces) {
  for (const double t : {0.0, 1e-9, 1e-4, 1e-3, 1e-2}) {
    const TorqueCourse rest = course_after(rising, t);
    EXPECT_NEAR(rest.now, exact(rising, t), 1e-16);
    EXPECT_NEAR(course_after(rest, 3e-4).now, exact(rising, t + 3e-4), 2e-16);
  }
  EXPECT_EQ(course_after(rising, 0.0).now, rising.now);
}

TEST(TorqueCourse, KnowsWhenATorqueIsReached) {
  for (const double torque : {-0.05, -0.049, 0.0, 0.1, 0.299})
    EXPECT_NEAR(exact(rising, time_until(rising, torque)), torque, 1e-15);
  EXPECT_EQ(time_until(rising, -0.06), 0.0);  // has been
  EXPECT_TRUE(std::isinf(time_until(rising, 0.3)));
  EXPECT_TRUE(std::isinf(time_until(rising, 0.31)));
  EXPECT_TRUE(std::isinf(time_until(constant_torque(0.1), 0.2)));
  EXPECT_EQ(time_until(constant_torque(0.1), 0.1), 0.0);
}

TEST(TorqueCourse, SeriesMatchesTheExponential) {
  const numerics::Series series = torque_series(rising);
  for (const double t : {1e-5, 1e-4, 2e-4})
    EXPECT_NEAR(numerics::value_at(series, t), exact(rising, t), 1e-15);
  const numerics::Series constant = torque_series(constant_torque(0.1));
  EXPECT_EQ(constant[0], 0.1);
  for (std::size_t k = 1; k <= numerics::series_order; ++k) EXPECT_EQ(constant[k], 0.0);
}

TEST(TorqueCourse, MirrorsBitForBit) {
  const TorqueCourse falling{-rising.now, -rising.settled, rising.rate};
  for (const double t : {1e-6, 1e-4, 1e-2})
    EXPECT_EQ(course_after(falling, t).now, -course_after(rising, t).now);
  EXPECT_EQ(time_until(falling, -0.1), time_until(rising, 0.1));
}

}  // namespace
}  // namespace zerocount::motion
