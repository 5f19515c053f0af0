// The summary of a run that has not ended: of its finished trials, and it says so.
#include <csignal>

#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

class UnfinishedSummary : public ProgramTest {
 protected:
  fs::path at(const std::string& name) const { return folder_.path() / name; }

  void complete(const std::string& output, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"run", "study.yaml", "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = program(words);
    ASSERT_EQ(result.code, 0) << result.err;
  }

  /// Runs the i-th of four parts of the study, whose results become a finished shard of out.h5.
  void finish_quarter(int i) {
    fs::create_directories(at("out.h5.shards"));
    const std::string name = "quarter" + std::to_string(i) + ".h5";
    complete(name, {"--shard", std::to_string(i) + "/4"});
    fs::rename(at(name), at("out.h5.shards") / name);
  }

  nlohmann::json summary_of(const std::string& file) { return json_of({"summary", file}, 0); }
};

TEST_F(UnfinishedSummary, HasTheStatisticsOfTheTrialsThatAreFinished) {
  for (const char* groups : {"", "machines: 30\n", "worlds: 7\n"}) {
    SCOPED_TRACE(groups);
    folder_.write("study.yaml", small_manifest(60, groups));
    complete("half.h5", {"--set", "trials=30", "--force"});
    complete("whole.h5", {"--force"});
    fs::remove_all(at("out.h5.shards"));
    for (const int quarter : {1, 2, 3}) finish_quarter(quarter);
    const nlohmann::json summary = summary_of("out.h5");
    EXPECT_EQ(summary["unfinished"], (nlohmann::json{{"finished", 90}, {"trials", 120}}));
    ASSERT_EQ(summary["points"].size(), 2U);
    EXPECT_EQ(summary["points"][0], summary_of("whole.h5")["points"][0]);
    EXPECT_EQ(summary["points"][1], summary_of("half.h5")["points"][1]);
    EXPECT_FALSE(summary_of("whole.h5").contains("unfinished"));
  }
}

TEST_F(UnfinishedSummary, UsesTrialsBehindAGap) {
  folder_.write("study.yaml", small_manifest(60));
  for (const int quarter : {1, 4}) finish_quarter(quarter);
  const nlohmann::json summary = summary_of("out.h5");
  EXPECT_EQ(summary["unfinished"]["finished"], 60);
  ASSERT_EQ(summary["points"].size(), 2U);
  EXPECT_EQ(summary["points"][1]["trials"], 30);
}

// Their numbers tell the machine or world of a trial.
TEST_F(UnfinishedSummary, WithMachinesOrWorldsOmitsTrialsBehindAGap) {
  for (const char* groups : {"machines: 30\n", "worlds: 7\n"}) {
    SCOPED_TRACE(groups);
    fs::remove_all(at("out.h5.shards"));
    folder_.write("study.yaml", small_manifest(60, groups));
    for (const int quarter : {1, 4}) finish_quarter(quarter);
    const nlohmann::json summary = summary_of("out.h5");
    EXPECT_EQ(summary["unfinished"]["finished"], 30);
    ASSERT_EQ(summary["points"].size(), 1U);
    EXPECT_EQ(summary["points"][0]["label"], "low");
    EXPECT_TRUE(says(program({"summary", "out.h5"}).out, "1 of 2 points have none yet"));
    EXPECT_EQ(summary["points"][0]["trials"], 30);
  }
}

TEST_F(UnfinishedSummary, CountsTheMachinesThatHaveTrials) {
  folder_.write("study.yaml", small_manifest(60, "machines: 60\n"));
  finish_quarter(1);
  const nlohmann::json point = summary_of("out.h5")["points"][0];
  EXPECT_EQ(point["trials"], 30);
  EXPECT_EQ(point["machines"]["n"], 30);
  // Each has one trial.
  EXPECT_EQ(point["machines"]["without_failure"], point["success_rate"]);
}

TEST_F(UnfinishedSummary, APointWithoutTrialsHasUnknownRates) {
  const std::string observed = "observed: {low: {successes: 19, of: 20}, high: {successes: 0, of: 12}}\n";
  for (const char* more : {"", "machines: 30\n", "keep: statistics\n"}) {
    SCOPED_TRACE(more);
    folder_.write("study.yaml", small_manifest(60, more + observed));
    fs::remove_all(at("out.h5.shards"));
    finish_quarter(3);
    const nlohmann::json summary = summary_of("out.h5");
    ASSERT_EQ(summary["points"].size(), 2U);
    EXPECT_EQ(summary["points"][0]["trials"], 0);
    EXPECT_TRUE(summary["points"][0]["success_rate"].is_null());
    EXPECT_EQ(summary["points"][1]["trials"], 30);
    const ProgramResult table = program({"summary", "out.h5"});
    EXPECT_EQ(table.code, 0) << table.err;
    EXPECT_TRUE(says(table.out, "1 of 2 points have none yet"));
    for (const char* text : {"nan", "in 0 trials", "of 0", " 0 machines", "as any result"})
      EXPECT_FALSE(says(table.out, text));
  }
}

TEST_F(UnfinishedSummary, IsAvailableDuringARunAndAfterAnInterruption) {
  folder_.write("study.yaml", small_manifest(200000));
  RunningProgram run({"run", "study.yaml", "-o", "out.h5", "--threads", "1"}, folder_.path());
  run.wait_for_shards(at("out.h5.shards"));
  const ProgramResult during = program({"summary", "out.h5"});
  run.send(SIGINT);
  EXPECT_EQ(run.wait(), 130);
  EXPECT_EQ(during.code, 0) << during.err;
  EXPECT_TRUE(says(during.out, "unfinished", "of 400000 trials"));
  const ProgramResult after = program({"summary", "out.h5", "--format", "csv"});
  EXPECT_EQ(after.code, 0) << after.err;
  EXPECT_FALSE(says(after.out, "unfinished"));
  EXPECT_TRUE(says(after.err, "unfinished"));
}

// The points of a sweep take turns: whoever looks while it runs can compare all of them.
TEST_F(UnfinishedSummary, AnInterruptedSweepHasNearlyEqualNumbersOfTrialsPerPoint) {
  folder_.write("study.yaml", small_manifest(400000, "machines: 20\nkeep: statistics\n"));
  const std::vector<std::string> sweep{
      "run",
      "study.yaml",
      "-o",
      "out.h5",
      "--threads",
      "1",
      "--engine",
      "reference",
      "--set",
      "sweep={cases: {a: {controller.ki: 3.0e-5}, b: {controller.ki: 3.2e-5}, "
      "c: {controller.ki: 3.4e-5}}}"};
  RunningProgram run(sweep, folder_.path());
  run.wait_for_shards(at("out.h5.shards"), 3);
  run.send(SIGINT);
  EXPECT_EQ(run.wait(), 130);
  const nlohmann::json summary = summary_of("out.h5");
  ASSERT_EQ(summary["points"].size(), 3U);
  std::vector<std::int64_t> trials;
  for (const nlohmann::json& point : summary["points"]) trials.push_back(point["trials"]);
  const auto [fewest, most] = std::minmax_element(trials.begin(), trials.end());
  EXPECT_GT(*fewest, 0);
  EXPECT_LE(*most, 3 * *fewest);
  EXPECT_EQ(trials[0] + trials[1] + trials[2], summary["unfinished"]["finished"]);
  const ProgramResult status = program({"status", "out.h5"});
  EXPECT_EQ(status.code, 0) << status.err;
  EXPECT_FALSE(says(status.out, "have none yet"));
}

TEST_F(UnfinishedSummary, IsRefusedIfNoTrialIsFinished) {
  folder_.write("study.yaml", small_manifest(20));
  fs::create_directories(at("out.h5.shards"));
  EXPECT_TRUE(says(refusal({"summary", "out.h5"}, 4), "no trial of this run is finished yet"));
}

TEST_F(UnfinishedSummary, DamagedOrForeignShardsAreRefusedByName) {
  folder_.write("study.yaml", small_manifest(20));
  finish_quarter(1);
  complete("quarter2.h5", {"--shard", "2/4", "--set", "seed=43"});
  fs::rename(at("quarter2.h5"), at("out.h5.shards/quarter2.h5"));
  EXPECT_TRUE(says(refusal({"summary", "out.h5"}, 4), "quarter2.h5"));
  folder_.write("out.h5.shards/quarter2.h5", "damaged");
  EXPECT_TRUE(says(refusal({"summary", "out.h5"}, 4), "quarter2.h5"));
}

// A study with early decision from its manifest to its summary: the same outcomes as without, what was
// stopped is told, and a trial replays.

class EarlyDecision : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder.emplace();
    folder->write("study.yaml", small_manifest(40, "retain: {trials: [3]}\n"));
    ASSERT_EQ(run({"run", "study.yaml", "-o", "whole.h5"}).code, 0);
    const ProgramResult stopped = run(with_stop({"run", "study.yaml", "-o", "early.h5"}));
    ASSERT_EQ(stopped.code, 0) << stopped.err;
  }
  static void TearDownTestSuite() { folder.reset(); }

  static ProgramResult run(const std::vector<std::string>& words) {
    return zerocount_program(words, folder->path());
  }
  static std::vector<std::string> with_stop(std::vector<std::string> words) {
    words.insert(words.end(), {"--set", "verdict.stop=true", "--set", "verdict.limit=100"});
    return words;
  }
  static std::vector<double> measure(const char* file, const char* name) {
    const reading::AllTrialsFile study(*folder / file);
    return study.measure(name, study.rows());
  }
  static double stopped_trials() {
    const std::vector<double> stopped = measure("early.h5", "stopped");
    return static_cast<double>(std::count(stopped.begin(), stopped.end(), 1.0));
  }

  static inline std::optional<TemporaryFolder> folder;
};

TEST_F(EarlyDecision, KeepsTheOutcomesAndMarksStoppedTrials) {
  for (const char* name : {"outcome", "stable", "arrived", "arrival"})
    EXPECT_EQ(measure("whole.h5", name), measure("early.h5", name)) << name;
  EXPECT_GT(stopped_trials(), 20);
  EXPECT_LT(stopped_trials(), 60);
  const std::vector<double> outcomes = measure("early.h5", "outcome");
  const std::vector<double> stopped = measure("early.h5", "stopped");
  for (std::size_t row = 0; row < stopped.size(); ++row) {
    if (stopped[row] == 0.0) continue;
    EXPECT_EQ(outcomes[row], static_cast<double>(trial::Outcome::oscillating)) << row;
  }
}

// Real measures of a move that was not run are NaN, and its file is read all the same.
TEST_F(EarlyDecision, MovesAfterADivergedMoveReadBackAsNotRun) {
  std::vector<std::string> words = with_stop({"run", "study.yaml", "-o", "moves.h5"});
  words.insert(words.end(), {"--set", "command.targets=[20, 0]"});
  const ProgramResult result = run(words);
  ASSERT_EQ(result.code, 0) << result.err;
  const std::vector<double> times = measure("moves.h5", "travel_time");
  EXPECT_GT(std::count_if(times.begin(), times.end(), [](double time) { return std::isnan(time); }), 0);
  EXPECT_EQ(run({"summary", "moves.h5"}).code, 0);
}

TEST_F(EarlyDecision, AddsNoColumnIfItIsNotUsed) {
  EXPECT_FALSE(reading::AllTrialsFile(*folder / "whole.h5").root().open_group("outcome").contains("stopped"));
  EXPECT_TRUE(reading::AllTrialsFile(*folder / "early.h5").root().open_group("outcome").contains("stopped"));
  EXPECT_FALSE(says(run({"summary", "whole.h5"}).out, "stopped"));
  EXPECT_FALSE(says(run({"summary", "whole.h5", "--format", "csv"}).out, "stopped"));
  EXPECT_FALSE(says(run({"summary", "whole.h5", "--format", "json"}).out, "stopped"));
}

TEST_F(EarlyDecision, IsCountedInTheSummaryAndInThePoints) {
  const auto json = nlohmann::json::parse(run({"summary", "early.h5", "--format", "json"}).out);
  double in_json = 0, in_file = 0;
  for (const auto& point : json["points"]) in_json += point["stopped"].get<double>();
  for (const layout::PointColumn& column : reading::AllTrialsFile(*folder / "early.h5").statistics()) {
    if (column.name != "stopped") continue;
    for (const double value : column.values) in_file += value;
  }
  EXPECT_EQ(in_json, stopped_trials());
  EXPECT_EQ(in_file, stopped_trials());
  EXPECT_TRUE(says(run({"summary", "early.h5"}).out, " stopped "));
  EXPECT_TRUE(says(run({"summary", "early.h5", "--format", "csv"}).out, ",stopped,"));
  ASSERT_EQ(run({"export", "early.h5", "-o", "tables"}).code, 0);
  EXPECT_TRUE(says(folder->read("tables/outcomes.csv"), ",stopped,"));
}

TEST_F(EarlyDecision, TracesAndRecordsEndWithTheTrial) {
  const std::string whole = run({"trace", "whole.h5", "--point", "1", "--trial", "3"}).out;
  const ProgramResult early = run({"trace", "early.h5", "--point", "1", "--trial", "3"});
  EXPECT_EQ(early.code, 0) << early.err;
  EXPECT_EQ(run(with_stop({"trace", "study.yaml", "--point", "1", "--trial", "3"})).out, early.out);
  ASSERT_LT(early.out.size(), whole.size());
  EXPECT_EQ(whole.substr(0, early.out.size()), early.out);

  const reading::AllTrialsFile file(*folder / "early.h5");
  const auto lines = std::count(early.out.begin(), early.out.end(), '\n') - 1;
  EXPECT_EQ(file.trace_count(), 300 + lines);  // that trial of the other point is not stopped
  const layout::TraceRecord last = file.trace_at(file.trace_count() - 1, 1)[0];
  EXPECT_EQ(last.k, lines - 1);
  EXPECT_GT(std::abs(last.error), 100);
}

}  // namespace
}  // namespace zerocount::testing
