// The test for a change of level: how often it is wrong, and what it finds.
#include "analysis/statistics/change_point.hpp"

#include "tests/analysis/history/change_simulation.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using statistics::LevelChange;
using statistics::Measurement;
using statistics::MeasurementKind;

double constant_level(int) {
  return 0.0;
}

// 1000 histories, each of 100 nights: at most 5 % may have an alarm, so that more than 71 have one with a
// probability of 0.1 % (binomial).
constexpr int histories = 1000;
constexpr int max_alarms = 71;

TEST(ChangePoint, OfNothingAlarmsAsOftenAsStated) {
  const int one = alarms(normal_series(100, constant_level), 1, histories, 1);
  EXPECT_LE(one, max_alarms);
  EXPECT_GE(one, 20);  // and it is not so cautious that it finds nothing
  EXPECT_LE(alarms(normal_series(100, constant_level), 10, histories, 2), max_alarms);
}

TEST(ChangePoint, OfSkewedValuesAlarmsNoMoreOften) {
  for (const double p : {0.85, 0.98, 0.999})
    EXPECT_LE(alarms(binomial_series(100, 200, [p](int) { return p; }), 1, histories, 3), max_alarms) << p;
  EXPECT_LE(alarms(exponential_series(100, 100), 1, histories / 2, 4), max_alarms / 2 + 8);
}

// Nights with one seed share their errors: their number is no evidence.
TEST(ChangePoint, OfRunsWithTheSameDrawsAlarmsNoMoreOften) {
  EXPECT_LE(alarms(normal_series(100, constant_level, 5), 1, histories, 5), max_alarms);
  EXPECT_LE(alarms(normal_series(100, constant_level, 50), 1, histories, 6), max_alarms);
}

TEST(ChangePoint, FindsAStepAndWhereItIs) {
  const auto level = [](int night) { return night < 30 ? 0.0 : 3.0; };
  const FoundChanges found = found_changes(normal_series(60, level), 30, 30, 300, 7);
  EXPECT_GT(found.found, 0.97);
  EXPECT_LE(found.median_delay, 5.0);
  std::mt19937_64 generator(8);
  int near = 0;
  for (int i = 0; i < 200; ++i) {
    const auto changes = statistics::level_changes(
        MeasurementKind::mean, normal_series(60, level).make(generator), statistics::change_threshold(1e-4));
    near += !changes.empty() && changes.front().first >= 29 && changes.front().first <= 31 ? 1 : 0;
  }
  EXPECT_GT(near, 180);
}

TEST(ChangePoint, FindsASlowDrift) {
  const auto level = [](int night) { return night < 30 ? 0.0 : 0.1 * (night - 29); };
  EXPECT_GT(found_changes(normal_series(130, level), 30, 30, 200, 9).found, 0.97);
}

TEST(ChangePoint, FindsTwoChangesOneAfterTheOther) {
  std::vector<Measurement> series;
  for (std::size_t i = 0; i < 60; ++i) series.push_back({i < 20 ? 0.0 : i < 40 ? 5.0 : -5.0, 1.0, 1.0, i});
  const auto changes = statistics::level_changes(MeasurementKind::mean, series, 4.5);
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_EQ(changes[0].first, 20U);
  EXPECT_GT(changes[0].z, 0.0);
  EXPECT_EQ(changes[1].first, 40U);
  EXPECT_DOUBLE_EQ(changes[1].before, 5.0);
  EXPECT_DOUBLE_EQ(changes[1].after, -5.0);
  EXPECT_LT(changes[1].z, 0.0);
}

// The same from the definition, for two levels of which one is known in closed form.
TEST(ChangePoint, HasTheLikelihoodRatioOfItsDefinition) {
  // 30 of 100, then 60 of 200: 2·ln of the likelihoods at 0.3 and 0.3 against 0.3 is 0; then 90 of 100.
  const std::vector<Measurement> rates{{0.3, 100.0, 1.0, 0}, {0.3, 200.0, 1.0, 1}, {0.9, 100.0, 2.5, 2}};
  const auto found = statistics::level_changes(MeasurementKind::proportion, rates, 1.0);
  ASSERT_EQ(found.size(), 1U);
  const auto likelihood = [](double k, double n, double p) {
    return k * std::log(p) + (n - k) * std::log(1.0 - p);
  };
  const double ratio =
      2.0 * (likelihood(90, 300, 0.3) + likelihood(90, 100, 0.9) - likelihood(180, 400, 0.45));
  EXPECT_NEAR(found[0].z, std::sqrt(ratio / 1.5), 1e-12);  // 1.5: average design effect
  const std::vector<Measurement> means{{1.0e9, 4.0, 9.0, 0}, {1.0e9 + 8.0, 12.0, 9.0, 1}};
  const auto step = statistics::level_changes(MeasurementKind::mean, means, 1.0);
  ASSERT_EQ(step.size(), 1U);
  EXPECT_NEAR(step[0].z, 8.0 / (3.0 * std::sqrt(1.0 / 4.0 + 1.0 / 12.0)), 1e-9);
  EXPECT_DOUBLE_EQ(step[0].after, 1.0e9 + 8.0);
}

TEST(ChangePoint, SeesNothingInEqualValues) {
  const std::vector<Measurement> equal(500, Measurement{0.37, 200.0, 0.8, 0});
  EXPECT_TRUE(statistics::level_changes(MeasurementKind::mean, equal, 0.1).empty());
  const std::vector<Measurement> certain(500, Measurement{1.0, 200.0, 1.0, 0});
  EXPECT_TRUE(statistics::level_changes(MeasurementKind::proportion, certain, 0.1).empty());
  EXPECT_TRUE(statistics::level_changes(MeasurementKind::mean, {}, 0.1).empty());
}

// One seed: two sides are two measurements, however many nights they have.
TEST(ChangePoint, CountsRunsWithTheSameDrawsAsOne) {
  std::vector<Measurement> series;
  for (int i = 0; i < 80; ++i) series.push_back({i < 40 ? 0.0 : 3.0, 1.0, 1.0, 0});
  EXPECT_TRUE(statistics::level_changes(MeasurementKind::mean, series, 3.0).empty());
  const auto found = statistics::level_changes(MeasurementKind::mean, series, 2.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].z, 3.0 / std::sqrt(2.0), 1e-12);
}

TEST(ChangePoint, HasAThresholdThatGrowsAsAlarmsBecomeRare) {
  EXPECT_NEAR(statistics::change_threshold(5.0e-4), 3.926, 0.001);  // the integral by an independent program
  EXPECT_GT(statistics::change_threshold(1.0e-6), statistics::change_threshold(1.0e-5));
}

TEST(ChangePoint, TakesMeasurementsFromBounds) {
  const auto mean = statistics::measured_mean(5.0, 100.0, {4.0, 6.0}, 0.95);
  ASSERT_TRUE(mean);
  EXPECT_NEAR(mean->dispersion / mean->size, std::pow(1.0 / 1.959963984540054, 2), 1e-9);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(statistics::measured_mean(5.0, 100.0, {nan, nan}, 0.95));
  EXPECT_FALSE(statistics::measured_mean(5.0, 100.0, {5.0, 5.0}, 0.95));
  const auto plain = statistics::clopper_pearson(30, 100);
  EXPECT_DOUBLE_EQ(statistics::measured_proportion(0.3, 100.0, plain, 0.95)->dispersion, 1.0);
  const double width = plain.high - plain.low;
  EXPECT_NEAR(statistics::measured_proportion(0.3, 100.0, {0.3 - width, 0.3 + width}, 0.95)->dispersion, 4.0,
              1e-9);
}

}  // namespace
}  // namespace zerocount::testing
