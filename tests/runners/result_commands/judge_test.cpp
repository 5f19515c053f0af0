// Error bands and the goal, from the manifest to the answer of `judge`.
#include <nlohmann/json.hpp>

#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Json = nlohmann::json;

class Judge : public ProgramTest {
 protected:
  void run_study(const std::string& more, int trials = 40, const std::string& output = "out.h5") {
    folder_.write("study.yaml", small_manifest(trials, more));
    const ProgramResult result = program({"run", "study.yaml", "-o", output, "--force"});
    ASSERT_EQ(result.code, 0) << result.err;
  }
};

// The converter is too weak in 9 of 20 trials. A goal that none meets is not missed for that reason.
TEST_F(Judge, SaturationIsNamedWhereTheMovesThatMissSaturate) {
  const std::string axis =
      "zerocount: 1\nname: slide\naxis: linear\nseed: 1\ntrials: 20\nplant: {inertia: 1, sliding_damping: "
      "1}\n"
      "friction: {model: coulomb, breakaway: 1, coulomb_ratio: 1, stribeck_velocity: 1.0e-3}\n"
      "encoder: {resolution: 1.0e-6}\ncommand: {targets: [20000], hold: 0.5}\n"
      "controller: {units: si, sample_rate: 4000, kp: 1.0e+4, ki: 2.0e+4, kd: 180}\n"
      "dac: {bits: 24, range: {choice: [2, 400]}}\n";
  const auto judged = [&](const std::string& within) {
    folder_.write("slide.yaml", axis + "goal: {band: 700, within: " + within + ", moves: 0.9}\n");
    EXPECT_EQ(program({"run", "slide.yaml", "-o", "slide.h5", "--force"}).code, 0);
    return std::pair(program({"judge", "slide.h5"}).out, json_of({"judge", "slide.h5"}));
  };
  const auto [weak, of_weak] = judged("0.2");
  EXPECT_EQ(of_weak["missed_saturated"], 1.0) << weak;
  EXPECT_TRUE(says(weak, "9 moves that miss the goal 9 saturate (of the 11 others 0): the converter clips"));
  const auto [hasty, of_hasty] = judged("0.001");
  EXPECT_LT(of_hasty["missed_saturated"], 0.5) << hasty;
  EXPECT_FALSE(says(hasty, "saturate"));
}

TEST_F(Judge, StatisticsDoNotDependOnWhatTheFileKeeps) {
  const std::string more = "rigs: 8\ngoal: {band: 3, within: 0.1, moves: 0.6, machines: 0.5}\n";
  run_study(more);
  run_study(more + "keep: statistics\n", 40, "sums.h5");
  for (const char* verb : {"summary", "judge"}) {
    Json kept = json_of({verb, "out.h5"}), sums = json_of({verb, "sums.h5"});
    EXPECT_EQ(kept, sums) << verb;
    EXPECT_FALSE(kept.is_discarded());
  }
  const Json point = json_of({"summary", "sums.h5"})["points"][0];
  ASSERT_EQ(point["bands"].size(), 3U);
  EXPECT_EQ(point["bands"][2]["band"], 3);
  EXPECT_EQ(point["bands"][0]["settling_time"]["median"], point["final_settling_time"]["median"]);
  EXPECT_EQ(point["bands"][0]["entry_time"]["p95"], point["settling_time"]["p95"]);
  EXPECT_EQ(point["bands"][0]["exits"]["total"], point["jerk_count"]["total"]);
}

TEST_F(Judge, EndsWithTheCodeOfTheVerdict) {
  struct Case {
    const char* goal;
    const char* status;
    int code;
  };
  for (const Case& one : {Case{"{band: 1000, within: 0.14, moves: 0.8}", "met", 0},
                          Case{"{band: 0, within: 0.0005, moves: 0.99}", "missed", 1},
                          Case{"{band: 1000, within: 0.14, moves: 0.999}", "undecided", 3}}) {
    run_study(std::string("goal: ") + one.goal + "\n");
    const Json judged = json_of({"judge", "out.h5"});
    EXPECT_EQ(judged["status"], one.status) << judged;
    EXPECT_EQ(program({"judge", "out.h5"}).code, one.code);
    EXPECT_EQ(judged["needed"].is_null(), one.code != 3) << judged;
    const Json of_point =
        json_of({"summary", "out.h5"})["points"][judged["point"].get<std::size_t>()]["goal"];
    EXPECT_EQ(of_point["rate"], judged["rate"]);
    EXPECT_GE(of_point["rate_low"], judged["rate_low"]);  // it was not chosen
    const Json alone = json_of({"judge", "out.h5", "--point", judged["point"].dump()});
    EXPECT_EQ(of_point["rate_low"], alone["rate_low"]);
    EXPECT_EQ(of_point["status"], alone["status"]);
  }
}

TEST_F(Judge, NeedsAGoalAndAFinishedFile) {
  run_study("");
  EXPECT_TRUE(says(refusal({"judge", "out.h5"}), "no goal; expected"));
  EXPECT_EQ(program({"judge", "out.h5", "--point", "2"}).code, 2);
  run_study("goal: {within: 0.1, moves: 0.9}\n");
  EXPECT_EQ(program({"judge", "out.h5", "--point", "2"}).code, 2);
  ASSERT_EQ(program({"run", "study.yaml", "-o", "part.h5", "--shard", "1/2"}).code, 0);
  EXPECT_EQ(program({"judge", "part.h5"}).code, 4);
  std::filesystem::create_directory(folder_.path() / "begun.h5.shards");
  ASSERT_EQ(program({"run", "study.yaml", "-o", "begun.h5.shards/first.h5", "--shard", "1/2"}).code, 0);
  EXPECT_TRUE(says(refusal({"judge", "begun.h5"}, 4), "begun.h5: unfinished"));
}

TEST_F(Judge, PlansTheStudyThatDecidesTheGoal) {
  run_study("goal: {band: 1, within: 0.05, moves: 0.99}\n");
  const Json plan = json_of({"plan", "study.yaml"});
  EXPECT_GT(plan["plans"][0]["trials"].get<int>(), 40) << plan;
  const Json of_pilot = json_of({"plan", "out.h5"});
  const Json judged = json_of({"judge", "out.h5"});
  EXPECT_EQ(of_pilot["status"], judged["status"]);
  EXPECT_EQ(of_pilot["needed"], judged["needed"]);
  const Json set = json_of({"plan", "study.yaml", "--set", "goal.moves=0.5"});
  EXPECT_LT(set["plans"][0]["trials"], plan["plans"][0]["trials"]);
  run_study("");
  for (const char* operand : {"study.yaml", "out.h5"}) {
    EXPECT_TRUE(says(refusal({"plan", operand}), "its manifest has no goal"));
  }
}

}  // namespace
}  // namespace zerocount::testing
