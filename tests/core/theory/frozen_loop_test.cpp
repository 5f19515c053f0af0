// Poles of the closed loop, and what becomes of their motions within a move.
#include "core/theory/frozen_loop.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/theory/gains.hpp"
#include "tests/core/loop/random_blocks.hpp"

namespace zerocount::theory {
namespace {

// About a stiff contact an integral takes the time constant (k + kP)/kI, far beyond any hold. That is slow,
// and not marginal, as long as the motion changes by a thousandth within the hold.
TEST(LoopStability, OfASlowPoleIsStable) {
  testing::RandomBlocks draw(31);
  for (int i = 0; i < 50; ++i) {
    const motion::PlantParameters plant{.inertia = draw.log_uniform(1e-4, 1.0)};
    const double stiffness = plant.inertia * draw.log_uniform(1e5, 1e7);
    const double damping = 2.0 * draw.log_uniform(0.3, 2.0) * std::sqrt(stiffness * plant.inertia);
    const double hold = draw.log_uniform(1.0, 100.0);
    const AnalogueGains gains{1e-3 * stiffness, stiffness / hold * draw.log_uniform(3e-3, 1.0), 0.0};
    loop::ControllerParameters controller;
    controller.sample_rate = 4000.0;
    controller = with_analogue_gains(controller, gains, {});
    const FrozenLoop loop = frozen_loop(stiffness, damping, plant, {}, controller);
    EXPECT_EQ(stability_of(loop, hold), LoopStability::stable) << i;
    const double tau = (stiffness + gains.kp) / gains.ki;
    EXPECT_NEAR(slowest_time_constant(poles_of(loop), loop.sample_time), tau, 0.01 * tau) << i;
  }
}

TEST(LoopStability, IsJudgedByWhatChangesWithinTheHold) {
  Eigen::VectorXcd poles(2);
  const double T = 1e-3;
  const auto stability = [&](double rate, double hold) {  // rate of growth, 1/s
    poles << 0.5, std::polar(std::exp(rate * T), 0.3);
    return stability_of(poles, T, hold);
  };
  for (const double hold : {0.5, 30.0}) {
    EXPECT_EQ(stability(2e-3 / hold, hold), LoopStability::unstable);
    EXPECT_EQ(stability(5e-4 / hold, hold), LoopStability::marginal);
    EXPECT_EQ(stability(0.0, hold), LoopStability::marginal);
    EXPECT_EQ(stability(-5e-4 / hold, hold), LoopStability::marginal);
    EXPECT_EQ(stability(-2e-3 / hold, hold), LoopStability::stable);
  }
}

// A free mass without control: a double eigenvalue of 1, which rounds.
TEST(LoopStability, OfAFreeMassIsMarginal) {
  testing::RandomBlocks draw(32);
  for (int i = 0; i < 50; ++i) {
    const motion::PlantParameters plant{.inertia = draw.log_uniform(1e-5, 10.0)};
    loop::ControllerParameters controller;
    controller.sample_rate = draw.log_uniform(500.0, 20000.0);
    controller.ki = 0.0;
    controller.delay = i % 5 / 2.0;
    const FrozenLoop loop = frozen_loop(0.0, 0.0, plant, {}, controller);
    EXPECT_EQ(stability_of(loop, draw.log_uniform(0.1, 100.0)), LoopStability::marginal) << i;
  }
}

}  // namespace
}  // namespace zerocount::theory
