// A slow integral control: the time that it takes to its target, against closed forms and trials.
#include "core/theory/slow_approach.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/loop/encoder.hpp"
#include "core/theory/sampled_stability.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::theory {
namespace {

trial::TrialParameters slow_rig(double ki, double kp = 0.0) {
  trial::TrialParameters p;
  p.controller.ki = ki;
  p.controller.kp = kp;
  return p;
}

TEST(SlowApproach, HasTheTimeConstantOfTheSampledLoop) {
  for (const double kp : {0.0, 3.0e-4, 2.0e-3}) {
    for (const double stiffness : {110.0, 400.0, 860.0}) {
      const trial::TrialParameters p = slow_rig(1.0e-7, kp);
      const double sampled = slowest_time_constant(stiffness, p.plant, p.encoder, p.controller);
      EXPECT_NEAR(slow_time_constant(stiffness, p.encoder, p.controller), sampled, 0.01 * sampled)
          << kp << " " << stiffness;
    }
  }
}

TEST(SlowApproach, IsAnExponentialWhereTheSpringDoesNotSoften) {
  const trial::TrialParameters p = slow_rig(1.0e-6);
  friction::FrictionParameters contact;
  const auto exponential = [&](double stiffness, double step) {
    return slow_time_constant(stiffness, p.encoder, p.controller) * std::log(2.0 * step);
  };
  for (const std::int64_t step : {1, 2, 30, 405'000}) {
    const auto counts = static_cast<double>(step);
    contact.beta = 1.0e-9;
    const double stiff = slow_arrival_time(step, contact, p.encoder, p.controller);
    EXPECT_NEAR(stiff, exponential(contact.k1 + contact.k2, counts), 1e-6 * stiff);
    contact.beta = 1.0e12;
    const double soft = slow_arrival_time(step, contact, p.encoder, p.controller);
    EXPECT_NEAR(soft, exponential(contact.k1, counts), 0.2 * soft);  // but for the moment of the reversal
    contact.beta = 1.0e5;
    const double softening = slow_arrival_time(step, contact, p.encoder, p.controller);
    EXPECT_GE(softening, soft);
    EXPECT_LT(softening, stiff);
  }
}

// Moves of the paper's rig that reverse the motion, as the formula supposes.
TEST(SlowApproach, TellsWhenTrialsArrive) {
  for (const double ki : {2.0e-7, 1.0e-6}) {
    for (const std::int64_t step : {2, 5, 12, 30}) {
      trial::TrialParameters p = slow_rig(ki);
      p.friction.uniform.alpha = 0.0;
      const double expected = slow_arrival_time(step, p.friction.uniform, p.encoder, p.controller);
      p.command.targets = {60, 60 - step};
      p.command.hold = 20.0 * slow_time_constant(860.0, p.encoder, p.controller);
      const double time = trial::run_trial(p).moves[1].settling_time;
      EXPECT_GT(expected, 0.7 * time) << ki << " " << step;
      EXPECT_LT(expected, 1.5 * time) << ki << " " << step;
    }
  }
}

TEST(ChatterTime, IsThatOfTheIntegralThatTakesOverFromTheProportionalGain) {
  const trial::TrialParameters p = slow_rig(1.0e-6, 1.0e-3);
  const friction::FrictionParameters& contact = p.friction.uniform;
  const double decay = 1.0e-3 / (2.0 * 1.0e-6 * 2000.0);
  const double frequency = 198.3;  // Hz, of the paper's rig
  EXPECT_NEAR(chatter_time(p.plant, contact, p.controller, 0.05), decay * std::log(frequency * 0.05),
              1e-3 * decay);
  EXPECT_EQ(chatter_time(p.plant, contact, p.controller, 0.001), 0.0);
  EXPECT_EQ(chatter_time(p.plant, contact, slow_rig(1.0e-6).controller, 0.05), 0.0);
}

}  // namespace
}  // namespace zerocount::theory
