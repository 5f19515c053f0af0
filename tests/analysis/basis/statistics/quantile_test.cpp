#include "analysis/basis/statistics/quantile.hpp"

#include "core/failure/failure.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

/// Quantiles and 95 % bounds computed by other programs for the made-up values x_i = (7i² + 3i) mod 101, i <
/// n: numpy 1.24's quantile(x, p, method="inverted_cdf"); the ranks of the bounds from SciPy 1.10's binom.cdf
/// and binom.sf, by trying all ranks.
struct Reference {
  std::int64_t n;
  double p;
  std::int64_t quantile, low, high;
};
constexpr Reference references[] = {
    {1, 0.05, 0, 0, 2},           {1, 0.25, 0, 0, 2},          {1, 0.5, 0, 0, 2},
    {1, 0.75, 0, 0, 2},           {1, 0.95, 0, 0, 2},          {2, 0.05, 0, 0, 2},
    {2, 0.25, 0, 0, 3},           {2, 0.5, 0, 0, 3},           {2, 0.75, 10, 0, 3},
    {2, 0.95, 10, 1, 3},          {5, 0.05, 0, 0, 2},          {5, 0.25, 10, 0, 4},
    {5, 0.5, 23, 0, 6},           {5, 0.75, 34, 2, 6},         {5, 0.95, 72, 4, 6},
    {10, 0.05, 0, 0, 3},          {10, 0.25, 23, 0, 6},        {10, 0.5, 61, 2, 9},
    {10, 0.75, 72, 5, 11},        {10, 0.95, 89, 8, 11},       {19, 0.05, 0, 0, 4},
    {19, 0.25, 10, 1, 10},        {19, 0.5, 34, 5, 15},        {19, 0.75, 72, 10, 19},
    {19, 0.95, 100, 16, 20},      {20, 0.05, 0, 0, 4},         {20, 0.25, 10, 2, 10},
    {20, 0.5, 34, 6, 15},         {20, 0.75, 68, 11, 19},      {20, 0.95, 89, 17, 21},
    {21, 0.05, 0, 0, 4},          {21, 0.25, 22, 2, 10},       {21, 0.5, 34, 6, 16},
    {21, 0.75, 68, 12, 20},       {21, 0.95, 89, 18, 22},      {40, 0.05, 0, 0, 6},
    {40, 0.25, 19, 5, 17},        {40, 0.5, 34, 14, 27},       {40, 0.75, 68, 24, 36},
    {40, 0.95, 95, 35, 41},       {59, 0.05, 1, 0, 8},         {59, 0.25, 20, 9, 22},
    {59, 0.5, 49, 22, 38},        {59, 0.75, 72, 38, 51},      {59, 0.95, 96, 52, 60},
    {60, 0.05, 1, 0, 8},          {60, 0.25, 19, 9, 23},       {60, 0.5, 46, 22, 39},
    {60, 0.75, 72, 38, 52},       {60, 0.95, 95, 53, 61},      {72, 0.05, 1, 1, 9},
    {72, 0.25, 20, 11, 26},       {72, 0.5, 49, 28, 45},       {72, 0.75, 72, 47, 62},
    {72, 0.95, 96, 64, 72},       {73, 0.05, 1, 1, 9},         {73, 0.25, 21, 11, 27},
    {73, 0.5, 49, 28, 46},        {73, 0.75, 72, 47, 63},      {73, 0.95, 96, 65, 73},
    {100, 0.05, 2, 1, 11},        {100, 0.25, 20, 17, 35},     {100, 0.5, 49, 40, 61},
    {100, 0.75, 72, 66, 84},      {100, 0.95, 96, 90, 100},    {200, 0.05, 2, 4, 17},
    {200, 0.25, 20, 38, 63},      {200, 0.5, 49, 86, 115},     {200, 0.75, 72, 138, 163},
    {200, 0.95, 96, 184, 197},    {997, 0.05, 2, 37, 65},      {997, 0.25, 20, 223, 277},
    {997, 0.5, 49, 468, 530},     {997, 0.75, 72, 721, 775},   {997, 0.95, 96, 933, 961},
    {1000, 0.05, 2, 37, 65},      {1000, 0.25, 20, 223, 278},  {1000, 0.5, 49, 469, 532},
    {1000, 0.75, 72, 723, 778},   {1000, 0.95, 96, 936, 964},  {5000, 0.05, 2, 220, 282},
    {5000, 0.25, 20, 1190, 1311}, {5000, 0.5, 49, 2431, 2570}, {5000, 0.75, 72, 3690, 3811},
    {5000, 0.95, 96, 4719, 4781},
};

Histogram<std::int64_t> tally_of(std::int64_t n) {
  Histogram<std::int64_t> histogram;
  for (std::int64_t i = 0; i < n; ++i) histogram.add((7 * i * i + 3 * i) % 101);
  return histogram;
}

TEST(Quantile, MatchesTheInvertedCdfOfNumPy) {
  for (const Reference& reference : references) {
    EXPECT_EQ(quantile(tally_of(reference.n), reference.p).value, static_cast<double>(reference.quantile))
        << reference.n << ", " << reference.p;
  }
}

TEST(Quantile, BoundsHaveTheRanksOfTheBinomial) {
  for (const Reference& reference : references) {
    const RankBounds bounds = quantile_rank_bounds(reference.n, reference.p);
    EXPECT_EQ(bounds.low, reference.low) << reference.n << ", " << reference.p;
    EXPECT_EQ(bounds.high, reference.high) << reference.n << ", " << reference.p;
  }
}

TEST(Quantile, ValueAndBoundsAreTheOrderedSamplesOfTheirRanks) {
  std::mt19937_64 random(31);
  for (int round = 0; round < 100; ++round) {
    std::vector<double> values(1 + random() % 300);
    Histogram<double> histogram;
    for (double& value : values) {
      value = 0.0005 * static_cast<double>(random() % 50);
      histogram.add(value);
    }
    std::sort(values.begin(), values.end());
    const auto n = static_cast<std::int64_t>(values.size());
    for (const double p : {0.05, 0.5, 0.95}) {
      const Quantile found = quantile(histogram, p);
      const RankBounds ranks = quantile_rank_bounds(n, p);
      EXPECT_EQ(found.value, values[static_cast<std::size_t>(quantile_rank(n, p) - 1)]);
      if (ranks.low >= 1) {
        EXPECT_EQ(found.low, values[static_cast<std::size_t>(ranks.low - 1)]);
      } else {
        EXPECT_TRUE(std::isnan(found.low));
      }
      if (ranks.high <= n) {
        EXPECT_EQ(found.high, values[static_cast<std::size_t>(ranks.high - 1)]);
      } else {
        EXPECT_TRUE(std::isnan(found.high));
      }
    }
  }
}

TEST(Quantile, RankIsTheLeastWithEnoughObservationsAtOrBelowIt) {
  // In whole numbers: rank/n ≥ p, (rank − 1)/n < p with p in hundredths. Rounding of n·p must not show.
  for (const int percent : {5, 25, 50, 75, 95, 7, 29, 57}) {
    for (std::int64_t n = 1; n <= 3000; ++n) {
      const std::int64_t rank = quantile_rank(n, percent / 100.0);
      ASSERT_GE(100 * rank, percent * n) << percent << " % of " << n;
      ASSERT_LT(100 * (rank - 1), percent * n) << percent << " % of " << n;
    }
  }
}

TEST(Quantile, BoundsOfAnExtremeNeedEnoughObservations) {
  EXPECT_EQ(quantile_rank_bounds(71, 0.95).high, 72);  // 0.95^71 = 0.0262: none
  EXPECT_EQ(quantile_rank_bounds(72, 0.95).high, 72);  // 0.95^72 = 0.0249: the largest
}

TEST(Quantile, AnEmptySampleHasNoQuantile) {
  const Quantile none = quantile(Histogram<double>{}, 0.5);
  EXPECT_TRUE(std::isnan(none.value));
  EXPECT_TRUE(std::isnan(none.low));
  EXPECT_TRUE(std::isnan(none.high));
}

/// Proportion of samples of size n, drawn by `draw`, whose bounds of the p-quantile contain `truth`. A
/// missing bound counts as containing it.
template <typename Draw>
double quantile_coverage(int n, double p, double truth, Draw draw) {
  constexpr int rounds = 4000;
  int enclosed = 0;
  for (int round = 0; round < rounds; ++round) {
    Histogram<double> histogram;
    for (int i = 0; i < n; ++i) histogram.add(draw());
    const Quantile found = quantile(histogram, p);
    enclosed += !(found.low > truth) && !(found.high < truth);
  }
  return enclosed / static_cast<double>(rounds);
}

TEST(Quantile, BoundsCoverTheTrueQuantileWhateverTheDistribution) {
  std::mt19937_64 random(32);
  std::exponential_distribution<double> continuous;
  std::geometric_distribution<int> discrete(0.2);  // P(X ≤ k) = 1 − 0.8^(k+1)
  constexpr double three_sigma = 0.011;            // of 4000 rounds at 0.95
  for (const int n : {10, 60, 200}) {
    for (const double p : {0.5, 0.95}) {
      const double of_continuous = -std::log(1.0 - p);
      const double of_discrete = std::ceil(std::log(1.0 - p) / std::log(0.8) - 1.0);
      EXPECT_GE(quantile_coverage(n, p, of_continuous, [&] { return continuous(random); }),
                0.95 - three_sigma);
      EXPECT_GE(quantile_coverage(n, p, of_discrete, [&] { return static_cast<double>(discrete(random)); }),
                0.95 - three_sigma);
    }
  }
  // Not by being needlessly wide: with 200 observations of a continuous quantity the excess over 95 % is
  // small.
  EXPECT_LE(quantile_coverage(200, 0.5, -std::log(0.5), [&] { return continuous(random); }), 0.97);
}

TEST(Quantile, ProbabilitiesOutsideTheOpenUnitIntervalAreRefused) {
  for (const double p : {0.0, 1.0, -1.0, std::nan("")}) {
    EXPECT_THROW(quantile_rank(10, p), Failure);
    EXPECT_THROW(quantile_rank_bounds(10, p), Failure);
    EXPECT_THROW(quantile_rank_bounds(10, 0.5, p), Failure);
  }
}

TEST(Histogram, MeanSpreadAndTotalOfAHandMadeSample) {
  Histogram<std::int64_t> histogram;
  for (const std::int64_t value : {2, 4, 4, 4, 5, 5, 7, 9}) histogram.add(value);
  EXPECT_EQ(mean(histogram), 5.0);
  EXPECT_NEAR(standard_deviation(histogram), std::sqrt(32.0 / 7.0), 1e-15);
  EXPECT_EQ(total(histogram), 40);
  EXPECT_EQ(smallest(histogram), 2.0);
  EXPECT_EQ(largest(histogram), 9.0);
  EXPECT_EQ(order_statistic(histogram, 4), 4.0);
  EXPECT_EQ(order_statistic(histogram, 5), 5.0);
  EXPECT_TRUE(std::isnan(order_statistic(histogram, 0)));
  EXPECT_TRUE(std::isnan(order_statistic(histogram, 9)));
}

TEST(Histogram, DoesNotDependOnTheOrderOfItsValues) {
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(0.0005 * (i * i % 97));
  Histogram<double> ordered, shuffled;
  for (const double value : values) ordered.add(value);
  std::shuffle(values.begin(), values.end(), std::mt19937_64(33));
  for (const double value : values) shuffled.add(value);
  EXPECT_EQ(mean(ordered), mean(shuffled));
  EXPECT_EQ(standard_deviation(ordered), standard_deviation(shuffled));
}

}  // namespace
}  // namespace zerocount::statistics
