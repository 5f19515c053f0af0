// Runs as series, and the runs and commits at which they changed.
#include "analysis/history/series.hpp"

#include <nlohmann/json.hpp>

#include "core/failure/failure.hpp"
#include "tests/analysis/history/runs.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using history::History;
using history::RunRecord;

/// 60 nights with fresh seeds; from night `change` on, b succeeds in 70 % in place of 50 %.
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
  EXPECT_TRUE(series_of(history, "a", "settling_time").changes.empty());
  const history::Series& b = series_of(history, "b", "success_rate");
  ASSERT_EQ(b.changes.size(), 1U);
  EXPECT_NEAR(static_cast<double>(b.changes[0].first), 40.0, 1.0);
  EXPECT_LE(b.changes[0].significant, 46U);
  const std::string sentence = b.changes[0].sentence;
  EXPECT_NE(sentence.find("rose from"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find(runs[b.changes[0].first].created), std::string::npos) << sentence;
  EXPECT_NE(sentence.find(runs[b.changes[0].first].git_commit.substr(0, 10)), std::string::npos) << sentence;
  EXPECT_NE(text_of(history).find(sentence), std::string::npos);
}

TEST(HistorySeries, HaveEachRunOnce) {
  const History history = history::history_of(nights_with_step(40));
  for (const history::Series& series : history.series) {
    ASSERT_EQ(series.runs.size(), history.series[0].runs.size());
    for (std::size_t i = 0; i < series.runs.size(); ++i)
      EXPECT_EQ(series.runs[i].run, history.series[0].runs[i].run) << "memory would grow with points squared";
  }
}

TEST(HistorySeries, ShowOnlyWhatIsAskedFor) {
  const std::vector<RunRecord> runs = nights_with_step(40);
  const History one = history::history_of(runs, {"gains", "b", "success_rate"});
  ASSERT_EQ(one.series.size(), 1U);
  EXPECT_LT(one.threshold, history::history_of(runs).threshold) << "fewer series allow a lower threshold";
  const std::string text = text_of(one);
  for (const RunRecord& run : runs) EXPECT_NE(text.find(run.created), std::string::npos);
  try {
    history::history_of(runs, {"gains", "nowhere"});
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_input);
    EXPECT_NE(std::string(failure.what()).find("the points a, b"), std::string::npos) << failure.what();
  }
}

TEST(HistorySeries, StartAnewWhereTheManifestChanged) {
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
TEST(HistorySeries, SeeNoEvidenceInEqualRuns) {
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

TEST(HistorySeries, NameTheBaselineWhereTheFirstRunDiffersFromIt) {
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
  EXPECT_NE(series.changes[0].sentence.find("between the baseline of 2025-12-31"), std::string::npos);
}

// A null history of one seed whose code changes every night at random: p-values are uniform.
TEST(HistorySeries, OfOneSeedAlarmAsOftenAsStated) {
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

TEST(HistorySeries, AreWrittenForMachines) {
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

}  // namespace
}  // namespace zerocount::testing
