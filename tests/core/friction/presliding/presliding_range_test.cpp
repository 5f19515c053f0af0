
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/friction/presliding/spring.hpp"

namespace zerocount::friction {
namespace {

// A contact that is loaded from virgin carries breakaway at the end of its pre-sliding range, and not before.
TEST(PreslidingRange, IsTheTravelAtWhichAVirginContactCarriesBreakaway) {
  std::mt19937_64 random(3);
  const auto log_uniform = [&random](double low, double high) {
    return low * std::pow(high / low, std::uniform_real_distribution<double>(0, 1)(random));
  };
  for (int i = 0; i < 2000; ++i) {
    FrictionParameters contact;
    contact.k1 = log_uniform(1, 1e6);
    contact.k2 = log_uniform(1, 1e8);
    contact.beta = log_uniform(1e2, 1e7);
    contact.breakaway = log_uniform(1e-3, 1e3);
    const double range = presliding_range(contact);
    EXPECT_NEAR(0.5 * branch_law(contact, 2.0 * range) / contact.breakaway, 1.0, 1e-13);
    HystereticSpring spring(contact);
    spring.start_virgin(0.0, 1);
    spring.move_to(range * (1.0 - 1e-9));
    EXPECT_LT(spring.torque(), contact.breakaway);
    EXPECT_LE(range, contact.breakaway / contact.k1);
    EXPECT_GE(range, contact.breakaway / (contact.k1 + contact.k2));
  }
}

TEST(PreslidingRange, HasClosedFormsWhereOneTermOfTheSpringIsMissing) {
  FrictionParameters contact;
  contact.k2 = 0.0;
  EXPECT_DOUBLE_EQ(presliding_range(contact), contact.breakaway / contact.k1);

  contact = {};
  contact.k1 = 0.0;
  contact.breakaway = 0.6 * contact.k2 / (2.0 * contact.beta);
  EXPECT_NEAR(presliding_range(contact), -std::log(1.0 - 0.6) / (2.0 * contact.beta), 1e-15);
  contact.breakaway = contact.k2 / (2.0 * contact.beta);
  EXPECT_EQ(presliding_range(contact), std::numeric_limits<double>::infinity());
  contact.k2 = 0.0;
  EXPECT_EQ(presliding_range(contact), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace zerocount::friction
