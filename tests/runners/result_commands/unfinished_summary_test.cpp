// The summary of a run that has not ended: of its finished trials, and it says so.
#include <csignal>

#include <nlohmann/json.hpp>

#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

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

  /// Makes the I-th of four parts of the study a finished shard of out.h5.
  void finish_quarter(int i) {
    fs::create_directories(at("out.h5.shards"));
    const std::string name = "quarter" + std::to_string(i) + ".h5";
    complete(name, {"--shard", std::to_string(i) + "/4"});
    fs::rename(at(name), at("out.h5.shards") / name);
  }

  nlohmann::json summary_of(const std::string& file) { return json_of({"summary", file}, 0); }
};

TEST_F(UnfinishedSummary, HasTheStatisticsOfTheTrialsThatAreFinished) {
  for (const char* groups : {"", "rigs: 30\n", "worlds: 7\n"}) {
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

TEST_F(UnfinishedSummary, TakesTrialsThatOthersAreMissingBefore) {
  folder_.write("study.yaml", small_manifest(60));
  for (const int quarter : {1, 4}) finish_quarter(quarter);
  const nlohmann::json summary = summary_of("out.h5");
  EXPECT_EQ(summary["unfinished"]["finished"], 60);
  ASSERT_EQ(summary["points"].size(), 2U);
  EXPECT_EQ(summary["points"][1]["trials"], 30);
}

// Their numbers tell the rig or world of a trial.
TEST_F(UnfinishedSummary, OfRigsOrWorldsLeavesOutTrialsThatOthersAreMissingBefore) {
  for (const char* groups : {"rigs: 30\n", "worlds: 7\n"}) {
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

TEST_F(UnfinishedSummary, WhereAPointHasNoTrialYetItsRatesAreUnknown) {
  const std::string observed = "observed: {low: {successes: 19, of: 20}, high: {successes: 0, of: 12}}\n";
  for (const char* more : {"", "rigs: 30\n", "keep: statistics\n"}) {
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
    for (const char* text : {"nan", "in 0 trials", "of 0", " 0 rigs", "as any result"})
      EXPECT_FALSE(says(table.out, text));
  }
}

TEST_F(UnfinishedSummary, IsThereWhileTheRunGoesOnAndAfterItWasInterrupted) {
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
TEST_F(UnfinishedSummary, OfAnInterruptedSweepComparesAllPointsByNearlyAsManyTrials) {
  folder_.write("study.yaml", small_manifest(400000, "rigs: 20\nkeep: statistics\n"));
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

TEST_F(UnfinishedSummary, OfARunThatHasFinishedNothingIsRefused) {
  folder_.write("study.yaml", small_manifest(20));
  fs::create_directories(at("out.h5.shards"));
  EXPECT_TRUE(says(refusal({"summary", "out.h5"}, 4), "no trial of this run is finished yet"));
}

TEST_F(UnfinishedSummary, OfDamagedOrForeignShardsIsRefusedWithTheirName) {
  folder_.write("study.yaml", small_manifest(20));
  finish_quarter(1);
  complete("quarter2.h5", {"--shard", "2/4", "--set", "seed=43"});
  fs::rename(at("quarter2.h5"), at("out.h5.shards/quarter2.h5"));
  EXPECT_TRUE(says(refusal({"summary", "out.h5"}, 4), "quarter2.h5"));
  folder_.write("out.h5.shards/quarter2.h5", "damaged");
  EXPECT_TRUE(says(refusal({"summary", "out.h5"}, 4), "quarter2.h5"));
}

}  // namespace
}  // namespace zerocount::testing
