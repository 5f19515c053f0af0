#include "analysis/basis/statistics/sums/exact_sum.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include "analysis/basis/statistics/sums/moments.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

using Rational = boost::multiprecision::cpp_rational;

ExactSum sum_of(const std::vector<double>& values) {
  ExactSum sum;
  for (const double value : values) sum.add(value);
  return sum;
}

ExactSum squares_of(const std::vector<double>& values) {
  ExactSum sum;
  for (const double value : values) sum.add_square(value);
  return sum;
}

/// Random values of both signs with binary exponents up to ±`range`.
std::vector<double> random_values(testing::Draws& draws, int range) {
  std::vector<double> values(60);
  for (double& value : values)
    value = std::ldexp(draws.uniform(-1.0, 1.0), static_cast<int>(draws.uniform(-range, range)));
  return values;
}

void shuffle(std::vector<double>& values, testing::Draws& draws) {
  for (std::size_t i = values.size(); i > 1; --i)
    std::swap(values[i - 1], values[static_cast<std::size_t>(draws.uniform(0.0, static_cast<double>(i)))]);
}

TEST(ExactSum, DoesNotDependOnOrderOrPartition) {
  testing::Draws draws(2301);
  for (const int range : {2, 40, 1000}) {
    for (int round = 0; round < 100; ++round) {
      std::vector<double> values = random_values(draws, range);
      const ExactSum sum = sum_of(values), squares = squares_of(values);
      shuffle(values, draws);
      EXPECT_EQ(sum_of(values), sum);
      EXPECT_EQ(squares_of(values), squares);
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(draws.uniform(0.0, 60.0));
      ExactSum parts = sum_of({values.begin(), middle});
      parts += sum_of({middle, values.end()});
      EXPECT_EQ(parts, sum);
      EXPECT_EQ(parts.value(), sum.value());
    }
  }
}

TEST(ExactSum, EqualsTheSumOfRationalNumbers) {
  testing::Draws draws(2302);
  for (int round = 0; round < 100; ++round) {
    const std::vector<double> values = random_values(draws, 30);
    Rational sum = 0, squares = 0;
    for (const double value : values) {
      sum += Rational(value);
      squares += Rational(value) * Rational(value);
    }
    EXPECT_EQ(sum_of(values).value(), static_cast<double>(sum));
    EXPECT_EQ(squares_of(values).value(), static_cast<double>(squares));
    EXPECT_EQ(squared_deviations(sum_of(values), squares_of(values), 60),
              static_cast<double>(Rational(squares - sum * sum / 60)));
  }
}

// So many additions that the digits have to be carried on the way.
TEST(ExactSum, DoublesIfAddedToItself) {
  ExactSum sum;
  for (const double value : {1.0 / 3.0, -1e-30, 7e20}) sum.add(value);
  const double once = sum.value();
  for (int doublings = 0; doublings < 70; ++doublings) sum += ExactSum(sum);
  EXPECT_EQ(sum.value(), std::ldexp(once, 70));
}

TEST(ExactSum, HoldsTheSmallestAndTheLargestDoubles) {
  using Limits = std::numeric_limits<double>;
  EXPECT_EQ(sum_of({Limits::denorm_min()}).value(), Limits::denorm_min());
  EXPECT_EQ(sum_of({Limits::max(), 1.0, -Limits::max()}).value(), 1.0);
  EXPECT_EQ(sum_of({-Limits::max(), Limits::denorm_min(), Limits::max()}).value(), Limits::denorm_min());
  EXPECT_EQ(squared_deviations(sum_of({Limits::max(), Limits::max()}),
                               squares_of({Limits::max(), Limits::max()}), 2),
            0.0);
  EXPECT_EQ(sum_of({}).value(), 0.0);
  EXPECT_EQ(sum_of({-1.0, 1.0}), sum_of({}));
}

TEST(MomentSums, KeepTheSpreadOfNearlyEqualValues) {
  std::vector<double> values;
  for (int i = 0; i < 10; ++i) values.push_back(1e9 + i);
  MomentSums sums;
  for (const double value : values) sums.add(value);
  EXPECT_EQ(sums.moments().mean, 1e9 + 4.5);
  EXPECT_EQ(sums.moments().squares, 82.5);
  EXPECT_EQ(sums.moments().max, 1e9 + 9);
}

TEST(MomentSums, LeaveOutNonfiniteValues) {
  MomentSums sums;
  sums.add(std::nan(""));
  EXPECT_TRUE(std::isnan(sums.moments().mean));
  EXPECT_TRUE(std::isnan(sums.moments().min));
  sums.add(-2.0);
  sums.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(sums.moments().n, 1);
  EXPECT_EQ(sums.moments().nonfinite, 2);
  EXPECT_EQ(sums.moments().min, -2.0);
  EXPECT_EQ(sums.moments().mean, -2.0);
}

TEST(MomentSums, AgreeWithWelford) {
  testing::Draws draws(2303);
  for (int round = 0; round < 20; ++round) {
    MomentSums sums;
    Moments moments;
    const double centre = draws.uniform(-10.0, 10.0);
    for (int i = 0; i < 200; ++i) {
      const double value = centre + draws.uniform(0.0, 1.0);
      sums.add(value);
      moments.add(value);
    }
    EXPECT_NEAR(sums.moments().mean, moments.mean, 1e-13);
    EXPECT_NEAR(sums.moments().sd(), moments.sd(), 1e-12);
    EXPECT_EQ(sums.moments().max, moments.max);
  }
}

}  // namespace
}  // namespace zerocount::statistics
