// Torques that depend on the position: gravity and cogging are found, named and covered by the intervals.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "analysis/record/sliding_identification/sliding_identification.hpp"
#include "tests/analysis/record/sliding_identification/coverage.hpp"
#include "tests/analysis/record/sliding_identification/records.hpp"

namespace zerocount::testing {
namespace {

using sliding_identification::SlidingIdentification;

/// A random rotary axis of the size of the EMPS benchmark that swings by up to a radian under gravity.
SlidingAxis joint(std::mt19937_64& random) {
  SlidingAxis axis;
  axis.rotary = true;
  axis.mass *= uniform(random, 0.5, 1.5);
  axis.damping *= uniform(random, 0.2, 0.6);
  axis.coulomb *= uniform(random, 0.5, 1.5);
  axis.breakaway = axis.coulomb;
  axis.offset = uniform(random, -10.0, 10.0);
  axis.ripple.push_back({uniform(random, 20.0, 100.0), 1.0, uniform(random, -3.0, 3.0)});
  return axis;
}

std::vector<Cruise> swings() {
  return {{0.4, 1.0}, {-0.6, 1.2}, {0.8, 0.8}, {-0.3, 1.5}, {0.5, 0.6}, {-0.7, 0.7}};
}

AxisLoop joint_loop() {
  AxisLoop loop;
  loop.resolution = 1.2e-6;
  return loop;
}

SlidingIdentification identified(const SlidingAxis& axis, std::mt19937_64& random, double pitch = 0.0) {
  return sliding_identification::identify_sliding({sliding_identification::sliding_record(
      closed_loop_record(axis, joint_loop(), swings(), 1, random), pitch)});
}

/// Number of confidence intervals that contain the true value, and number of estimated parameters.
struct Held {
  int held{0};
  int estimated{0};

  void add(const SlidingIdentification& found, const std::string& name, double truth) {
    const fit::ParameterEstimate* one = estimate(found, name);
    if (one == nullptr || !is_estimated(*one)) return;
    ++estimated;
    held += one->low <= truth && truth <= one->high ? 1 : 0;
  }
};

void expect_gravity_and_ripple_covered(int axes) {
  Held held;
  for (int i = 0; i < axes; ++i) {
    std::mt19937_64 random(static_cast<std::uint64_t>(i) + 40);
    SlidingAxis axis = joint(random);
    const double periods = std::round(uniform(random, 5.0, 60.0));
    if (i % 2 == 1) axis.ripple.push_back({uniform(random, 1.0, 5.0), periods, uniform(random, -3.0, 3.0)});
    const SlidingIdentification found = identified(axis, random);
    EXPECT_EQ(reason_of_distrust(found), "") << i;
    ASSERT_EQ(found.waves.size(), axis.ripple.size()) << i;
    EXPECT_EQ(found.waves.front().periods, 1.0) << i;
    const fit::ParameterEstimate* inertia = estimate(found, "inertia");
    ASSERT_TRUE(inertia != nullptr && is_estimated(*inertia)) << i;
    EXPECT_NEAR(inertia->value, axis.mass, 0.01 * axis.mass) << i;
    // The identified axis moves under the recorded torque as the axis did.
    EXPECT_LT(found.runs.front().rms, 0.05 * found.runs.front().stroke) << i;
    held.add(found, "inertia", axis.mass);
    held.add(found, "sliding_damping", axis.damping);
    held.add(found, "coulomb_level", axis.coulomb);
    held.add(found, "offset", axis.offset);
    held.add(found, "ripple.1.amplitude", axis.ripple.front().amplitude);
    if (axis.ripple.size() == 1) continue;
    EXPECT_EQ(found.waves.back().periods, periods) << i;
    held.add(found, name_of(found.waves.back()) + ".amplitude", axis.ripple.back().amplitude);
  }
  EXPECT_GE(held.held, least_expected(held.estimated));
  EXPECT_GE(held.estimated, 4 * axes);
}

TEST(PositionTorque, GravityAndRippleAreFoundAndCovered) {
  expect_gravity_and_ripple_covered(2);
}

TEST(PositionTorque, DISABLED_GravityAndRippleAreCoveredForManyAxes) {
  expect_gravity_and_ripple_covered(40);
}

TEST(PositionTorque, IsNotFoundIfThereIsNone) {
  for (int i = 0; i < 1; ++i) {
    std::mt19937_64 random(static_cast<std::uint64_t>(i) + 80);
    SlidingAxis axis = joint(random);
    axis.ripple.clear();
    const SlidingIdentification found = identified(axis, random);
    EXPECT_TRUE(found.waves.empty()) << i;
    EXPECT_EQ(reason_of_distrust(found), "") << i;
  }
}

// A force that repeats with a pitch that nobody gave is no slope, and the answer says so.
TEST(PositionTorque, AnUnknownPitchMakesTheResultUntrusted) {
  std::mt19937_64 random(7);
  SlidingAxis axis = joint(random);
  axis.rotary = false;
  axis.ripple = {{6.0, 15.0, 0.3}};
  const SlidingIdentification unknown = identified(axis, random);
  EXPECT_NE(reason_of_distrust(unknown), "");
  const SlidingIdentification known = identified(axis, random, 2.0 * std::numbers::pi / 15.0);
  EXPECT_EQ(reason_of_distrust(known), "");
  const fit::ParameterEstimate* amplitude = estimate(known, "ripple.1.amplitude");
  ASSERT_TRUE(amplitude != nullptr && is_estimated(*amplitude));
  EXPECT_NEAR(amplitude->value, 6.0, 0.1);
  EXPECT_NE(known.fragment.find("pitch: 0.4188"), std::string::npos) << known.fragment;
}

}  // namespace
}  // namespace zerocount::testing
