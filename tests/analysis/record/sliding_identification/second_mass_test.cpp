// A second mass behind a spring, of random joints that an independent integrator moved: named where it spoils
// the intervals of one mass, and not named where there is none.
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "analysis/record/sliding_identification/sliding_identification.hpp"
#include "core/failure/failure.hpp"
#include "tests/analysis/record/sliding_identification/coverage.hpp"
#include "tests/analysis/record/sliding_identification/joint_records.hpp"

namespace zerocount::testing {
namespace {

using sliding_identification::SlidingIdentification;

/// Divides the joint's inertia into two masses on a coupling with this resonance (Hz).
/// @param ratio inertia of the load over that of the motor
/// @param damping damping ratio of the resonance
void add_second_mass(Joint& joint, double ratio, double resonance, double damping) {
  const double omega = 2.0 * std::numbers::pi * resonance;
  joint.load = joint.inertia * ratio / (1.0 + ratio);
  joint.inertia -= joint.load;
  const double reduced = joint.inertia * joint.load / (joint.inertia + joint.load);
  joint.stiffness = reduced * omega * omega;
  joint.coupling_damping = 2.0 * damping * reduced * omega;
}

bool holds_inertia(const SlidingIdentification& found, double truth) {
  const fit::ParameterEstimate& one = *estimate(found, "inertia");
  return !is_estimated(one) || (one.low <= truth && truth <= one.high);
}

/// A short motion of a joint with a fine encoder, to be recorded.
JointMotion fine_joint(std::mt19937_64& random) {
  JointMotion motion{random_joint(random), {0.8, -0.4, 0.6, 0.0, 0.9, -0.7, 0.5, -0.6, 0.7, 0.0}, 3.0};
  motion.joint.excess = 0.0;
  motion.joint.sample_time = 1e-3;
  motion.joint.resolution = 2.0 * std::numbers::pi / 1e7;
  motion.joint.noise = motion.joint.resolution;
  motion.joint.gravity = motion.joint.coulomb;
  return motion;
}

TEST(SecondMass, IsNamedWithItsResonance) {
  for (int i = 0; i < 2; ++i) {
    std::mt19937_64 random(static_cast<std::uint64_t>(i) + 300);
    JointMotion motion = fine_joint(random);
    const double resonance = 25.0 + 10.0 * i;
    add_second_mass(motion.joint, 1.0, resonance, 0.05);
    const SlidingIdentification found = identified(motion, random);
    ASSERT_TRUE(found.second_mass) << i << ": " << reason_of_distrust(found);
    EXPECT_NEAR(found.second_mass->frequency, resonance, 0.2 * resonance) << i;
    EXPECT_NE(reason_of_distrust(found).find("a second mass behind a spring"), std::string::npos);
  }
}

TEST(SecondMass, IsNotNamedIfThereIsNone) {
  for (int i = 0; i < 3; ++i) {
    std::mt19937_64 random(static_cast<std::uint64_t>(i) + 320);
    const SlidingIdentification found = identified(fine_joint(random), random);
    EXPECT_FALSE(found.second_mass) << i;
    EXPECT_EQ(reason_of_distrust(found), "") << i;
  }
}

/// A fast move of a joint with strong cogging. The joint passes a period of the cogging in about 40 samples.
JointMotion cogging_joint(std::mt19937_64& random) {
  JointMotion motion = fine_joint(random);
  motion.targets = {0.9, -0.7, 0.8, -0.9};
  motion.speed = uniform(random, 3.0, 5.0);
  motion.joint.periods = std::round(uniform(random, 20.0, 60.0));
  motion.joint.ripple = motion.joint.coulomb * uniform(random, 0.2, 1.0);
  motion.joint.ripple_phase = uniform(random, -3.0, 3.0);
  return motion;
}

int second_masses_of_cogging_joints(int joints) {
  int named = 0;
  for (int i = 0; i < joints; ++i) {
    std::mt19937_64 random(static_cast<std::uint64_t>(i) + 900);
    const SlidingIdentification found = identified(cogging_joint(random), random);
    named += found.second_mass ? 1 : 0;
  }
  std::cout << "second masses named of " << joints << " joints with cogging: " << named << '\n';
  return named;
}

TEST(SecondMass, IsNotNamedForCogging) {
  EXPECT_EQ(second_masses_of_cogging_joints(2), 0);
}

TEST(SecondMass, DISABLED_IsNotNamedForCoggingOfManyJoints) {
  EXPECT_LE(second_masses_of_cogging_joints(100), 1);
}

TEST(SecondMass, DISABLED_IsNamedForManyJointsWithFewFalseAlarms) {
  constexpr int joints = 40;
  int false_alarms = 0;
  int named = 0;
  int silent = 0;  // though there are two: exit code 0
  int held = 0;    // of these
  int told = 0;    // resonances
  int right = 0;   // of these
  for (int i = 0; i < joints; ++i) {
    std::mt19937_64 random(static_cast<std::uint64_t>(i) * 7919 + 17);
    JointMotion motion = random_joint_motion(random, i % 2 == 0, false);
    if (motion.targets.size() > 6) motion.targets.resize(6);
    const double total = motion.joint.inertia;
    std::mt19937_64 other(random);
    false_alarms += identified(motion, other).second_mass ? 1 : 0;
    const double ratio = log_uniform(random, 0.1, 5.0);
    const double resonance = log_uniform(random, 8.0, 0.3 / motion.joint.sample_time);
    add_second_mass(motion.joint, ratio, resonance, log_uniform(random, 0.01, 0.3));
    try {
      const SlidingIdentification found = identified(motion, random);
      if (reason_of_distrust(found).empty()) {
        ++silent;
        held += holds_inertia(found, total) ? 1 : 0;
      }
      if (!found.second_mass) continue;
      ++named;
      if (found.second_mass->frequency == 0.0) continue;
      ++told;
      right += std::abs(found.second_mass->frequency - resonance) < 0.2 * resonance ? 1 : 0;
    } catch (const Failure&) {
      continue;  // refused
    }
  }
  std::cout << "false alarms " << false_alarms << ", named " << named << ", resonances right " << right
            << " of " << told << ", inertia held with exit code 0 " << held << " of " << silent << '\n';
  EXPECT_LE(false_alarms, 1);
  EXPECT_GE(named, joints * 4 / 10);
  EXPECT_GE(held, 0.6 * silent);
  EXPECT_GE(right, 0.8 * told);
}

}  // namespace
}  // namespace zerocount::testing
