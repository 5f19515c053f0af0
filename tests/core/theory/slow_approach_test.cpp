// A slow integral control: the time that it takes to its target, against closed forms and trials.
#include "core/theory/slow_approach.hpp"

#include "core/loop/encoder.hpp"
#include "core/theory/sampled_stability.hpp"
#include "core/theory/shortest_move.hpp"
#include "core/trial/trial.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/test.hpp"

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

// The shortest move under bounded torque, against closed forms and a stepwise integration.

TEST(ShortestMove, WithoutDampingIsTwoParabolas) {
  testing::RandomBlocks draw(3);
  for (int i = 0; i < 100; ++i) {
    const DrivenAxis axis{draw.log_uniform(1e-9, 1e7), 0.0, draw.log_uniform(1e-6, 1e6), 1.0};
    const double distance = draw.log_uniform(1e-9, 10.0);
    const DrivenAxis even{axis.inertia, 0.0, axis.driving, axis.driving};
    const double time = 2.0 * std::sqrt(distance * axis.inertia / axis.driving);
    EXPECT_NEAR(shortest_move(even, distance) / time, 1.0, 1e-4);
    const double uneven =
        std::sqrt(2.0 * distance * axis.inertia * (1.0 / axis.driving + 1.0 / axis.braking));
    EXPECT_NEAR(shortest_move(axis, distance) / uneven, 1.0, 1e-4);
  }
}

TEST(ShortestMove, WithDampingIsThatOfAnIntegrationWhichBrakesInTime) {
  testing::RandomBlocks draw(4);
  for (int i = 0; i < 20; ++i) {
    const DrivenAxis axis{1.0, draw.log_uniform(0.05, 20.0), draw.log_uniform(0.3, 3.0),
                          draw.log_uniform(0.3, 3.0)};
    const double distance = draw.log_uniform(0.1, 10.0);
    const double time = shortest_move(axis, distance);
    // Drives as long as a brake from the present velocity still stops before the target.
    constexpr int steps = 20000;
    const double dt = time / steps;
    double x = 0.0;
    double v = 0.0;
    double t = 0.0;
    const auto braking_travel = [&](double velocity) {
      const double c = axis.damping;
      return velocity / c - axis.braking / (c * c) * std::log1p(velocity * c / axis.braking);
    };
    while (x + braking_travel(v) < distance) {
      v += dt * (axis.driving - axis.damping * v);
      x += dt * v;
      t += dt;
    }
    t += std::log1p(v * axis.damping / axis.braking) / axis.damping;
    EXPECT_NEAR(t / time, 1.0, 2e-3) << axis.damping << " " << distance;
  }
}

TEST(ShortestMove, IsInfiniteWithoutTorque) {
  EXPECT_TRUE(std::isinf(shortest_move({1.0, 0.1, 0.0, 1.0}, 1.0)));
  EXPECT_TRUE(std::isinf(shortest_move({1.0, 0.1, 1.0, -1.0}, 1.0)));
}

}  // namespace
}  // namespace zerocount::theory
