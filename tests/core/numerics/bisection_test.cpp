#include "core/numerics/bisection.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace zerocount::testing {
namespace {

// Both searches find the first number of any threshold, and the doubling one asks for none above twice it.
TEST(Bisection, FindsTheFirstNumber) {
  std::mt19937_64 random(71);
  std::uniform_int_distribution<std::int64_t> number(0, 1000);
  for (int round = 0; round < 2000; ++round) {
    const std::int64_t low = number(random);
    const std::int64_t end = number(random);
    const std::int64_t threshold = number(random);
    std::int64_t asked = 0;
    const auto holds = [&](std::int64_t at) {
      EXPECT_TRUE(at >= low && at < end);
      asked = std::max(asked, at);
      return at >= threshold;
    };
    const std::int64_t expected = low < end ? std::min(std::max(low, threshold), end) : end;
    EXPECT_EQ(numerics::first_where(low, end, holds), expected);
    asked = 0;
    EXPECT_EQ(numerics::first_where_by_doubling(low, end, holds), expected);
    EXPECT_LE(asked, std::max(low, 2 * expected));
  }
}

// Whichever end holds, the bracket keeps the threshold, and is as narrow as it was asked to be.
TEST(Bisection, BracketsTheChange) {
  std::mt19937_64 random(72);
  std::uniform_real_distribution<double> number(1.0, 2.0);
  for (int round = 0; round < 200; ++round) {
    const double threshold = number(random);
    const bool rises = round % 2 == 0;
    const auto holds = [&](double x) { return (x >= threshold) == rises; };
    const numerics::Bracket whole = rises ? numerics::Bracket{2.0, 1.0} : numerics::Bracket{1.0, 2.0};
    const auto check = [&](const numerics::Bracket& found, double width) {
      EXPECT_TRUE(holds(found.holds) && !holds(found.fails));
      EXPECT_LE(std::abs(found.holds - found.fails), width);
    };
    check(numerics::bisect(whole, holds, numerics::within(1e-9)), 1e-9);
    check(numerics::bisect(whole, holds, numerics::after_halvings(20)), 0x1p-20);
    check(numerics::bisect(whole, holds, numerics::after_halvings(20), numerics::geometric_mean), 0x1p-19);
    // Without an end it stops at neighbouring numbers.
    const auto finest = numerics::bisect(whole, holds, [](const numerics::Bracket&) { return false; });
    check(finest, 0x1p-52);
  }
}

}  // namespace
}  // namespace zerocount::testing
