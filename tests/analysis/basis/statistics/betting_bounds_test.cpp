#include "analysis/basis/statistics/mean_bounds.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

/// Number of sequences, out of 200, whose bounds miss the true mean at one of the lengths 20, 40, 80, …,
/// 1280.
int sequences_that_fail(double mean, double cap, const std::function<double(std::mt19937_64&)>& draw) {
  std::mt19937_64 numbers(7);
  int failed = 0;
  for (int sequence = 0; sequence < 200; ++sequence) {
    std::vector<double> positive;
    bool fails = false;
    std::int64_t length = 20;
    for (std::int64_t n = 1; n <= 1280 && !fails; ++n) {
      const double x = draw(numbers);
      if (x > 0.0) positive.push_back(x);
      if (n != length) continue;
      length *= 2;
      const ConfidenceInterval bounds = betting_bounds(positive, n, cap, 0.9);
      fails = !(bounds.low <= mean && mean <= bounds.high);
    }
    failed += fails ? 1 : 0;
  }
  return failed;
}

// Each sequence fails with a probability of at most 0.1: more than 33 of 200 do so with 1/300.
TEST(BettingBounds, HoldAtAllSampleSizesAtOnce) {
  std::bernoulli_distribution rarely(0.05);
  EXPECT_LE(sequences_that_fail(0.05, 1.0, [&](auto& g) { return rarely(g) ? 1.0 : 0.0; }), 33);
  std::exponential_distribution<double> exponential(2.0);
  EXPECT_LE(sequences_that_fail(0.5 - 0.5 * std::exp(-10.0), 5.0,
                                [&](auto& g) { return std::min(exponential(g), 5.0); }),
            33);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  EXPECT_LE(
      sequences_that_fail(1e-6, 4e-6, [&](auto& g) { return uniform(g) < 0.5 ? 4e-6 * uniform(g) : 0.0; }),
      33);
}

// Without a cap that holds, the lower bound still does: half of the mean is in values that come once in 1000.
TEST(BettingBounds, LowerBoundNeedsNoUpperLimitOfTheValues) {
  std::mt19937_64 numbers(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int failed = 0;
  for (int sequence = 0; sequence < 200; ++sequence) {
    std::vector<double> positive;
    for (int i = 0; i < 2000; ++i) {
      const double u = uniform(numbers);
      if (u < 0.5) positive.push_back(u < 0.001 ? 500.0 : 1.0);
    }
    failed += betting_bounds(positive, 2000, 2.0, 0.9).low > 0.499 + 0.5 ? 1 : 0;
  }
  EXPECT_LE(failed, 20);
}

TEST(BettingBounds, ScaleWithTheValues) {
  const std::vector<double> values{0.2, 0.5, 0.7, 0.1};
  std::vector<double> small;
  for (const double x : values) small.push_back(1e-8 * x);
  const ConfidenceInterval large_bounds = betting_bounds(values, 40, 1.0, 0.95);
  const ConfidenceInterval small_bounds = betting_bounds(small, 40, 1e-8, 0.95);
  EXPECT_NEAR(small_bounds.low / large_bounds.low, 1e-8, 1e-13);
  EXPECT_NEAR(small_bounds.high / large_bounds.high, 1e-8, 1e-13);
}

TEST(BettingBounds, WithoutPositiveValuesBeginAtZero) {
  const ConfidenceInterval none = betting_bounds({}, 0, 0.5, 0.95);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_EQ(none.high, 0.5);
  const ConfidenceInterval bounds = betting_bounds({}, 1000, 1.0, 0.95);
  EXPECT_EQ(bounds.low, 0.0);
  EXPECT_GT(bounds.high, 3.0 / 1000.0);
  EXPECT_LT(bounds.high, 9.0 / 1000.0);
}

}  // namespace
}  // namespace zerocount::statistics
