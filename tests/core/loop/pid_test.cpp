// The PID law: trapezoidal integral, start values, anti-windup, samples at which another law decides.
#include "core/loop/pid.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace zerocount::loop {
namespace {

constexpr TorqueRange wide{-1e9, 1e9};

/// The torque at a sample with this target and count.
double decide(Pid& pid, double target, double count) {
  return pid.step({target - count, count});
}

TEST(Pid, FirstSampleAddsHalfATrapezium) {
  Pid pid({.ki = 2.0}, 0.0, wide);
  EXPECT_EQ(decide(pid, 5, 0), 10.0);  // e was 0 before the first sample
  EXPECT_EQ(decide(pid, 5, 0), 30.0);  // + 2·(5 + 5)
  EXPECT_EQ(decide(pid, 5, 5), 40.0);  // + 2·(0 + 5)
  EXPECT_EQ(decide(pid, 5, 5), 40.0);
}

TEST(Pid, CountLeavingTheTargetForOneSampleTakesTwoStepsOfTheGain) {
  // Paper, issue 6: "the integral is decreased by 2·k_ID in two consecutive sampling instants".
  Pid pid({.ki = 0.25}, 0.0, wide);
  const double before = decide(pid, 0, 0);
  EXPECT_EQ(decide(pid, 0, 1), before - 0.25);
  EXPECT_EQ(decide(pid, 0, 0), before - 0.5);
}

TEST(Pid, ProportionalAndDifferenceAct) {
  Pid pid({.kp = 3.0, .kd = 0.5}, 0.0, wide);
  EXPECT_EQ(decide(pid, 10, 4), 18.0);  // the count before the first is the first
  EXPECT_EQ(decide(pid, 10, 6), 3.0 * 4 - 0.5 * 2);
  EXPECT_EQ(decide(pid, 10, 6), 12.0);
}

TEST(Pid, IntegralIsTheTrapezoidalSumOfTheErrors) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> count(-20, 20);
  Pid pid({.ki = 1.0 / 1024.0}, 0.0, wide);
  double sum = 0.0;
  int last = 0;
  for (int k = 0; k < 500; ++k) {
    const int error = 7 - count(random);
    sum += (error + last) / 1024.0;
    last = error;
    EXPECT_EQ(decide(pid, 7, 7 - error), sum);
  }
}

TEST(Pid, IntegralGoesOnFromItsPreset) {
  Pid pid({.ki = 1.0}, 0.5, wide);
  EXPECT_EQ(pid.integral(), 0.5);
  EXPECT_EQ(decide(pid, 3, 0), 3.5);
  pid.take_over(-0.25);
  EXPECT_EQ(decide(pid, 3, 0), 5.75);  // the last error is still known
}

TEST(Pid, IntegralStaysInItsRange) {
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  Pid clamped({.ki = 1.0}, 0.0, {-8.0, 7.0});
  Pid free({.ki = 1.0}, 0.0, {-unbounded, unbounded});
  for (int k = 0; k < 10; ++k) {
    decide(clamped, 4, 0);
    decide(free, 4, 0);
  }
  EXPECT_EQ(clamped.integral(), 7.0);
  EXPECT_EQ(free.integral(), 76.0);
  for (int k = 0; k < 10; ++k) decide(clamped, -4, 0);
  EXPECT_EQ(clamped.integral(), -8.0);
}

TEST(Pid, ObservedSampleIsTheOneBeforeTheNext) {
  Pid pid({.ki = 1.0, .kd = 0.5}, 10.0, wide);
  pid.observe({100.0, -30.0});
  EXPECT_EQ(pid.integral(), 10.0);
  EXPECT_EQ(pid.step({4.0, 2.0}), 10.0 + (4.0 + 100.0) - 0.5 * 32.0);
}

}  // namespace
}  // namespace zerocount::loop
