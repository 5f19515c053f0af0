// Gravity and ripple of random joints, moved by an independent integrator: found, not found where they are
// not, and covered by the intervals.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analysis/record/sliding_identification/sliding_identification.hpp"
#include "tests/analysis/record/sliding_identification/coverage.hpp"
#include "tests/analysis/record/sliding_identification/joint_records.hpp"

namespace zerocount::testing {
namespace {

using sliding_identification::SlidingIdentification;

/// Counts over the identifications of many simulated records.
struct Counts {
  int records{0};
  int right{0};       ///< number of records whose position-dependent torques were identified correctly
  int distrusted{0};  ///< number of records whose result states a reason to distrust it
  int estimated{0};   ///< number of estimated parameters in all records
  int held{0};        ///< number of parameters whose confidence intervals contain the true value
  /// Number of parameters far outside their confidence intervals although the result is trusted.
  int wrong{0};

  void add(const JointMotion& motion, const SlidingIdentification& found) {
    const Joint& joint = motion.joint;
    ++records;
    std::vector<double> periods;
    if (joint.gravity > 0.0) periods.push_back(1.0);
    if (joint.ripple > 0.0) periods.push_back(joint.periods);
    right += std::ranges::equal(periods, found.waves, {}, {}, &sliding_identification::PositionWave::periods);
    if (!reason_of_distrust(found).empty()) {
      ++distrusted;
      return;
    }
    add(found, "inertia", joint.inertia);
    add(found, "sliding_damping", joint.damping);
    add(found, "coulomb_level", joint.coulomb);
    if (joint.excess > 0.0) add(found, "breakaway_level", joint.coulomb + joint.excess);
    // A torque that may act twice per revolution is gravity only if the user knows that nothing else acts.
    if (joint.ripple > 0.0 && found.could_be_two_periods) return;
    add(found, "offset", joint.offset);
    add(found, "ripple.1.amplitude", joint.gravity);
    if (joint.gravity > 0.0) add(found, "ripple.1.phase", joint.gravity_phase);
    add(found, fmt::format("ripple.{:g}.amplitude", joint.periods), joint.ripple);
  }

  void add(const SlidingIdentification& found, const std::string& name, double truth) {
    const fit::ParameterEstimate* one = estimate(found, name);
    if (one == nullptr || !is_estimated(*one)) return;
    ++estimated;
    held += one->low <= truth && truth <= one->high ? 1 : 0;
    wrong += std::abs(one->value - truth) > 0.05 * std::abs(truth) + 1.5 * one->half_width() ? 1 : 0;
  }
};

Counts counts_of(int records, bool with_gravity, bool with_ripple) {
  Counts counts;
  for (int i = 0; i < records; ++i) {
    std::mt19937_64 random(static_cast<std::uint64_t>(i) * 7919 + 13);
    const JointMotion motion = random_joint_motion(random, with_gravity, with_ripple);
    counts.add(motion, identified(motion, random));
  }
  return counts;
}

TEST(JointCoverage, GravityIsFoundAndCovered) {
  const Counts counts = counts_of(3, true, false);
  EXPECT_EQ(counts.right, 3);
  EXPECT_EQ(counts.distrusted, 0);
  EXPECT_EQ(counts.wrong, 0);
  EXPECT_GE(counts.held, least_expected(counts.estimated)) << counts.estimated;
}

TEST(JointCoverage, NoGravityIsFoundIfThereIsNone) {
  const Counts counts = counts_of(3, false, false);
  EXPECT_EQ(counts.right, 3);
  EXPECT_EQ(counts.wrong, 0);
  EXPECT_GE(counts.held, least_expected(counts.estimated)) << counts.estimated;
}

// Over a fifth of a revolution gravity and a torque of six periods may be others that act alike.
TEST(JointCoverage, TorquesThatLookAlikeAreNotDistinguished) {
  std::mt19937_64 random(13 + 22 * 7919);
  const JointMotion motion = random_joint_motion(random, true, true);
  ASSERT_EQ(motion.joint.periods, 6.0);
  const SlidingIdentification found = identified(motion, random);
  EXPECT_GE(found.waves.size(), 2u);
  EXPECT_FALSE(is_estimated(*estimate(found, "ripple.1.amplitude")));
  EXPECT_FALSE(is_estimated(*estimate(found, "offset")));
  EXPECT_EQ(found.fragment.find("disturbance:"), std::string::npos) << found.fragment;
  EXPECT_NE(found.fragment.find("# A torque that depends on the position acts"), std::string::npos);
  EXPECT_NEAR(estimate(found, "inertia")->value, motion.joint.inertia, 0.01 * motion.joint.inertia);
}

TEST(JointCoverage, DISABLED_IntervalsCoverTheTrueValuesOfManyJoints) {
  constexpr int records = 60;
  Counts all;
  for (const bool with_gravity : {false, true}) {
    for (const bool with_ripple : {false, true}) {
      const Counts counts = counts_of(records, with_gravity, with_ripple);
      std::cout << with_gravity << with_ripple << ": right " << counts.right << ", distrusted "
                << counts.distrusted << ", held " << counts.held << " of " << counts.estimated << ", wrong "
                << counts.wrong << '\n';
      // Over a small part of a revolution other torques may act as those of the joint do.
      EXPECT_GE(counts.right, with_ripple ? records * 2 / 3 : records - 1);
      EXPECT_LE(counts.distrusted, records / 20);
      EXPECT_LE(counts.wrong, with_ripple ? records / 30 : 0);
      all.estimated += counts.estimated;
      all.held += counts.held;
    }
  }
  EXPECT_GE(all.held, 0.93 * all.estimated);
}

}  // namespace
}  // namespace zerocount::testing
