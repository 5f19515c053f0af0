// The PID control: trapezoidal integral, start values, anti-windup.
#include "core/loop/pid.hpp"

#include <random>

#include <gtest/gtest.h>

namespace zerocount {
namespace {

constexpr double wide = 1e9;

TEST(Pid, FirstSampleAddsHalfATrapezium) {
  PidController pid({.ki = 2.0}, -wide, wide);
  EXPECT_EQ(pid.update(5, 0), 10.0);  // e was 0 before the first sample
  EXPECT_EQ(pid.update(5, 0), 30.0);  // + 2·(5 + 5)
  EXPECT_EQ(pid.update(5, 5), 40.0);  // + 2·(0 + 5)
  EXPECT_EQ(pid.update(5, 5), 40.0);
}

TEST(Pid, CountLeavingTheTargetForOneSampleTakesTwoStepsOfTheGain) {
  // Paper, issue 6: "the integral is decreased by 2·k_ID in two consecutive sampling instants".
  PidController pid({.ki = 0.25}, -wide, wide);
  const double before = pid.update(0, 0);
  EXPECT_EQ(pid.update(0, 1), before - 0.25);
  EXPECT_EQ(pid.update(0, 0), before - 0.5);
}

TEST(Pid, ProportionalAndDifferenceAct) {
  PidController pid({.kp = 3.0, .ki = 0.0, .kd = 0.5}, -wide, wide);
  EXPECT_EQ(pid.update(10, 4), 18.0);  // the count before the first is the first
  EXPECT_EQ(pid.update(10, 6), 3.0 * 4 - 0.5 * 2);
  EXPECT_EQ(pid.update(10, 6), 12.0);
}

TEST(Pid, IntegralIsTheTrapezoidalSumOfTheErrors) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> count(-20, 20);
  PidController pid({.ki = 1.0 / 1024.0}, -wide, wide);
  double sum = 0.0;
  std::int64_t last = 0;
  for (int k = 0; k < 500; ++k) {
    const std::int64_t error = 7 - count(random);
    sum += static_cast<double>(error + last) / 1024.0;
    last = error;
    EXPECT_EQ(pid.update(7, 7 - error), sum);
  }
}

TEST(Pid, ClampHoldsTheIntegralInTheRangeOfTheDac) {
  PidController clamped({.ki = 1.0}, -8.0, 7.0);
  PidController free({.ki = 1.0, .anti_windup = AntiWindup::none}, -8.0, 7.0);
  for (int k = 0; k < 10; ++k) {
    clamped.update(4, 0);
    free.update(4, 0);
  }
  EXPECT_EQ(clamped.integral(), 7.0);
  EXPECT_EQ(free.integral(), 76.0);
  for (int k = 0; k < 10; ++k) clamped.update(-4, 0);
  EXPECT_EQ(clamped.integral(), -8.0);
}

}  // namespace
}  // namespace zerocount
