// The first sign change of a polynomial: found, first, and never missed.
#include "core/numerics/power_series.hpp"
#include "core/numerics/roots.hpp"
#include "tests/support/test.hpp"

namespace zerocount::numerics {
namespace {

/// Coefficients of the polynomial Π (t − root) with these roots.
std::vector<double> polynomial_with_roots(const std::vector<double>& roots) {
  std::vector<double> c{1.0};
  for (const double root : roots) {
    c.insert(c.begin(), 0.0);
    for (std::size_t k = 0; k + 1 < c.size(); ++k) c[k] -= root * c[k + 1];
  }
  return c;
}

TEST(FirstSignChange, IsTheSmallestSimpleRootInTheStep) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-2.0, 3.0);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> roots(static_cast<std::size_t>(1 + trial % 6));
    for (double& root : roots) root = place(random);
    std::sort(roots.begin(), roots.end());
    const std::vector<double> c = polynomial_with_roots(roots);
    const double end = 1.0;
    const auto first = std::find_if(roots.begin(), roots.end(), [](double root) { return root > 0.0; });
    const std::optional<double> found = first_sign_change(c, end);
    if (first == roots.end() || *first > end) {
      EXPECT_FALSE(found.has_value());
      continue;
    }
    ASSERT_TRUE(found.has_value());
    const bool crowded = std::next(first) != roots.end() && *std::next(first) - *first < 1e-4;
    if (crowded) continue;
    EXPECT_NEAR(*found, *first, 1e-9);
  }
}

TEST(FirstSignChange, FindsAnExcursionOfAMillionthOfTheStep) {
  for (const double width : {1e-2, 1e-4, 1e-6}) {
    const std::vector<double> c = polynomial_with_roots({0.37, 0.37 + width, 2.0, -1.0});
    const std::optional<double> found = first_sign_change(c, 1.0);
    ASSERT_TRUE(found.has_value()) << width;
    EXPECT_NEAR(*found, 0.37, 1e-3 * width + 1e-9);
  }
}

TEST(FirstSignChange, TouchingZeroIsNotAChange) {
  // (t − ½)² + a little: the sign stays.
  EXPECT_FALSE(first_sign_change(std::vector<double>{0.25 + 1e-9, -1.0, 1.0}, 1.0).has_value());
}

TEST(FirstSignChange, CountsTheEndOfTheStepAsInside) {
  const std::optional<double> found = first_sign_change(std::vector<double>{1.0, -1.0}, 1.0);
  ASSERT_TRUE(found.has_value());
  EXPECT_DOUBLE_EQ(*found, 1.0);
  EXPECT_FALSE(first_sign_change(std::vector<double>{1.0, -1.0}, 0.999).has_value());
}

TEST(BracketedRoot, IsExactToTheLastBits) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(0.01, 0.99);
  for (int trial = 0; trial < 500; ++trial) {
    const double root = place(random);
    const std::vector<double> c{-root * root * root, 0.0, 0.0, 1.0};
    EXPECT_NEAR(bracketed_root(c, 0.0, 1.0), root, 4e-16);
  }
}

TEST(BracketedRoot, MayLieAtTheUpperEnd) {
  EXPECT_EQ(bracketed_root(std::vector<double>{1.0, -1.0}, 0.0, 1.0), 1.0);
  EXPECT_EQ(bracketed_root(std::vector<double>{-1.0, 1.0}, 0.0, 1.0), 1.0);
}

TEST(PowerSeries, ExponentialAndPowerAgreeWithTheFunctions) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> coefficient(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    Series a{};
    a[0] = 1.5 + 0.5 * coefficient(random);
    for (std::size_t k = 1; k <= 4; ++k) a[k] = coefficient(random);
    const double n = 1.0 + 2.0 * std::abs(coefficient(random));
    Series exponential{std::exp(a[0])};
    Series power{std::pow(a[0], n)};
    Series square{a[0] * a[0]};
    Series derivative{};
    for (std::size_t k = 0; k < series_order; ++k) derivative[k] = static_cast<double>(k + 1) * a[k + 1];
    for (std::size_t k = 1; k <= series_order; ++k) {
      exponential[k] = exponential_coefficient(derivative.data(), exponential.data(), k);
      power[k] = power_coefficient(a.data(), power.data(), n, 1.0 / a[0], k);
      square[k] = square_coefficient(a.data(), k);
    }
    const double t = 0.02;
    const double value = value_at(a, t);
    EXPECT_NEAR(value_at(exponential, t), std::exp(value), 1e-13);
    EXPECT_NEAR(value_at(power, t), std::pow(value, n), 1e-13);
    EXPECT_NEAR(value_at(square, t), value * value, 1e-14);
  }
}

}  // namespace
}  // namespace zerocount::numerics

namespace zerocount::testing {
namespace {

// Both searches find the first number of any threshold, and the doubling one asks for none above twice it.
TEST(Bisection, FindsTheFirstNumberThatSatisfiesTheCondition) {
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
