// `zerocount history` on results files: what it adds is what `summary` says, once, and by many processes.

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

using nlohmann::json;

class HistoryCommand : public ProgramTest {
 protected:
  void SetUp() override {
    folder_.write("study.yaml", small_manifest(40));
    run("first.h5");
  }

  /// Runs the study with a fixed k1 in place of a profile along the rotor. The seed of a profile would be
  /// part of what decides whether runs are comparable.
  void run(const std::string& file, const std::string& setting = "seed=3") {
    ASSERT_EQ(program({"run", "study.yaml", "--set", "friction.k1=110", "--set", setting, "-o", file}).code,
              0);
  }

  json series_shown() {
    const ProgramResult shown = program({"history", "show", "--format", "json"});
    EXPECT_EQ(shown.code, 0) << shown.err;
    json series = json::parse(shown.out).at("series");
    EXPECT_FALSE(series.empty());
    return series;
  }
};

TEST_F(HistoryCommand, HasTheValuesAndBoundsOfTheSummary) {
  const ProgramResult added = program({"history", "add", "first.h5"});
  EXPECT_EQ(added.code, 0) << added.err;
  const json summary = json::parse(program({"summary", "first.h5", "--format", "json"}).out);
  int compared = 0;
  for (const json& series : series_shown()) {
    const json& value = series.at("runs").at(0);
    for (const json& point : summary.at("points")) {
      if (point.at("label") != series.at("point")) continue;
      if (series.at("measure") == "success_rate") {
        EXPECT_EQ(value.at("value"), point.at("success_rate"));
        EXPECT_EQ(value.at("value_low"), point.at("success_rate_low"));
        EXPECT_EQ(value.at("value_high"), point.at("success_rate_high"));
        ++compared;
      }
      if (series.at("measure") == "arrival_time" || series.at("measure") == "jerk_count") {
        const json& statistics = point.at(series.at("measure").get<std::string>());
        EXPECT_EQ(value.at("value"), statistics.at("mean"));
        EXPECT_EQ(value.at("value_low"), statistics.at("mean_low"));
        EXPECT_EQ(value.at("value_high"), statistics.at("mean_high"));
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 6);
}

TEST_F(HistoryCommand, AddsAFileOnceAndItsComparison) {
  run("second.h5");
  ASSERT_NE(program({"compare", "first.h5", "second.h5", "--json", "compared.json"}).code, 2);
  EXPECT_EQ(program({"history", "add", "second.h5"}).code, 0);
  EXPECT_TRUE(says(program({"history", "add", "second.h5"}).err, "nothing to do"));
  EXPECT_EQ(program({"history", "add", "second.h5", "--compare", "compared.json"}).code, 0);
  for (const json& series : series_shown()) {
    ASSERT_EQ(series.at("runs").size(), 1U);
    const bool settling = series.at("measure") == "arrival_time";  // may have too few values to be judged
    if (settling) continue;
    EXPECT_EQ(series.at("runs")[0].at("comparison").at("verdict"), "equivalent");
  }
  const ProgramResult other = program({"history", "add", "first.h5", "--compare", "compared.json"});
  if (folder_.read("first.h5") != folder_.read("second.h5")) {  // they may be of the same second
    EXPECT_EQ(other.code, 2) << other.err;
    EXPECT_TRUE(says(other.err, "compares another run"));
  }
  folder_.write("no.json", "{\"current\": 1}");
  EXPECT_EQ(program({"history", "add", "first.h5", "--compare", "no.json"}).code, 4);
  EXPECT_EQ(program({"history", "add", "first.h5", "--compare", "none.json"}).code, 2);
}

// Another seed or number of trials asks the same question; another gain does not.
TEST_F(HistoryCommand, RunsOfOneQuestionFormOneSeries) {
  run("seed.h5", "seed=4");
  run("trials.h5", "trials=30");
  run("gain.h5", "controller.kp=1.0e-4");
  for (const char* file : {"first.h5", "seed.h5", "trials.h5", "gain.h5"})
    ASSERT_EQ(program({"history", "add", file}).code, 0);
  for (const json& series : series_shown())
    EXPECT_EQ(series.at("runs").size(), series.at("runs")[0].at("seed") == "42" ? 1U : 3U) << series;
}

// What is drawn once per study is another axis with another seed.
TEST_F(HistoryCommand, TheSeedSeparatesSeriesIfItDecidesTheAxis) {
  const std::string drawn = "friction.k2={uniform: [600, 900], per: study}";
  for (const std::string& setting : {std::string("friction.n=2"), drawn}) {  // the first: with its profile
    for (const int seed : {1, 2}) {
      const std::string file = fmt::format("{}{}.h5", setting == drawn, seed);
      std::vector<std::string> words{"run",   "study.yaml", "--set", fmt::format("seed={}", seed),
                                     "--set", setting,      "-o",    file};
      if (setting == drawn) words.insert(words.end(), {"--set", "friction.k1=110"});
      ASSERT_EQ(program(words).code, 0);
      ASSERT_EQ(program({"history", "add", file}).code, 0);
    }
  }
  for (const json& series : series_shown()) EXPECT_EQ(series.at("runs").size(), 1U);
}

TEST_F(HistoryCommand, ConcurrentProcessesLoseNoRun) {
  std::vector<std::string> files;
  for (int i = 0; i < 6; ++i) {
    files.push_back(fmt::format("run{}.h5", i));
    run(files.back(), fmt::format("seed={}", 10 + i));
  }
  std::vector<std::unique_ptr<RunningProgram>> adding;
  for (const std::string& file : files) {
    adding.push_back(
        std::make_unique<RunningProgram>(std::vector<std::string>{"history", "add", file}, folder_.path()));
  }
  for (const auto& one : adding) EXPECT_EQ(one->wait(), 0);
  for (const json& series : series_shown()) EXPECT_EQ(series.at("runs").size(), files.size());
}

TEST_F(HistoryCommand, PlotsASeriesAndAPageOfAll) {
  ASSERT_EQ(program({"history", "add", "first.h5"}).code, 0);
  const std::vector<std::string> one{"history", "plot", "--point", "low", "--measure", "success_rate", "-o"};
  const auto plot = [&](const std::string& output) {
    std::vector<std::string> words = one;
    words.push_back(output);
    return program(words);
  };
  EXPECT_EQ(plot("a.svg").code, 0);
  EXPECT_EQ(folder_.read("a.svg").find("<svg"), 0U);
  EXPECT_EQ(plot("a.svg").code, 2) << "it exists already";
  EXPECT_EQ(plot("a.pdf").code, 2);
  EXPECT_EQ(program({"history", "plot", "-o", "b.svg"}).code, 2) << "a picture of several series";
  EXPECT_EQ(program({"history", "plot", "-o", "all.html"}).code, 0);
  EXPECT_TRUE(says(folder_.read("all.html"), "small, high: jerk_count over time"));
  EXPECT_EQ(program({"history", "plot", "-o", "history.sqlite", "--force"}).code, 2);
}

TEST_F(HistoryCommand, IsASectionOfTheReport) {
  const auto page_of = [&](const std::string& file) {
    EXPECT_EQ(program({"report", file, "--history", "history.sqlite", "-o", "page.html", "--force"}).code, 0);
    return folder_.read("page.html");
  };
  ASSERT_EQ(program({"history", "add", "first.h5"}).code, 0);
  EXPECT_TRUE(says(page_of("first.h5"), "The history has fewer than two runs of this study."));
  run("second.h5", "seed=4");
  run("other.h5", "controller.kp=1.0e-4");
  ASSERT_EQ(program({"history", "add", "second.h5"}).code, 0);
  EXPECT_TRUE(says(page_of("first.h5"), "small, low: success_rate over time"));
  EXPECT_TRUE(says(page_of("other.h5"), "The history has fewer than two runs of this study."));
  EXPECT_EQ(program({"report", "first.h5", "--history", "none.sqlite", "-o", "c.html"}).code, 2);
}

TEST_F(HistoryCommand, RefusesInvalidOptionsAndFiles) {
  EXPECT_EQ(program({"history"}).code, 2);
  EXPECT_EQ(program({"history", "remove"}).code, 2);
  EXPECT_EQ(program({"history", "add"}).code, 2);
  EXPECT_EQ(program({"history", "show", "first.h5"}).code, 2);
  EXPECT_EQ(program({"history", "add", "first.h5", "--point", "a"}).code, 2);
  EXPECT_EQ(program({"history", "show"}).code, 2);
  EXPECT_EQ(program({"history", "show", "--database", "first.h5"}).code, 4);
  EXPECT_EQ(program({"history", "add", "first.h5", "--database", "no/folder/history.sqlite"}).code, 5);
  folder_.write(
      "levels.yaml",
      "zerocount: 1\nname: levels\nseed: 1\ntrials: 1\ncommand: {torque: {levels: [0.001]}, hold: 0.2}\n");
  ASSERT_EQ(program({"run", "levels.yaml", "-o", "levels.h5"}).code, 0);
  EXPECT_EQ(program({"history", "add", "levels.h5"}).code, 3) << "it measured nothing that a history has";
}

// The answers of monitor to a growing log are a series of each measure, which changed where its p says so.
TEST_F(HistoryCommand, AddsAnswersOfMonitor) {
  std::string before = "arrival_time [ms]\n";
  for (int i = 0; i < 300; ++i) before += fmt::format("{}\n", 40 + (7 * i) % 11);
  folder_.write("before.csv", before);
  std::string moves = "arrival_time [ms]\n";
  for (int week = 0; week < 4; ++week) {
    for (int i = 0; i < 100; ++i) moves += fmt::format("{}\n", (week < 2 ? 40 : 52) + (7 * i) % 11);
    folder_.write("moves.csv", moves);
    const ProgramResult answer = program({"monitor", "before.csv", "moves.csv", "--format", "json"});
    const std::string name = fmt::format("week-{}.json", week);
    folder_.write(name, answer.out);
    EXPECT_EQ(program({"history", "add", name}).code, 0);
  }
  EXPECT_TRUE(says(program({"history", "add", "week-0.json"}).err, "already in"));
  const json series = series_shown();
  ASSERT_EQ(series.size(), 1u);
  EXPECT_EQ(series[0].at("study"), "monitor of before.csv");
  EXPECT_EQ(series[0].at("point"), "moves.csv");
  EXPECT_EQ(series[0].at("measure"), "arrival_time");
  ASSERT_EQ(series[0].at("runs").size(), 4u);
  folder_.write("other.json", "{\"answer\": \"judge\"}");
  EXPECT_EQ(program({"history", "add", "other.json"}).code, 2);
  folder_.write("broken.json", "{");
  EXPECT_EQ(program({"history", "add", "broken.json"}).code, 4);
}

}  // namespace
}  // namespace zerocount::testing
