#include "analysis/basis/statistics/mean_bounds.hpp"

#include "analysis/basis/statistics/change_point.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "core/failure/failure.hpp"
#include "results/reading/export.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

Moments moments_of(const std::vector<double>& values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

TEST(MeanBounds, MatchSciPyForSamplesOfAllSizesAndScales) {
  // Values from the moments to be judged, then the sample: mean sd low high confidence | x1 x2 …
  const testing::TemporaryFolder folder;
  std::ofstream cases(folder / "cases");
  std::mt19937_64 random(71);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 300; ++round) {
    const double scale = std::pow(10.0, -12.0 + 0.07 * round), offset = scale * 10.0 * normal(random);
    const auto size =
        2 + static_cast<std::size_t>(std::exp(7.0 * static_cast<double>(random() % 1000) / 1000));
    std::vector<double> values(size);
    for (double& value : values) value = offset + scale * normal(random);
    const double confidence = std::vector<double>{0.5, 0.9, 0.95, 0.99}[random() % 4];
    const Moments moments = moments_of(values);
    const ConfidenceInterval bounds = student_t(moments, confidence);
    for (const double number : {moments.mean, moments.sd(), bounds.low, bounds.high, confidence})
      cases << reading::number_text(number) << " ";
    for (const double value : values) cases << " " << reading::number_text(value);
    cases << "\n";
  }
  cases.close();
  const std::string command =
      fmt::format("{} {} means {} > {} 2>&1", ZEROCOUNT_PYTHON, ZEROCOUNT_STATISTICS_JUDGE,
                  (folder / "cases").string(), (folder / "out").string());
  EXPECT_EQ(std::system(command.c_str()), 0) << folder.read("out");
  EXPECT_EQ(folder.read("out"), "300 samples\n");
}

TEST(MeanBounds, CoverTheMeanOfANormalDistribution) {
  std::mt19937_64 random(72);
  std::normal_distribution<double> normal(3.0, 2.0);
  constexpr int rounds = 20000;
  int enclosed = 0;
  for (int round = 0; round < rounds; ++round) {
    Moments moments;
    for (int i = 0; i < 4; ++i) moments.add(normal(random));
    const ConfidenceInterval bounds = student_t(moments);
    enclosed += bounds.low <= 3.0 && 3.0 <= bounds.high;
  }
  const double sigma = std::sqrt(rounds * 0.95 * 0.05);
  EXPECT_NEAR(enclosed, 0.95 * rounds, 4.0 * sigma);
}

TEST(MeanBounds, EqualTheMeanIfAllValuesAreEqual) {
  const ConfidenceInterval bounds = student_t(moments_of({2.5, 2.5, 2.5}));
  EXPECT_EQ(bounds.low, 2.5);
  EXPECT_EQ(bounds.high, 2.5);
}

TEST(MeanBounds, AreUndefinedForFewerThanTwoValues) {
  for (const Moments& sample : {moments_of({}), moments_of({1.0}), moments_of({1.0, std::nan("")})}) {
    EXPECT_TRUE(std::isnan(sample.sd()));
    EXPECT_TRUE(std::isnan(student_t(sample).low));
    EXPECT_TRUE(std::isnan(student_t(sample).high));
  }
}

TEST(MeanBounds, RefuseAConfidenceOutsideZeroToOne) {
  EXPECT_THROW(student_t(moments_of({1.0, 2.0}), 1.0), Failure);
  EXPECT_THROW(student_t(moments_of({1.0, 2.0}), 0.0), Failure);
}

RankTrend by_all_pairs(const std::vector<double>& series) {
  RankTrend trend;
  for (std::size_t j = 0; j < series.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      trend.rising += series[j] > series[i];
      trend.falling += series[j] < series[i];
      trend.equal += series[j] == series[i];
    }
  }
  return trend;
}

TEST(Trend, CountsThePairsOfAnySeries) {
  std::mt19937_64 random(41);
  for (int round = 0; round < 200; ++round) {
    std::vector<double> series(random() % 60);
    for (double& value : series)
      value = static_cast<double>(random() % (1 + round));  // with many and with few ties
    const RankTrend expected = by_all_pairs(series), found = rank_trend(series);
    EXPECT_EQ(found.rising, expected.rising);
    EXPECT_EQ(found.falling, expected.falling);
    EXPECT_EQ(found.equal, expected.equal);
  }
}

TEST(Trend, TauMatchesSciPyWithoutTies) {
  // SciPy 1.10: kendalltau(range(n), x) of x_i = (37i² + 11i) mod 1009, i = 1 … n, which has no ties.
  const auto tau = [](int n) {
    std::vector<double> series;
    for (int i = 1; i <= n; ++i) series.push_back((37 * i * i + 11 * i) % 1009);
    return kendall_tau(rank_trend(series));
  };
  EXPECT_NEAR(tau(5), 1.0, 1e-14);
  EXPECT_NEAR(tau(12), 0.2424242424242424, 1e-14);
  EXPECT_NEAR(tau(40), -0.04871794871794872, 1e-14);
}

TEST(Trend, IsAsOftenPositiveAsNegativeForARandomOrder) {
  std::mt19937_64 random(42);
  std::exponential_distribution<double> interval;
  int rising = 0, falling = 0;
  constexpr int rounds = 10000;
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> series(6);
    for (double& value : series) value = interval(random);
    const RankTrend trend = rank_trend(series);
    rising += trend.rising > trend.falling;
    falling += trend.rising < trend.falling;
  }
  EXPECT_NEAR(rising, falling, 4.0 * std::sqrt(rounds));
}

TEST(Trend, OneValueHasNoTrend) {
  EXPECT_TRUE(std::isnan(kendall_tau(rank_trend({}))));
  const std::vector<double> one{1.0};
  EXPECT_TRUE(std::isnan(kendall_tau(rank_trend(one))));
}

/// Bounds by SciPy 1.10: binomtest(k, n).proportion_ci(confidence, method) with methods "exact" and "wilson".
struct ScipyBounds {
  std::int64_t k, n;
  double confidence, exact_low, exact_high, wilson_low, wilson_high;
};
/// SciPy finds the exact ones by a root search to 2e-12.
constexpr ScipyBounds scipy[] = {
    {0, 1, 0.95, 0.0, 0.975, 0.0, 0.7934506856227626},
    {0, 1, 0.99, 0.0, 0.995, 0.0, 0.8690224567198142},
    {1, 1, 0.95, 0.025000000000000022, 1.0, 0.20654931437723745, 1.0},
    {1, 1, 0.99, 0.0050000000000000044, 1.0, 0.13097754328018596, 1.0},
    {0, 10, 0.95, 0.0, 0.30849710781876294, 0.0, 0.27753279986288926},
    {0, 10, 0.99, 0.0, 0.4112959813475254, 0.0, 0.39885409330490806},
    {10, 10, 0.95, 0.6915028921812371, 1.0, 0.7224672001371109, 1.0},
    {10, 10, 0.99, 0.5887040186524746, 1.0, 0.6011459066950919, 1.0},
    {1, 10, 0.95, 0.0025285785444625728, 0.44501611702819543, 0.017876213095072896, 0.4041500267952385},
    {1, 10, 0.99, 0.0005011285754612697, 0.5442870568996879, 0.011851503411032915, 0.5072317712328935},
    {5, 10, 0.95, 0.1870860284474045, 0.8129139715525955, 0.236593090512564, 0.7634069094874361},
    {5, 10, 0.99, 0.12831055393508328, 0.8716894460649167, 0.1842255182472355, 0.8157744817527646},
    {3, 17, 0.95, 0.03798506807045371, 0.4343178728442839, 0.061911266376209945, 0.4102945856883412},
    {3, 17, 0.99, 0.020924344300438498, 0.5104037504950462, 0.045829706544681464, 0.48875679130677463},
    {50, 100, 0.95, 0.3983211295033011, 0.6016788704966989, 0.4038315303659956, 0.5961684696340044},
    {50, 100, 0.99, 0.36886143735890525, 0.6311385626410948, 0.37527962504483986, 0.6247203749551602},
    {999, 1000, 0.95, 0.9944410757201502, 0.9999746825125083, 0.9943574414020421, 0.9998234536293739},
    {999, 1000, 0.99, 0.9925937130616469, 0.9999949874707392, 0.9915394337800183, 0.9998825836463816},
    {950, 1000, 0.95, 0.9346095120845064, 0.9626646023953394, 0.9346861797557491, 0.9618697376072511},
    {950, 1000, 0.99, 0.9294956247985422, 0.9660733372897797, 0.9290930273094663, 0.9649749242774676},
    {1, 1000000, 0.95, 2.5317805139113815e-08, 5.571630655512304e-06, 1.765245767453709e-07,
     5.664911804311442e-06},
    {1, 1000000, 0.99, 5.0123092959924495e-09, 7.430105658143329e-06, 1.174054749996328e-07,
     8.517433834755595e-06},
    {123456, 1000000, 0.95, 0.12281184162963026, 0.12410234027680063, 0.12281269653142284,
     0.12410219641400437},
    {123456, 1000000, 0.99, 0.12260994854073974, 0.12430563653383904, 0.12261115289079928,
     0.12430584373706009},
    {0, 1000000, 0.95, 0.0, 3.688872650897376e-06, 0.0, 3.841444063944942e-06},
    {0, 1000000, 0.99, 0.0, 5.2983033643494575e-06, 0.0, 6.634852579460386e-06},
};

/// Probability of k successes in n independent trials with the success probability p.
double binomial(std::int64_t k, std::int64_t n, double p) {
  const auto a = static_cast<double>(k), b = static_cast<double>(n - k);
  return std::exp(std::lgamma(a + b + 1) - std::lgamma(a + 1) - std::lgamma(b + 1) + a * std::log(p) +
                  b * std::log1p(-p));
}

/// Probability that the confidence interval of a proportion contains the true p, summed over all outcomes of
/// n trials.
double proportion_coverage(ConfidenceInterval (*interval)(std::int64_t, std::int64_t, double), std::int64_t n,
                           double p) {
  double sum = 0.0;
  for (std::int64_t k = 0; k <= n; ++k) {
    const ConfidenceInterval bounds = interval(k, n, 0.95);
    if (bounds.low <= p && p <= bounds.high) sum += binomial(k, n, p);
  }
  return sum;
}

TEST(Proportion, BoundsMatchSciPy) {
  for (const ScipyBounds& reference : scipy) {
    const ConfidenceInterval exact = clopper_pearson(reference.k, reference.n, reference.confidence);
    const ConfidenceInterval score = wilson(reference.k, reference.n, reference.confidence);
    EXPECT_NEAR(exact.low, reference.exact_low, 1e-11) << reference.k << " of " << reference.n;
    EXPECT_NEAR(exact.high, reference.exact_high, 1e-11) << reference.k << " of " << reference.n;
    EXPECT_NEAR(score.low, reference.wilson_low, 1e-13) << reference.k << " of " << reference.n;
    EXPECT_NEAR(score.high, reference.wilson_high, 1e-13) << reference.k << " of " << reference.n;
  }
}

TEST(Proportion, NoSuccessAndAllSuccessesHaveTheirClosedForms) {
  for (const std::int64_t n : {1, 2, 10, 1000, 1000000}) {
    const double bound = -std::expm1(std::log(0.025) / static_cast<double>(n));  // (1 − p)ⁿ = 0.025
    EXPECT_EQ(clopper_pearson(0, n).low, 0.0);
    EXPECT_NEAR(clopper_pearson(0, n).high, bound, 1e-12 * bound);
    EXPECT_NEAR(clopper_pearson(n, n).low, 1.0 - bound, 1e-12);
    EXPECT_EQ(clopper_pearson(n, n).high, 1.0);
    EXPECT_EQ(wilson(0, n).low, 0.0);
    EXPECT_EQ(wilson(n, n).high, 1.0);
  }
}

// Both intervals tend to that of the normal distribution; they differ by some 1/n.
TEST(Proportion, BoundsOfLargeStudiesAgreeWithOneAnother) {
  for (std::int64_t n = 1'000'000'000; n <= 10'000'000'000'000; n *= 10) {
    for (const double p : {1e-4, 0.3, 0.5, 0.999}) {
      const auto k = std::llround(p * static_cast<double>(n));
      const ConfidenceInterval exact = clopper_pearson(k, n), score = wilson(k, n);
      const double close = 1e-2 * (score.high - score.low);
      EXPECT_NEAR(exact.low, score.low, close) << k << " of " << n;
      EXPECT_NEAR(exact.high, score.high, close) << k << " of " << n;
    }
  }
}

TEST(Proportion, IsUnknownWithoutTrials) {
  EXPECT_TRUE(std::isnan(rate(0, 0)));
  for (const ConfidenceInterval bounds : {clopper_pearson(0, 0), wilson(0, 0)}) {
    EXPECT_EQ(bounds.low, 0.0);
    EXPECT_EQ(bounds.high, 1.0);
  }
}

TEST(Proportion, BoundsForSuccessesMirrorThoseForFailures) {
  for (const std::int64_t n : {7, 100, 12345}) {
    for (std::int64_t k = 0; k <= n; k += 1 + n / 7) {
      EXPECT_NEAR(clopper_pearson(k, n).low, 1.0 - clopper_pearson(n - k, n).high, 1e-12);
      EXPECT_NEAR(wilson(k, n).low, 1.0 - wilson(n - k, n).high, 1e-12);
    }
  }
}

TEST(Proportion, ClopperPearsonCoversWithAtLeastItsConfidenceEverywhere) {
  for (const std::int64_t n : {1, 5, 20, 100}) {
    for (int i = 1; i < 200; ++i)
      EXPECT_GE(proportion_coverage(clopper_pearson, n, i / 200.0), 0.95 - 1e-12) << n << ", " << i;
  }
}

TEST(Proportion, WilsonCoversWithItsConfidenceOnAverageAndIsShorter) {
  double sum = 0.0;
  for (int i = 1; i < 200; ++i) sum += proportion_coverage(wilson, 50, i / 200.0);
  EXPECT_NEAR(sum / 199.0, 0.95, 0.01);
  for (std::int64_t k = 5; k <= 45; ++k) {
    const ConfidenceInterval exact = clopper_pearson(k, 50), score = wilson(k, 50);
    EXPECT_LT(score.high - score.low, exact.high - exact.low);
  }
}

TEST(Proportion, ImpossibleCountsAndConfidencesAreRefused) {
  for (const auto& [k, n] : {std::pair<std::int64_t, std::int64_t>{-1, 5}, {6, 5}, {0, -1}}) {
    EXPECT_THROW(clopper_pearson(k, n), Failure);
    EXPECT_THROW(wilson(k, n), Failure);
  }
  for (const double confidence : {0.0, 1.0, -0.5, std::nan("")})
    EXPECT_THROW(clopper_pearson(1, 5, confidence), Failure);
}

}  // namespace
}  // namespace zerocount::statistics
