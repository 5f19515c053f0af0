// `zerocount compare` and `zerocount baseline` from the command line.

#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/marked_text.hpp"

namespace zerocount::testing {
namespace {

/// Manifest with two cases: one that always succeeds, and one that has the given gain.
std::string gains(const std::string& gain, int trials, const std::string& seed = "3") {
  return "zerocount: 1\nname: gains\nseed: " + seed + "\ntrials: " + std::to_string(trials) +
         "\nfriction: {beta: 2.0e+5, k2: {uniform: [600, 900]}}\n"
         "command: {targets: [{integers: [1, 10]}], hold: 0.15}\n"
         "initial: {encoder_phase: {uniform: [0, 1]}}\n"
         "verdict: {dwell: 0.02, window: 0.02}\n"
         "sweep: {cases: {low: {controller.ki: 3.0e-5}, high: {controller.ki: " +
         gain + "}}}\n";
}

class Compare : public ProgramTest {
 protected:
  void study(const std::string& name, const std::string& manifest,
             const std::vector<std::string>& more = {}) {
    folder_.write(name + ".yaml", manifest);
    std::vector<std::string> words{"run", name + ".yaml", "-q", "-o", name + ".h5"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = program(words);
    ASSERT_EQ(result.code, 0) << result.err;
  }
  nlohmann::json compared(const std::string& one, const std::string& other, int code) {
    const ProgramResult result = program({"compare", one + ".h5", other + ".h5", "--format", "json"});
    EXPECT_EQ(result.code, code) << result.out << result.err;
    return nlohmann::json::parse(result.out);
  }
};

// Without machines there are no machines to count: the moves are judged. 60 trials leave the goal open.
TEST_F(Compare, AGoalOnMachinesIsJudgedByMovesIfTheOtherStudyHasNoMachines) {
  const std::string goal = "goal: {band: 1, within: 0.03, moves: 0.9";
  study("machines", gains("3.5e-5", 60) + goal + ", machines: 0.8}\nmachines: 30\n", {"--force"});
  study("alone", gains("3.5e-5", 60) + goal + "}\n", {"--force"});
  for (const ProgramResult& result :
       {program({"compare", "machines.h5", "alone.h5"}), program({"compare", "alone.h5", "machines.h5"})}) {
    EXPECT_EQ(result.code, 3) << result.out << result.err;
    EXPECT_TRUE(says(result.out, "goal_rate"));
    EXPECT_FALSE(says(result.out, "goal_machines"));
  }
}

// A gain with which moves come in late fails, although zero counts and jerks would pass it.
TEST_F(Compare, JudgesAStudyWithAGoalOnlyByTheGoal) {
  const std::string goal = "goal: {band: 1, within: 0.022, moves: 0.9}\n";
  study("a", gains("3.5e-5", 300) + goal, {"--force"});
  study("b", gains("2.2e-5", 300) + "goal: {band: 1, within: 0.03, moves: 0.9}\n", {"--force"});
  study("slow", gains("3.5e-5", 300) + goal, {"--force", "--set", "controller.delay=1.5"});
  study("plain", gains("3.5e-5", 300), {"--force"});
  const auto measures_of = [](const nlohmann::json& json) {
    std::vector<std::string> names;
    for (const auto& measure : json["points"][0]["measures"]) names.push_back(measure["measure"]);
    return names;
  };
  const std::vector<std::string> of_goal{"goal_rate", "goal_settling_time"};
  const nlohmann::json better = compared("a", "b", 0);
  EXPECT_EQ(measures_of(better), of_goal);
  EXPECT_TRUE(says(better["notes"].dump(), "judged by that of a.h5")) << better["notes"];
  const nlohmann::json worse = compared("a", "slow", 1);
  EXPECT_EQ(measures_of(worse), of_goal);
  EXPECT_EQ(worse["points"][0]["measures"][1]["verdict"], "worse");
  EXPECT_EQ(worse["points"][0]["goal"]["baseline"], "met");
  EXPECT_EQ(measures_of(compared("plain", "a", 0)), of_goal);  // of either manifest
  EXPECT_EQ(measures_of(compared("plain", "plain", 0)).size(), 5u);

  const ProgramResult points = program({"compare", "a.h5", "--points", "low", "high"});
  EXPECT_TRUE(says(points.out, "goal_settling_time"));
  EXPECT_FALSE(says(points.out, "jerk_count"));
  const ProgramResult junit = program({"compare", "a.h5", "slow.h5", "--format", "junit"});
  EXPECT_TRUE(says(junit.out, "name=\"low: goal_settling_time\"><failure"));
  const ProgramResult markdown = program({"compare", "a.h5", "slow.h5", "--format", "markdown"});
  EXPECT_TRUE(says(markdown.out, "low goal\\_settling\\_time | worse |"));
  program({"report", "slow.h5", "-o", "slow.html", "--baseline", "a.h5"});
  EXPECT_TRUE(says(folder_.read("slow.html"), "goal_settling_time"));

  folder_.write("others.yaml", "measures: [stable_rate]\n");
  const ProgramResult others = program({"compare", "a.h5", "slow.h5", "--margins", "others.yaml"});
  EXPECT_TRUE(says(others.out, "low stable_rate"));
  EXPECT_FALSE(says(others.out, "goal"));
  folder_.write("goal.yaml", "measures: [goal_rate]\n");
  EXPECT_TRUE(says(refusal({"compare", "plain.h5", "plain.h5", "--margins", "goal.yaml"}),
                   "plain.h5: its manifest has no goal"));
  study("wide", gains("3.5e-5", 300) + "goal: {band: 3, within: 0.022, moves: 0.9}\n", {"--force"});
  EXPECT_TRUE(
      says(refusal({"compare", "plain.h5", "wide.h5"}, 4), "plain.h5: it cannot be judged by the goal"));
}

// The verdict of the goal is that of judge, the quantile of a band that of the stored statistics.
TEST_F(Compare, RequirementsMayNameTheGoalAndErrorBands) {
  for (const std::string machines : {"", "machines: 100\n"}) {
    using Case = std::pair<std::string, int>;
    for (const auto& [goal, code] :
         {Case{"within: 0.05, moves: 0.5", 0}, Case{"within: 0.004, moves: 0.9", 1},
          Case{"within: 0.05, moves: 0.999", 3}}) {
      study("a", gains("3.5e-5", 300) + machines + "goal: {band: 1, " + goal + "}\n", {"--force"});
      folder_.write("gate.yaml", "require: goal\n");
      const ProgramResult result =
          program({"compare", "a.h5", "a.h5", "--margins", "gate.yaml", "--format", "json"});
      const ProgramResult judged = program({"judge", "a.h5", "--point", "low", "--format", "json"});
      EXPECT_EQ(result.code, judged.code == code ? code : -1) << goal << machines << result.out << judged.out;
      const auto requirement = nlohmann::json::parse(result.out)["points"][0]["requirements"][0];
      EXPECT_EQ(requirement["value"], nlohmann::json::parse(judged.out)["rate"]);
      EXPECT_EQ(requirement["bounds"][0], nlohmann::json::parse(judged.out)["rate_low"]);
      EXPECT_EQ(requirement["trials_to_decide"].is_null(), code != 3) << requirement;
    }
  }
  const auto band = nlohmann::json::parse(
      program({"summary", "a.h5", "--format", "json"}).out)["points"][0]["bands"][1]["settling_time"];
  const auto judge_band = [&](double limit) {
    folder_.write("gate.yaml", fmt::format("require: band_settling_time[1].p95 <= {}\n", limit));
    return program({"compare", "a.h5", "a.h5", "--margins", "gate.yaml"}).code;
  };
  EXPECT_EQ(judge_band(band["p95_high"].get<double>() + 0.05), 0);
  EXPECT_EQ(judge_band(band["median"].get<double>()), 1);
  folder_.write("gate.yaml", "require: band_settling_time[4].p95 <= 1\n");
  EXPECT_TRUE(says(refusal({"compare", "a.h5", "a.h5", "--margins", "gate.yaml"}), "one of its bands: 0, 1"));
  study("plain", gains("3.5e-5", 30));
  folder_.write("gate.yaml", "require: goal\n");
  EXPECT_TRUE(says(refusal({"compare", "plain.h5", "plain.h5", "--margins", "gate.yaml"}),
                   "its manifest has no goal"));
}

TEST_F(Compare, AnotherEngineIsComparedTrialByTrial) {
  study("a", gains("1.0e-4", 300));
  study("b", gains("1.0e-4", 300), {"--engine", "reference"});
  const auto json = compared("a", "b", 0);
  EXPECT_EQ(json["layer"], "paired");
  EXPECT_EQ(json["points"][0]["pairs"], 300);
}

TEST_F(Compare, AHigherGainIsARegression) {
  study("a", gains("1.0e-4", 200));
  study("b", gains("2.0e-4", 200));
  const auto json = compared("a", "b", 1);
  EXPECT_EQ(json["points"][0]["verdict"], "passed");  // low is as before
  EXPECT_EQ(json["points"][1]["label"], "high");
  EXPECT_EQ(json["points"][1]["verdict"], "regression");
  EXPECT_EQ(json["manifest_differences"][0]["key"], "sweep.cases.high.controller.ki");
  const auto back = compared("b", "a", 0);  // the other way round it is an improvement
  EXPECT_GT(back["counts"]["better"].get<int>(), 0);
}

TEST_F(Compare, IfEveryChangeFailsAnImprovementHasTheExitCodeOfARegression) {
  study("a", gains("2.0e-4", 200));
  study("b", gains("1.0e-4", 200));
  EXPECT_EQ(program({"compare", "a.h5", "b.h5"}).code, 0);
  const ProgramResult result = program({"compare", "a.h5", "b.h5", "--changed-fails"});
  EXPECT_EQ(result.code, 1) << result.out;
  EXPECT_TRUE(says(result.out, "changed: "));
  folder_.write("gate.yaml", "fail_on: changed\n");
  EXPECT_EQ(program({"compare", "a.h5", "b.h5", "--margins", "gate.yaml"}).code, 1);
}

TEST_F(Compare, TooFewTrialsAreInconclusiveWithTheNumberThatWouldDecide) {
  study("a", gains("1.0e-4", 40));
  study("b", gains("1.0e-4", 40, "4"));
  const auto json = compared("a", "b", 3);
  EXPECT_EQ(json["layer"], "two_samples");
  EXPECT_GT(json["trials_to_decide"].get<int>(), 40);
}

TEST_F(Compare, OtherDesignPointsAreIncompatible) {
  study("a", gains("1.0e-4", 10));
  study("b", small_manifest(10));
  study("c", gains("1.0e-4", 10) + "description: more\n");
  std::string other = gains("1.0e-4", 10);
  other.replace(other.find("high"), 4, "top");
  study("d", other);
  const ProgramResult result = program({"compare", "a.h5", "d.h5"});
  EXPECT_EQ(result.code, 4);
  EXPECT_TRUE(says(result.err, "'high'"));
  EXPECT_EQ(result.out, "");
}

TEST_F(Compare, MarginsAndRequirementsComeFromAFile) {
  study("a", gains("1.0e-4", 30));
  folder_.write("gate.yaml", "points: {high: {require: success_rate ≥ 0.999}}\n");
  EXPECT_EQ(program({"compare", "a.h5", "a.h5", "--margins", "gate.yaml"}).code, 1);
  folder_.write("gate.yaml", "points: {low: {require: success_rate ≥ 0.999}}\n");
  EXPECT_EQ(program({"compare", "a.h5", "a.h5", "--margins", "gate.yaml"}).code,
            3);  // 30 of 30 do not show it
  const MarkedText gate = marked_text("margins: {«success»: 1}\n");
  folder_.write("gate.yaml", gate.text);
  EXPECT_TRUE(
      says(with_marks(refusal({"compare", "a.h5", "a.h5", "--margins", "gate.yaml"}), "gate.yaml", gate),
           "gate.yaml:«»: margins.success: unknown key"));
}

TEST_F(Compare, WritesSeveralFormatsInOneRun) {
  study("a", gains("1.0e-4", 20));
  const ProgramResult result =
      program({"compare", "a.h5", "a.h5", "--json", "r.json", "--junit", "r.xml", "--markdown", "r.md"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(says(result.out, "this comparison shows nothing about the program"));
  EXPECT_EQ(nlohmann::json::parse(folder_.read("r.json"))["verdict"], "passed");
  EXPECT_TRUE(folder_.read("r.xml").starts_with("<?xml"));
  EXPECT_TRUE(folder_.read("r.md").starts_with("**passed: "));
}

TEST_F(Compare, DamagedOrMissingFilesHaveTheirExitCodes) {
  study("a", gains("1.0e-4", 10));
  std::string bytes = folder_.read("a.h5");
  bytes[bytes.size() / 2] ^= 1;
  folder_.write("bad.h5", bytes);
  EXPECT_EQ(program({"compare", "a.h5", "bad.h5"}).code, 4);
  EXPECT_EQ(program({"compare", "a.h5", "none.h5"}).code, 2);
  EXPECT_EQ(program({"compare", "a.h5"}).code, 2);
}

TEST_F(Compare, ABaselineIsNotRecordedInABrokenLog) {
  study("a", gains("1.0e-4", 10));
  for (const char* const log : {"- date: yesterday", "not: [a list\n", "a: map\n"}) {
    folder_.write("base.h5.log.yaml", log);
    const ProgramResult result = program({"baseline", "a.h5", "-o", "base.h5", "--reason", "x"});
    EXPECT_EQ(result.code, 4) << log;
    EXPECT_TRUE(says(result.err, "base.h5.log.yaml: cannot append to this baseline log"));
    EXPECT_EQ(folder_.read("base.h5.log.yaml"), log);
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "base.h5"));
  }
}

TEST_F(Compare, ABaselineNeedsAReason) {
  study("a", gains("1.0e-4", 10));
  EXPECT_EQ(program({"baseline", "a.h5", "-o", "base.h5"}).code, 2);
  EXPECT_EQ(program({"baseline", "a.h5", "-o", "base.h5", "--reason", " "}).code, 2);
  EXPECT_EQ(program({"baseline", "a.h5", "-o", "a.h5", "--reason", "x"}).code, 2);
  EXPECT_EQ(program({"baseline", "a.h5", "-o", "base.h5", "--reason", "the first"}).code, 0);
  EXPECT_EQ(program({"compare", "base.h5", "a.h5"}).code, 0);
  EXPECT_TRUE(says(folder_.read("base.h5.log.yaml"), "the first"));
}

/// Manifest with the two cases of gains() as a study without sweep.
std::string gain_alone(const std::string& gain, int trials) {
  const std::string both = gains(gain, trials);
  return both.substr(0, both.find("sweep:")) + "controller: {ki: " + gain + "}\n";
}

TEST_F(Compare, TwoPointsOfAFileCompareLikePointsOfTwoFiles) {
  study("both", gains("1.0e-4", 200));
  study("low", gain_alone("3.0e-5", 200));
  study("high", gain_alone("1.0e-4", 200));
  const ProgramResult within = program({"compare", "both.h5", "--points", "low", "high", "--format", "json"});
  const ProgramResult between = program({"compare", "low.h5", "high.h5", "--format", "json"});
  const auto points = nlohmann::json::parse(within.out);
  const auto files = nlohmann::json::parse(between.out);
  EXPECT_EQ(within.code, between.code);
  EXPECT_EQ(points["layer"], "paired");
  EXPECT_EQ(points["baseline_label"], "low");
  EXPECT_EQ(points["points"][0]["label"], "high");
  EXPECT_EQ(points["points"][0]["measures"], files["points"][0]["measures"]);
}

TEST_F(Compare, IndependentPointsAreTwoSamples) {
  study("both", gains("1.0e-4", 200) + "independent_points: true\n");
  const ProgramResult result = program({"compare", "both.h5", "--points", "0", "1", "--format", "json"});
  EXPECT_EQ(nlohmann::json::parse(result.out)["layer"], "two_samples");
}

TEST_F(Compare, AnswerNamesBetterAndWorseMeasures) {
  study("both", gains("1.0e-4", 200));
  const std::string forward = program({"compare", "both.h5", "--points", "low", "high"}).out;
  const std::string backward = program({"compare", "both.h5", "--points", "high", "low"}).out;
  EXPECT_TRUE(says(forward, "high against low; worse: success_rate"));
  EXPECT_FALSE(says(forward, "better: "));
  EXPECT_TRUE(says(backward, "low against high; better: success_rate"));
  EXPECT_FALSE(says(backward, "worse: "));
}

TEST_F(Compare, RefusesPointsThatAreNotTwoOfOneFile) {
  study("both", gains("1.0e-4", 30));
  for (const std::vector<std::string>& words : {std::vector<std::string>{"both.h5", "--points", "low"},
                                                {"both.h5", "--points", "low", "low"},
                                                {"both.h5", "--points", "low", "none"},
                                                {"both.h5", "both.h5", "--points", "low", "high"},
                                                {"both.h5"}}) {
    std::vector<std::string> all{"compare"};
    all.insert(all.end(), words.begin(), words.end());
    EXPECT_EQ(program(all).code, 2) << words.back();
  }
}

}  // namespace
}  // namespace zerocount::testing
