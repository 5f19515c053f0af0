// The torque between two commanded levels: a constant rate, sampled, that ends at the level itself.

#include "core/trial/torque_ramp.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/trial/parameters.hpp"

namespace zerocount::trial {
namespace {

struct RandomRamp {
  double from, to, rate, sample_rate;
};

RandomRamp random_ramp(std::mt19937& random) {
  std::uniform_real_distribution<double> level(-0.3, 0.3);
  std::uniform_real_distribution<double> decade(-2.0, 1.0);
  return {level(random), level(random), std::pow(10.0, decade(random)), 2000.0};
}

TEST(TorqueRamp, RisesAtTheRateFromTheFirstSampleAndEndsAtTheLevel) {
  std::mt19937 random(20020721);
  for (int i = 0; i < 1000; ++i) {
    const RandomRamp r = random_ramp(random);
    const TorqueRamp ramp = make_torque_ramp(r.from, r.to, r.rate, r.sample_rate);
    const double step = r.rate / r.sample_rate;
    EXPECT_EQ(torque_at(ramp, 0), r.from);
    EXPECT_EQ(torque_at(ramp, ramp.samples), r.to);
    EXPECT_EQ(torque_at(ramp, ramp.samples + 12345), r.to);
    for (std::int64_t k = 0; k < ramp.samples; ++k) {
      const double change = torque_at(ramp, k + 1) - torque_at(ramp, k);
      const bool last = k + 1 == ramp.samples;
      EXPECT_GE(change * (r.to - r.from), 0.0);
      EXPECT_LE(std::abs(change), step * (1.0 + 1e-6));
      if (!last) {
        EXPECT_NEAR(std::abs(change), step, 1e-12);
      }
    }
  }
}

TEST(TorqueRamp, TakesTheTimeThatTheRateAsksRoundedUpToSamples) {
  EXPECT_EQ(make_torque_ramp(0.0, 0.1, 0.1, 2000.0).samples, 2000);
  EXPECT_EQ(make_torque_ramp(0.1, -0.2, 0.3, 2000.0).samples, 2000);  // whole, though 0.1 + 0.2 is not 0.3
  EXPECT_EQ(make_torque_ramp(0.0, 0.10001, 0.1, 2000.0).samples, 2001);
  EXPECT_EQ(make_torque_ramp(0.1, 0.1, 0.1, 2000.0).samples, 0);
}

TEST(TorqueRamp, MirrorsWithTheSignOfTheLevels) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const RandomRamp r = random_ramp(random);
    const TorqueRamp ramp = make_torque_ramp(r.from, r.to, r.rate, r.sample_rate);
    const TorqueRamp mirror = make_torque_ramp(-r.from, -r.to, r.rate, r.sample_rate);
    ASSERT_EQ(mirror.samples, ramp.samples);
    for (std::int64_t k = 0; k <= ramp.samples; ++k) EXPECT_EQ(torque_at(mirror, k), -torque_at(ramp, k));
  }
}

// A level's move is the way to it and then the hold.
TEST(TorqueRamp, IsPartOfTheMoveOfItsLevel) {
  TrialParameters parameters;
  parameters.command.torque.levels = {0.1, 0.1, -0.1};
  parameters.command.torque.rate = 0.2;
  parameters.command.hold = 0.25;
  EXPECT_EQ(move_count(parameters), 3U);
  EXPECT_EQ(samples_of_move(parameters, 0), 1000 + 500);
  EXPECT_EQ(samples_of_move(parameters, 1), 500);
  EXPECT_EQ(samples_of_move(parameters, 2), 2000 + 500);
  EXPECT_EQ(samples_of_trial(parameters), 4500);
}

}  // namespace
}  // namespace zerocount::trial
