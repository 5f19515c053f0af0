// Edge cases and invariants of the estimators; that they are right is shown by judges and simulations.
#include "analysis/trials/sensitivity/correlations.hpp"
#include "analysis/trials/sensitivity/sobol_indices.hpp"
#include "core/failure/failure.hpp"
#include "tests/analysis/trials/sensitivity/test_functions.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sensitivity {
namespace {

constexpr random::RandomStream any_stream{{1, 2}, 0};

SaltelliSample g_sample(std::size_t rows) {
  return testing::sample_of(testing::g_function, testing::drawn_points("saltelli", 3, 5 * rows, 1));
}

// No change in N rows says that a change has at most the probability 1 − 0.025^(1/N), 3.7/N.
TEST(SaltelliIndices, AFactorWithoutEffectHasZeroIndicesWithAnUpperBound) {
  SaltelliSample sample = g_sample(100);
  sample.c[1] = sample.a;
  const SobolIndices none = saltelli_indices(sample, 0.95, any_stream)[1];
  for (const BoundedNumber& number : {none.first_order, none.total}) {
    EXPECT_EQ(number.value, 0.0);
    EXPECT_EQ(number.low, 0.0);
    EXPECT_NEAR(number.high, std::log(40.0) / 100.0, 1e-12);
    EXPECT_FALSE(excludes_up_to(0.0, number));
  }
}

// 100 rows, of A the first 20 yes, of B every fifth: p = 0.2 and V = 0.16.
SaltelliSample yes_no_sample() {
  SaltelliSample sample;
  for (int r = 0; r < 100; ++r) {
    sample.a.push_back(r < 20 ? 1.0 : 0.0);
    sample.b.push_back(r % 5 == 0 ? 1.0 : 0.0);
  }
  sample.c = {sample.a, sample.b, sample.a};
  sample.c[2][50] = 1.0;
  return sample;
}

TEST(SaltelliIndices, BoundsForABinaryOutputKeepAWidth) {
  const auto [none, all, little] = [] {
    const auto found = saltelli_indices(yes_no_sample(), 0.95, any_stream);
    return std::array{found[0], found[1], found[2]};
  }();
  const double unseen_of_yes = 1.0 - std::pow(0.025, 1.0 / 20.0);
  const double unseen_of_no = 1.0 - std::pow(0.025, 1.0 / 80.0);
  const double unseen = unseen_of_yes / (2.0 - unseen_of_yes) + unseen_of_no / (2.0 - unseen_of_no);
  EXPECT_EQ(none.total.value, 0.0);
  EXPECT_EQ(none.total.low, 0.0);
  EXPECT_NEAR(none.total.high, unseen, 1e-12);
  EXPECT_EQ(none.first_order.low, 0.0);
  EXPECT_NEAR(none.first_order.high, unseen, 1e-12) << "not above the total";
  EXPECT_NEAR(all.first_order.value, 1.0, 1e-12);
  EXPECT_NEAR(all.first_order.low, 1.0 - unseen, 1e-12);
  EXPECT_EQ(all.first_order.high, 1.0);
  EXPECT_GT(little.total.low, 0.0) << "one row that differs is proof";
  EXPECT_NEAR(little.total.value, 0.01 / (2.0 * 0.205 * 0.795), 1e-12);
}

TEST(SaltelliIndices, AConstantOutputHasNoIndices) {
  SaltelliSample sample = yes_no_sample();
  sample.a.assign(100, 0.0);
  sample.c[0] = sample.a;
  const SobolIndices nothing = saltelli_indices(sample, 0.95, any_stream)[0];
  for (const BoundedNumber& number : {nothing.total, nothing.first_order})
    EXPECT_TRUE(std::isnan(number.value) && std::isnan(number.low) && std::isnan(number.high));
}

// D of pairs written out, over all tables of 12 pairs.
TEST(BinaryTotalIndex, IsHalfTheMeanSquareDifferenceOverTheVariance) {
  for (std::int64_t yes = 0; yes <= 12; ++yes) {
    for (std::int64_t different = 0; yes + different <= 12; ++different) {
      const BoundedNumber found = yes_no_difference({yes, different, 12 - yes - different}, 0.95);
      const double p = (static_cast<double>(yes) + 0.5 * static_cast<double>(different)) / 12.0;
      if (p == 0.0 || p == 1.0) {
        EXPECT_TRUE(std::isnan(found.high));
        continue;
      }
      EXPECT_NEAR(found.value, static_cast<double>(different) / 24.0 / (p * (1.0 - p)), 1e-12);
      EXPECT_EQ(found.low > 0.0, different > 0);
      EXPECT_GT(found.high - found.low, 0.1);
    }
  }
}

TEST(ClampedIndex, ClampsTheBoundsWithTheEstimate) {
  const auto expect = [](const BoundedNumber& number, double value, double low, double high) {
    const BoundedNumber held = clamped_index(number);
    EXPECT_NEAR(held.value, value, 1e-12);
    EXPECT_NEAR(held.low, low, 1e-12);
    EXPECT_NEAR(held.high, high, 1e-12);
  };
  expect({0.3, 0.2, 0.5}, 0.3, 0.2, 0.5);
  expect({0.1, -0.1, 0.3}, 0.1, 0.0, 0.3);
  expect({-0.2, -0.3, -0.1}, 0.0, 0.0, 0.1);
  expect({1.25, 1.125, 1.5}, 1.0, 0.9, 1.0);
  EXPECT_TRUE(std::isnan(clamped_index({std::nan(""), 0.0, 1.0}).high));
}

TEST(SaltelliIndices, AFunctionOfOneFactorHasTheIndexOne) {
  SaltelliSample sample = g_sample(500);
  sample.c = {sample.b};
  const SobolIndices all = saltelli_indices(sample, 0.95, any_stream)[0];
  EXPECT_NEAR(all.first_order.value, 1.0, 0.1);
  EXPECT_NEAR(all.total.value, 1.0, 0.1);
}

TEST(SaltelliIndices, DoNotDependOnScaleAndOriginOfTheOutput) {
  const SaltelliSample sample = g_sample(300);
  SaltelliSample moved = sample;
  const auto move = [](std::vector<double>& values) {
    for (double& value : values) value = -1e-6 * value + 5.0;
  };
  move(moved.a);
  move(moved.b);
  for (std::vector<double>& values : moved.c) move(values);
  const auto before = saltelli_indices(sample, 0.95, any_stream);
  const auto after = saltelli_indices(moved, 0.95, any_stream);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_NEAR(after[j].first_order.value, before[j].first_order.value, 1e-6);
    EXPECT_NEAR(after[j].total.low, before[j].total.low, 1e-6);
    EXPECT_NEAR(after[j].total.high, before[j].total.high, 1e-6);
  }
}

TEST(SaltelliIndices, BoundsDependOnlyOnTheSeedAndEncloseTheValue) {
  const SaltelliSample sample = g_sample(6000);  // more rows than groups
  const auto once = saltelli_indices(sample, 0.95, any_stream);
  const auto again = saltelli_indices(sample, 0.95, any_stream);
  const auto other = saltelli_indices(sample, 0.95, {{1, 3}, 0});
  const auto wider = saltelli_indices(sample, 0.99, any_stream);
  int by_seed = 0;  // bounds by rows drawn anew, and not by the influence of the rows alone
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_EQ(once[j].total.low, again[j].total.low);
    by_seed += once[j].total.low != other[j].total.low || once[j].total.high != other[j].total.high ||
               once[j].first_order.low != other[j].first_order.low ||
               once[j].first_order.high != other[j].first_order.high;
    EXPECT_LT(once[j].total.low, once[j].total.value);
    EXPECT_GT(once[j].total.high, once[j].total.value);
    EXPECT_GT(wider[j].total.high - wider[j].total.low, once[j].total.high - once[j].total.low);
  }
  EXPECT_GT(by_seed, 0);
}

// Rows drawn in groups of neighbours give as wide bounds as rows drawn one by one.
TEST(SaltelliIndices, GroupingDoesNotChangeTheWidthOfTheBounds) {
  const auto width = [](std::size_t rows) {
    const BoundedNumber total = saltelli_indices(g_sample(rows), 0.95, any_stream)[0].total;
    return (total.high - total.low) * std::sqrt(static_cast<double>(rows));
  };
  EXPECT_NEAR(width(4096) / width(16384), 1.0, 0.15);
}

TEST(SaltelliIndices, AreUndefinedWithoutVariance) {
  const SaltelliSample flat{{1, 1, 1}, {1, 1, 1}, {{1, 2, 1}}};
  EXPECT_TRUE(std::isnan(saltelli_indices(flat, 0.95, any_stream)[0].total.value));
}

TEST(MidDistribution, IsTheMeanRankLessAHalf) {
  EXPECT_EQ(mid_distribution(std::vector<double>{3, 1, 1, 2}),
            (std::vector<double>{0.875, 0.25, 0.25, 0.625}));
}

std::vector<double> counting(std::size_t n) {
  std::vector<double> values(n);
  std::iota(values.begin(), values.end(), 0.0);
  return values;
}

TEST(RankCorrelation, DependsOnlyOnTheOrder) {
  const std::vector<double> x = counting(40);
  std::vector<double> rising;
  std::vector<double> falling;
  for (const double value : x) {
    rising.push_back(std::exp(value));
    falling.push_back(-value * value * value);
  }
  EXPECT_NEAR(rank_correlation(x, rising, 0.95).value, 1.0, 1e-14);
  EXPECT_NEAR(rank_correlation(x, falling, 0.95).value, -1.0, 1e-14);
  EXPECT_TRUE(std::isnan(rank_correlation(x, std::vector<double>(40, 2.0), 0.95).value));
  EXPECT_TRUE(std::isnan(rank_correlation(counting(9), counting(9), 0.95).value));
}

TEST(PartialRankCorrelations, AreUndefinedForACollinearInput) {
  const auto points = testing::drawn_points("monte_carlo", 2, 200, 2);
  Eigen::MatrixXd x(200, 3);
  std::vector<double> y;
  for (Eigen::Index i = 0; i < 200; ++i) {
    const std::vector<double>& u = points[static_cast<std::size_t>(i)];
    x.row(i) << u[0], u[1], 2.0 * u[0];
    y.push_back(u[0] + 0.1 * u[1]);
  }
  const auto found = partial_rank_correlations(x, y, 0.95);
  EXPECT_GT(found[0].low, 0.9);
  EXPECT_GT(found[1].low, 0.0);
  EXPECT_TRUE(std::isnan(found[2].value));
}

TEST(IndependentColumns, OmitCollinearColumns) {
  Eigen::MatrixXd x = Eigen::MatrixXd::Random(50, 4);
  x.col(2) = x.col(0) - 3.0 * x.col(1);
  EXPECT_EQ(independent_columns(x).places, (std::vector<std::size_t>{0, 1, 3}));
}

TEST(GivenDataFirstOrder, IsExactForADiscreteInput) {
  // Three values of x with the means 0, 1, 2 of y, and ±1 about them: V = 2/3 + 1.
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < 600; ++i) {
    x.push_back(i % 3);
    y.push_back(i % 3 + (i / 3 % 2 == 0 ? 1.0 : -1.0));
  }
  EXPECT_NEAR(given_data_first_order(x, y, 0.95).value, 0.4, 0.005);
  EXPECT_TRUE(std::isnan(given_data_first_order(std::vector<double>(600, 1.0), y, 0.95).value));
  EXPECT_TRUE(std::isnan(given_data_first_order(x, std::vector<double>(600, 1.0), 0.95).value));
  EXPECT_EQ(given_data_first_order(x, x, 0.95).value, 1.0);
}

LogisticFit fit_of(const std::vector<double>& x, const std::vector<double>& yes) {
  return logistic_fit(Eigen::VectorXd::Map(x.data(), std::ssize(x)),
                      Eigen::VectorXd::Map(yes.data(), std::ssize(yes)), 0.95);
}

TEST(LogisticFit, DetectsSeparatedTrials) {
  const std::vector<double> x = counting(40);
  std::vector<double> yes(40, 0.0);
  std::fill(yes.begin() + 25, yes.end(), 1.0);
  EXPECT_EQ(fit_of(x, yes).status, LogisticFit::Status::separated);
  EXPECT_TRUE(std::isnan(fit_of(x, yes).slopes[0].value));
  std::vector<double> shared = x;  // yes and no at the border, separated but for that
  shared[25] = shared[24];
  EXPECT_EQ(fit_of(shared, yes).status, LogisticFit::Status::separated);
  std::swap(yes[20], yes[30]);
  EXPECT_EQ(fit_of(x, yes).status, LogisticFit::Status::fitted);
  EXPECT_GT(fit_of(x, yes).slopes[0].value, 0.0);
}

TEST(LogisticFit, NeedsEnoughTrialsOfBothOutcomes) {
  EXPECT_EQ(fit_of(counting(40), std::vector<double>(40, 1.0)).status, LogisticFit::Status::too_few);
  EXPECT_EQ(fit_of({1, 2, 3, 4}, {0, 1, 0, 1}).status, LogisticFit::Status::too_few);
}

}  // namespace
}  // namespace zerocount::sensitivity
