// Runs as series, and the runs and commits at which they changed.
#include "analysis/pairs/history/series.hpp"

#include <nlohmann/json.hpp>

#include "analysis/basis/statistics/change_point.hpp"
#include "tests/analysis/pairs/history/change_simulation.hpp"
#include "tests/analysis/pairs/history/runs.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using history::History;
using history::RunRecord;

/// The runs of 60 nights, each with a fresh seed; from night `change` on, point b succeeds in 70 % instead of
/// 50 % of its trials.
std::vector<RunRecord> nights_with_step(int change) {
  std::mt19937_64 generator(3);
  std::vector<RunRecord> runs;
  for (int day = 0; day < 60; ++day) {
    std::binomial_distribution<int> a(200, 0.9);
    std::binomial_distribution<int> b(200, day < change ? 0.5 : 0.7);
    runs.push_back(run_of_day(day, a(generator) / 200.0, b(generator) / 200.0));
  }
  return runs;
}

const history::Series& series_of(const History& history, const std::string& point,
                                 const std::string& measure) {
  for (const history::Series& series : history.series) {
    if (series.point == point && series.measure == measure) return series;
  }
  throw std::out_of_range("no such series");
}

std::string text_of(const History& history) {
  return document::text(history::history_answer().of(history));
}

TEST(HistorySeries, NameTheCommitOfAStep) {
  const std::vector<RunRecord> runs = nights_with_step(40);
  const History history = history::history_of(runs);
  ASSERT_EQ(history.series.size(), 3U);
  EXPECT_TRUE(series_of(history, "a", "success_rate").changes.empty());
  EXPECT_TRUE(series_of(history, "a", "arrival_time").changes.empty());
  const history::Series& b = series_of(history, "b", "success_rate");
  ASSERT_EQ(b.changes.size(), 1U);
  EXPECT_NEAR(static_cast<double>(b.changes[0].first), 40.0, 1.0);
  EXPECT_LE(b.changes[0].significant, 46U);
  const std::string sentence = b.changes[0].sentence;
  EXPECT_TRUE(says(sentence, "rose from", runs[b.changes[0].first].created,
                   runs[b.changes[0].first].git_commit.substr(0, 10)));
  EXPECT_TRUE(says(text_of(history), sentence));
}

TEST(HistorySeries, HaveEachRunOnce) {
  const History history = history::history_of(nights_with_step(40));
  for (const history::Series& series : history.series) {
    ASSERT_EQ(series.runs.size(), history.series[0].runs.size());
    for (std::size_t i = 0; i < series.runs.size(); ++i)
      EXPECT_EQ(series.runs[i].run, history.series[0].runs[i].run) << "memory would grow with points squared";
  }
}

TEST(HistorySeries, ShowOnlyTheSelectedSeries) {
  const std::vector<RunRecord> runs = nights_with_step(40);
  const History one = history::history_of(runs, {"gains", "b", "success_rate"});
  ASSERT_EQ(one.series.size(), 1U);
  EXPECT_LT(one.threshold, history::history_of(runs).threshold) << "fewer series allow a lower threshold";
  const std::string text = text_of(one);
  for (const RunRecord& run : runs) EXPECT_TRUE(says(text, run.created));
  EXPECT_TRUE(says(refusal_by([&] { history::history_of(runs, {"gains", "nowhere"}); }), "the points a, b"));
}

TEST(HistorySeries, StartAgainAfterAChangedManifest) {
  std::vector<RunRecord> runs = nights_with_step(30);
  for (std::size_t i = 30; i < runs.size(); ++i) runs[i].series_sha256 = "another";
  const History history = history::history_of(runs);
  EXPECT_EQ(history.series.size(), 6U);
  for (const history::Series& series : history.series) {
    EXPECT_EQ(series.runs.size(), 30U);
    EXPECT_TRUE(series.changes.empty());
  }
}

// Equal seeds and equal code give equal values: any number of them is no evidence.
TEST(HistorySeries, EqualRunsAreNoEvidenceOfAChange) {
  std::vector<RunRecord> runs;
  for (int day = 0; day < 100; ++day) {
    runs.push_back(run_of_day(day, day < 50 ? 0.5 : 0.6));
    runs.back().seed = "7";
  }
  for (const history::Series& series : history::history_of(runs).series) {
    EXPECT_EQ(series.test, history::SeriesTest::levels);
    EXPECT_TRUE(series.changes.empty());
  }
}

// With one seed and a comparison each night, the paired test of that comparison is the evidence.
TEST(HistorySeries, JudgeRunsOfOneSeedByTheBaseline) {
  std::vector<RunRecord> runs;
  for (int day = 0; day < 50; ++day) {
    runs.push_back(run_of_day(day, day < 20 ? 0.5 : 0.5 + 0.002 * (day - 19)));
    runs.back().seed = "7";
    compare_with_baseline(runs.back(), day < 20 ? 1.0 : std::pow(0.5, day - 19));
  }
  const History history = history::history_of(runs, {{}, "a", "success_rate"});
  const history::Series& series = history.series.front();
  EXPECT_EQ(series.test, history::SeriesTest::baseline);
  EXPECT_DOUBLE_EQ(history.max_p, 0.05 / 100.0);
  ASSERT_EQ(series.changes.size(), 1U);
  EXPECT_EQ(series.changes[0].significant, 30U);  // 2⁻¹¹ < 0.0005
  EXPECT_GT(series.changes[0].first, 20U);
  EXPECT_FALSE(series.changes[0].since_baseline);
}

TEST(HistorySeries, NameTheBaselineIfTheFirstRunDiffersFromIt) {
  std::vector<RunRecord> runs{run_of_day(0, 0.6), run_of_day(1, 0.6)};
  for (RunRecord& run : runs) {
    run.seed = "7";
    compare_with_baseline(run, 1e-9);
  }
  const History history = history::history_of(runs, {{}, "a", "success_rate"});
  const history::Series& series = history.series.front();
  ASSERT_EQ(series.changes.size(), 1U);
  EXPECT_TRUE(series.changes[0].since_baseline);
  EXPECT_EQ(series.changes[0].first, 0U);
  EXPECT_TRUE(says(series.changes[0].sentence, "between the baseline of 2025-12-31"));
}

// A null history of one seed whose code changes every night at random: p-values are uniform.
TEST(HistorySeries, RunsWithOneSeedRaiseFalseAlarmsAsOftenAsStated) {
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> uniform;
  std::vector<RunRecord> runs;
  for (int day = 0; day < 100; ++day) {
    runs.push_back(run_of_day(day, 0.5));
    runs.back().seed = "7";
    compare_with_baseline(runs.back(), 1.0);
  }
  int alarms = 0;
  for (int history = 0; history < 1000; ++history) {
    for (RunRecord& run : runs) {
      for (history::RunValue& value : run.values) value.comparison->p = uniform(generator);
    }
    bool alarm = false;
    for (const history::Series& series : history::history_of(runs).series) alarm |= !series.changes.empty();
    alarms += alarm ? 1 : 0;
  }
  EXPECT_LE(alarms, 71);
  EXPECT_GE(alarms, 29);
}

TEST(HistorySeries, JsonHasEverySeries) {
  const History history = history::history_of(nights_with_step(40));
  const document::Answer answer = history::history_answer().of(history);
  const auto json = document::json(answer);
  ASSERT_EQ(json.at("series").size(), 3U);
  EXPECT_EQ(json.at("series")[0].at("runs").size(), 60U);
  const std::string csv = document::csv(answer);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * 60);
  int changes = 0;
  for (const auto& series : json.at("series")) {
    for (const auto& change : series.at("changes")) {
      ++changes;
      EXPECT_FALSE(change.at("first_run_after").at("git_commit").get<std::string>().empty());
    }
  }
  EXPECT_EQ(changes, 1);
}

// The test for a change of level: how often it is wrong, and what it finds.

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

TEST(ChangePoint, RaisesFalseAlarmsAsOftenAsStated) {
  const int one = alarms(normal_series(100, constant_level), 1, histories, 1);
  EXPECT_LE(one, max_alarms);
  EXPECT_GE(one, 20);  // and it is not so cautious that it finds nothing
  EXPECT_LE(alarms(normal_series(100, constant_level), 10, histories, 2), max_alarms);
}

TEST(ChangePoint, SkewedValuesRaiseNoMoreFalseAlarms) {
  for (const double p : {0.85, 0.98, 0.999})
    EXPECT_LE(alarms(binomial_series(100, 200, [p](int) { return p; }), 1, histories, 3), max_alarms) << p;
  EXPECT_LE(alarms(exponential_series(100, 100), 1, histories / 2, 4), max_alarms / 2 + 8);
}

// Nights with one seed share their errors: their number is no evidence.
TEST(ChangePoint, RunsWithTheSameDrawsRaiseNoMoreFalseAlarms) {
  EXPECT_LE(alarms(normal_series(100, constant_level, 5), 1, histories, 5), max_alarms);
  EXPECT_LE(alarms(normal_series(100, constant_level, 50), 1, histories, 6), max_alarms);
}

TEST(ChangePoint, FindsAStepAndItsPlace) {
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

// The likelihood ratio follows from its definition where the maximum is known in closed form.
TEST(ChangePoint, StatisticEqualsTheLikelihoodRatioOfItsDefinition) {
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

TEST(ChangePoint, FindsNothingInEqualValues) {
  const std::vector<Measurement> equal(500, Measurement{0.37, 200.0, 0.8, 0});
  EXPECT_TRUE(statistics::level_changes(MeasurementKind::mean, equal, 0.1).empty());
  const std::vector<Measurement> certain(500, Measurement{1.0, 200.0, 1.0, 0});
  EXPECT_TRUE(statistics::level_changes(MeasurementKind::proportion, certain, 0.1).empty());
  EXPECT_TRUE(statistics::level_changes(MeasurementKind::mean, {}, 0.1).empty());
}

// One seed: two sides are two measurements, however many nights they have.
TEST(ChangePoint, RunsWithTheSameDrawsCountAsOne) {
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
