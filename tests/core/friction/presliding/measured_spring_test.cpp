// The spring that follows from what one measures of it: its virgin curve passes through what was measured.
#include "core/friction/presliding/measured_spring.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/friction/presliding/spring.hpp"

namespace zerocount::friction {
namespace {

class MeasuredSpring : public testing::Test {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0, 1)); }
  /// In (0, 1), near 0 or near 1 as often as between.
  double fraction() {
    const double distance = log_uniform(1e-9, 0.5);
    return uniform(0, 1) < 0.5 ? distance : 1.0 - distance;
  }

 private:
  std::mt19937_64 random_{11};
};

/// σv(x)
double virgin_torque(double final, const Softening& softening, double travel) {
  FrictionParameters contact;
  contact.k1 = final;
  contact.k2 = softening.k2;
  contact.beta = softening.beta;
  return 0.5 * branch_law(contact, 2.0 * travel);
}

TEST_F(MeasuredSpring, PassesThroughThePointAndHasBothStiffnesses) {
  for (int i = 0; i < 20000; ++i) {
    const double final = log_uniform(1, 1e8);
    const double initial = final * log_uniform(1.001, 1e4);
    const double travel = log_uniform(1e-9, 1e-2);
    const VirginPoint point{travel, travel * (final + fraction() * (initial - final))};
    const auto found = softening_from(initial, final, point);
    ASSERT_TRUE(found) << i;
    EXPECT_NEAR((final + found->k2) / initial, 1.0, 1e-15);
    EXPECT_NEAR(virgin_torque(final, *found, travel) / point.torque, 1.0, 1e-12) << i;
  }
}

TEST_F(MeasuredSpring, PassesThroughBothPoints) {
  for (int i = 0; i < 20000; ++i) {
    const double final = log_uniform(1, 1e8);
    const double secant = final * log_uniform(1.001, 1e4);
    const double travel = log_uniform(1e-9, 1e-2);
    const VirginPoint first{travel, travel * secant};
    const double last = travel * log_uniform(1.001, 1e4);
    const double low = first.torque + final * (last - travel);
    const double high = secant * last;
    const VirginPoint point{last, low + fraction() * (high - low)};
    const auto found = softening_through(first, point, final);
    ASSERT_TRUE(found) << i;
    EXPECT_NEAR(virgin_torque(final, *found, first.travel) / first.torque, 1.0, 1e-12) << i;
    EXPECT_NEAR(virgin_torque(final, *found, last) / point.torque, 1.0, 1e-12) << i;
  }
}

// Both ways say the same spring.
TEST_F(MeasuredSpring, FollowsFromASecantOfItsOwnCurve) {
  for (int i = 0; i < 1000; ++i) {
    const double final = log_uniform(1e2, 1e6);
    const Softening spring{final * log_uniform(0.1, 100), log_uniform(1e4, 1e7)};
    const double travel = log_uniform(0.3, 3) / spring.beta;
    const double first = travel * uniform(0.1, 0.9);
    const VirginPoint last{travel, virgin_torque(final, spring, travel)};
    const auto by_initial = softening_from(final + spring.k2, final, last);
    const auto by_secant = softening_through({first, virgin_torque(final, spring, first)}, last, final);
    ASSERT_TRUE(by_initial && by_secant);
    EXPECT_NEAR(by_initial->beta / spring.beta, 1.0, 1e-9);
    EXPECT_NEAR(by_secant->beta / spring.beta, 1.0, 1e-8);
    EXPECT_NEAR(by_secant->k2 / spring.k2, 1.0, 1e-8);
  }
}

TEST_F(MeasuredSpring, DoesNotExistBeyondItsConditions) {
  for (int i = 0; i < 1000; ++i) {
    const double excess = log_uniform(1.0 + 1e-9, 3);
    EXPECT_FALSE(softening_from(100, 10, {1e-3, 1e-3 * 10 / excess}));
    EXPECT_FALSE(softening_from(100, 10, {1e-3, 1e-3 * 100 * excess}));
    EXPECT_FALSE(softening_through({1e-4, 1e-4 * 10 / excess}, {1e-3, 0.02}, 10));
    EXPECT_FALSE(softening_through({1e-3 * excess, 0.1 * excess}, {1e-3, 0.05}, 10));
    EXPECT_FALSE(softening_through({1e-4, 0.01}, {1e-3, 0.1 * excess}, 10));
    EXPECT_FALSE(softening_through({1e-4, 0.01}, {1e-3, (0.01 + 10 * 9e-4) / excess}, 10));
  }
}

}  // namespace
}  // namespace zerocount::friction
