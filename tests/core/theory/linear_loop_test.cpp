// The linear loop assembled from the blocks of a controller, with blocks that only the tests know.
#include "core/theory/linear_loop.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <deque>
#include <numbers>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "core/loop/controller/control_chain.hpp"
#include "tests/core/loop/test_blocks.hpp"

namespace zerocount::theory {
namespace {

constexpr loop::ControlStart wide{0.0, {-1e300, 1e300}, 2.0 * std::numbers::pi / 1'620'000};

HeldPlant paper_rig(double delay) {
  return hold_plant(300.0, 0.2, {}, 2.0 * std::numbers::pi / 1'620'000, 5e-4, {1.1, 400.0}, delay);
}

/// Growth per sample of the loop run with the blocks' own `step`.
template <class Chain>
double growth_in_time(Chain chain, const HeldPlant& plant) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(plant.A.rows());
  x(0) = 10.0;
  std::deque<double> pending(static_cast<std::size_t>(plant.delay + 1), 0.0);
  double in_force = 0.0;
  const auto largest_of_next = [&](int samples) {
    double largest = 0.0;
    for (int k = 0; k < samples; ++k) {
      in_force = chain.step({-x(0), x(0), in_force});
      pending.push_back(in_force);
      x = plant.A * x + plant.b_before * pending[0] + plant.b * pending[1];
      pending.pop_front();
      largest = std::max(largest, std::abs(x(0)) + std::abs(x(1)));
    }
    return largest;
  };
  constexpr int window = 2000;
  largest_of_next(window);  // the transient of the other eigenvalues
  const double early = largest_of_next(window);
  largest_of_next(4 * window);
  return std::pow(largest_of_next(window) / early, 1.0 / (5 * window));
}

template <class Chain>
void expect_growth(const loop::ControllerParameters& parameters) {
  const Chain chain(parameters, wide);
  for (const double delay : {0.0, 0.4, 1.0, 2.7, 3.0}) {
    const HeldPlant plant = paper_rig(delay);
    // The phase of the oscillation at the ends of the windows is worth some 1e-5.
    EXPECT_NEAR(spectral_radius(plant, chain.linear()), growth_in_time(Chain(parameters, wide), plant), 5e-5);
    // Every mode of the loop is a root of 1 + L(z).
    for (const std::complex<double> z : loop_map(plant, chain.linear()).eigenvalues()) {
      if (std::abs(z) < 0.1) continue;
      EXPECT_LT(std::abs(1.0 + OpenLoop(plant, chain.linear()).at(z)), 1e-7) << z;
    }
  }
}

TEST(LinearLoop, GrowsAsTheLoopDoesInTime) {
  const loop::ControllerParameters parameters{.kp = 1e-4, .ki = 1.4e-4, .kd = 1e-4};
  expect_growth<loop::BlockChain<loop::Pid>>(parameters);
  expect_growth<loop::BlockChain<loop::Pid, LowPass>>(parameters);
  expect_growth<loop::BlockChain<loop::Pid, TorqueFeedback>>(parameters);
  expect_growth<loop::BlockChain<loop::Pid, LowPass, TorqueFeedback>>(parameters);
}

TEST(LinearLoop, GrowsAsTheLoopDoesInTimeWithEveryBlock) {
  loop::ControllerParameters parameters{.kp = 1e-4, .ki = 1.4e-4, .kd = 2e-4};
  parameters.blocks.integrator_leak = 0.05;
  parameters.blocks.derivative_cutoff = 200.0;
  parameters.blocks.observer.bandwidth = 30.0;
  parameters.blocks.filters = {{.kind = loop::FilterKind::lead, .frequency = 300.0},
                               {.kind = loop::FilterKind::notch, .frequency = 250.0}};
  expect_growth<loop::ControlChain>(parameters);
  parameters.blocks.structure = loop::ControlStructure::cascade;
  parameters.blocks.cascade = {5.0, 0.1, 10.0};
  expect_growth<loop::ControlChain>(parameters);
}

}  // namespace
}  // namespace zerocount::theory
