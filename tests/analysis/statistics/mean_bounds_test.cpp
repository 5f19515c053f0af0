#include "analysis/statistics/mean_bounds.hpp"

#include "core/failure/failure.hpp"
#include "results/reading/csv.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

Moments moments_of(const std::vector<double>& values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

TEST(MeanBounds, AreSciPysForSamplesOfAllSizesAndScales) {
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
    for (const double number : {moments.mean, moments.sd(), bounds.low, bounds.high, confidence}) {
      cases << reading::number_text(number) << " ";
    }
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

TEST(MeanBounds, EncloseTheMeanOfANormalDistributionAsOftenAsTheySay) {
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

TEST(MeanBounds, OfEqualValuesAreTheMean) {
  const ConfidenceInterval bounds = student_t(moments_of({2.5, 2.5, 2.5}));
  EXPECT_EQ(bounds.low, 2.5);
  EXPECT_EQ(bounds.high, 2.5);
}

TEST(MeanBounds, OfFewerThanTwoValuesAreNotKnown) {
  for (const Moments& sample : {moments_of({}), moments_of({1.0}), moments_of({1.0, std::nan("")})}) {
    EXPECT_TRUE(std::isnan(sample.sd()));
    EXPECT_TRUE(std::isnan(student_t(sample).low));
    EXPECT_TRUE(std::isnan(student_t(sample).high));
  }
}

TEST(MeanBounds, RefuseAConfidenceThatIsNone) {
  EXPECT_THROW(student_t(moments_of({1.0, 2.0}), 1.0), Failure);
  EXPECT_THROW(student_t(moments_of({1.0, 2.0}), 0.0), Failure);
}

}  // namespace
}  // namespace zerocount::statistics
