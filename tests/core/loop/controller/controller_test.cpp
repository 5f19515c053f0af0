// The control in two phases; its law is judged by judge_controller.py and the trials of
// widened_trial_test.cpp.
#include "core/loop/controller/controller.hpp"

#include "core/loop/controller/count_difference.hpp"
#include "core/loop/controller/integrator.hpp"
#include "tests/support/test.hpp"

namespace zerocount::loop {
namespace {

constexpr double lowest = -0.49;
constexpr double highest = 0.48;

TEST(Controller, StaysInTheCoarsePhaseWithADwellLongerThanAnyTrial) {
  for (const double time : {1e15, 1e17, 1e300}) {
    ControllerParameters p;
    p.coarse.coarse_beyond = 50.0;
    p.coarse.fine_dwell = time;
    Controller controller(p, {18.75}, 0.0, {{lowest, highest}});
    controller.update(0, {60, 3}, 0.0);
    for (int k = 0; k < 100; ++k) {
      controller.update(0, {0, 0}, 0.0);
      ASSERT_EQ(controller.phase(), ControlPhase::coarse);
    }
  }
}

// When the integral changes: deadband with hysteresis, zone, leak; and what the difference of counts is
// behind its filter.

constexpr TorqueRange any_torque{-1e9, 1e9};

/// I after each of the errors, with an increment of 1 at each sample.
std::vector<double> integrals(const ControlBlocks& blocks, const std::vector<double>& errors) {
  Integrator integrator(integral_constants(blocks, 1000.0, any_torque), 0.0);
  std::vector<double> all;
  for (const double error : errors) all.push_back(integrator.add(error, 1.0));
  return all;
}

using Integrals = std::vector<double>;

TEST(Integrator, StaysInsideTheDeadband) {
  EXPECT_EQ(integrals({.deadband = {1, -1}}, {2, 1, -1, 0, -2, 2}), (Integrals{1, 1, 1, 1, 2, 3}));
  EXPECT_EQ(integrals({.deadband = {0, -1}}, {1, 0, 0, -1}), (Integrals{1, 1, 1, 2}));
  EXPECT_EQ(integrals({}, {0, 0, 5}), (Integrals{1, 2, 3}));
}

TEST(Integrator, LeavesTheDeadbandLaterThanItEntersIt) {
  const Integrals expected{1, 2, 2, 2, 2, 3, 4, 4};
  EXPECT_EQ(integrals({.deadband = {1, 2}}, {3, 2, 1, 2, -2, 3, 2, 0}), expected);
}

TEST(Integrator, ChangesOnlyWithinItsZone) {
  EXPECT_EQ(integrals({.integrator_zone = 2}, {3, 2, -2, -3, 0}), (Integrals{0, 1, 2, 2, 3}));
}

TEST(Integrator, LeaksToTheLevelOfItsIncrements) {
  ControlBlocks blocks;
  blocks.integrator_leak = 0.05;
  Integrator integrator(integral_constants(blocks, 1000.0, any_torque), 3.0);
  for (int k = 1; k <= 100; ++k) {
    EXPECT_NEAR(integrator.add(1.0, 0.0), 3.0 * std::exp(-0.001 * k / 0.05), 1e-14);
  }
  for (int k = 0; k < 5000; ++k) integrator.add(1.0, 1.0);
  EXPECT_NEAR(integrator.value(), 1.0 / -std::expm1(-0.001 / 0.05), 1e-9);
}

TEST(Integrator, RemembersTheDeadbandThroughSamplesThatAnotherLawDecides) {
  Integrator integrator(integral_constants({.deadband = {1, 3}}, 1000.0, any_torque), 0.0);
  integrator.observe(1.0);
  EXPECT_EQ(integrator.add(3.0, 1.0), 0.0);
  integrator.observe(4.0);
  EXPECT_EQ(integrator.add(3.0, 1.0), 1.0);
}

TEST(CountDifference, AnswersAStepWithAnExponential) {
  ControlBlocks blocks;
  blocks.derivative_cutoff = 30.0;
  const double a = std::exp(-2.0 * std::numbers::pi * 30.0 / 1000.0);
  CountDifference difference(derivative_pole(blocks, 1000.0));
  EXPECT_EQ(difference.step(7.0), 0.0);  // the count before the first is the first
  for (int k = 0; k < 50; ++k) EXPECT_NEAR(difference.step(17.0), 10.0 * (1.0 - a) * std::pow(a, k), 1e-14);
}

TEST(CountDifference, WithoutAFilterIsTheDifferenceBitForBit) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 100.0);
  CountDifference difference(derivative_pole({}, 1000.0));
  double last = normal(random);
  difference.step(last);
  for (int k = 0; k < 100; ++k) {
    const double count = normal(random);
    ASSERT_EQ(difference.step(count), count - last);
    last = count;
  }
}

}  // namespace
}  // namespace zerocount::loop
