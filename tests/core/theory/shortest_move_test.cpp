// The shortest move under bounded torque, against closed forms and a stepwise integration.
#include "core/theory/shortest_move.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/core/loop/random_blocks.hpp"

namespace zerocount::theory {
namespace {

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
