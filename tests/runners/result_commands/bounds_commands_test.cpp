// What the command line says with bounds: summary at another confidence, plan, jerks.
#include <regex>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/text/text.hpp"
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

class BoundsCommands : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<TemporaryFolder>();
    folder->write("study.yaml", small_manifest(40));
    ASSERT_EQ(run({"run", "study.yaml", "-o", "study.h5"}).code, 0);
  }
  static void TearDownTestSuite() { folder.reset(); }
  static ProgramResult run(const std::vector<std::string>& words) {
    return zerocount_program(words, folder->path());
  }
  static Json json(std::vector<std::string> words) {
    words.insert(words.end(), {"--format", "json"});
    const ProgramResult result = run(words);
    EXPECT_EQ(result.code, 0) << result.err;
    return Json::parse(result.out);
  }
  static std::unique_ptr<TemporaryFolder> folder;
};
std::unique_ptr<TemporaryFolder> BoundsCommands::folder;

TEST_F(BoundsCommands, SummaryHasBoundsOfTheRequestedConfidence) {
  const Json wide = json({"summary", "study.h5", "--confidence", "0.99"});
  const Json usual = json({"summary", "study.h5"});
  EXPECT_EQ(wide["confidence"], 0.99);
  EXPECT_EQ(usual["confidence"], 0.95);
  for (std::size_t i = 0; i < 2; ++i) {
    const Json& point = wide["points"][i];
    const auto zero = point["zero_count"].get<std::int64_t>();
    EXPECT_EQ(point["success_rate_low"].get<double>(), statistics::clopper_pearson(zero, 40, 0.99).low);
    EXPECT_EQ(point["success_rate_wilson_high"].get<double>(), statistics::wilson(zero, 40, 0.99).high);
    EXPECT_EQ(point["assurance"]["success_at_least"].get<double>(),
              statistics::proportion_at_least(zero, 40, 0.99));
    EXPECT_EQ(point["success_rate"], usual["points"][i]["success_rate"]);
    EXPECT_EQ(usual["points"][i]["success_rate_low"].get<double>(),
              statistics::clopper_pearson(zero, 40).low);
  }
  const Json& settling = wide["points"][0]["arrival_time"];
  const Json& usual_settling = usual["points"][0]["arrival_time"];
  EXPECT_LE(settling["median_low"], usual_settling["median_low"]);
  EXPECT_LT(settling["mean_low"], usual_settling["mean_low"]);
  EXPECT_GT(settling["mean_high"], usual_settling["mean_high"]);
  EXPECT_EQ(settling["mean"], usual_settling["mean"]);
  const std::string table = run({"summary", "study.h5", "--confidence", "0.99"}).out;
  EXPECT_TRUE(says(table, "99 % bounds", "of axes succeed, with 99 % confidence"));
  EXPECT_FALSE(says(table, "95 % bounds"));
}

TEST_F(BoundsCommands, ASummaryDoesNotChangeTheBoundsInTheFile) {
  json({"summary", "study.h5", "--confidence", "0.5"});
  const reading::AllTrialsFile file(*folder / "study.h5");
  std::vector<double> zero, low;
  for (const layout::PointColumn& column : file.statistics()) {
    if (column.name == "zero_count") zero = column.values;
    if (column.name == "success_rate_low") low = column.values;
    EXPECT_FALSE(says(column.name, "mean_low"));
  }
  ASSERT_EQ(low.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(low[i], statistics::clopper_pearson(static_cast<std::int64_t>(zero[i]), 40).low);
}

TEST_F(BoundsCommands, EachPointHasItsToleranceStatement) {
  const Json points = json({"summary", "study.h5"})["points"];
  const std::string table = run({"summary", "study.h5"}).out;
  for (const Json& point : points) {
    const auto statement = point["assurance"]["statement"].get<std::string>();
    EXPECT_TRUE(says(statement, "of axes succeed, with 95 % confidence"));
    const double at_least = point["assurance"]["success_at_least"].get<double>();
    const std::string row =
        "\n" + point["label"].get<std::string>() + " +" + text::percent_at_least(at_least);
    EXPECT_TRUE(std::regex_search(table, std::regex(row))) << row << table;
    EXPECT_NEAR(point["assurance"]["failure_at_most"].get<double>(),
                1.0 - point["assurance"]["success_at_least"].get<double>(), 1e-12);
    EXPECT_EQ(point["assurance"]["arrival_time"].size(), 3U);
  }
  const std::string csv = run({"summary", "study.h5", "--format", "csv"}).out;
  EXPECT_TRUE(says(csv, ",arrival_time_mean_low,",
                   ",success_at_least,failure_at_most,settling_within_95,settling_within_99,"
                   "settling_within_99_9\n"));
}

TEST_F(BoundsCommands, PlanSimulatesAPilotForTheTrialsThatShowEquivalence) {
  const Json weak = json({"plan", "--margin", "success_rate=0.05", "study.yaml"});
  EXPECT_EQ(weak["power"], 0.8);
  ASSERT_TRUE(weak["trials"].is_number());
  const Json strong = json({"plan", "--margin", "success_rate=0.05", "--power", "0.95", "study.yaml"});
  EXPECT_GT(strong["trials"], weak["trials"]);
  const Json both =
      json({"plan", "--margin", "success_rate=0.05", "--margin", "arrival_time=5%", "study.yaml"});
  EXPECT_GE(both["trials"], weak["trials"]);
  for (const Json& one : both["measures"]) {
    if (one["measure"] != "arrival_time") continue;
    EXPECT_NEAR(one["margin"], 0.05 * one["value"].get<double>(), 1e-12);
  }
}

TEST_F(BoundsCommands, PlanSaysHowManyTrialsAClaimNeeds) {
  const Json plan = json({"plan", "--success", "0.999", "--confidence", "0.95", "--failures", "2"});
  ASSERT_EQ(plan["plans"].size(), 3U);
  EXPECT_EQ(plan["plans"][0]["trials"], 2995);
  EXPECT_EQ(plan["plans"][2]["failures"], 2);
  EXPECT_TRUE(plan["plans"][0]["chance"].is_null());
  const Json strong = json({"plan", "--success", "0.99", "--true-success", "0.995", "--power", "0.9"});
  EXPECT_EQ(strong["plans"].size(), 5U);  // 0 to 3 failures, and the one with the power
  EXPECT_FALSE(strong["plans"][3]["has_power"].get<bool>());
  EXPECT_TRUE(strong["plans"][4]["has_power"].get<bool>());
  EXPECT_GE(strong["plans"][4]["chance"], 0.9);
  const Json half = json({"plan", "--halfwidth", "0.005"});
  EXPECT_NEAR(half["halfwidth"]["trials"].get<double>(), 1.96 * 1.96 / 4.0 / (0.005 * 0.005), 250.0);
  const std::string table = run({"plan", "--success", "0.999"}).out;
  EXPECT_TRUE(says(table, "at least 99.9 % of axes succeed, with 95 % confidence", "2995"));
}

TEST_F(BoundsCommands, JerksAreReportedForChosenPoints) {
  const Json all = json({"jerks", "study.h5", "--creep-trials", "2"});
  ASSERT_EQ(all["points"].size(), 2U);
  EXPECT_EQ(all["points"][0]["trials"], 40);
  const Json one = json({"jerks", "study.h5", "--point", "1", "--creep-trials", "2"});
  ASSERT_EQ(one["points"].size(), 1U);
  EXPECT_EQ(one["points"][0], all["points"][1]);
  const ProgramResult table = run({"jerks", "study.h5"});
  EXPECT_EQ(table.code, 0);
  EXPECT_TRUE(says(table.out, "Rate of jerks since arrival"));
}

TEST_F(BoundsCommands, WithoutArrivalsJerksMeasuresNothing) {
  ASSERT_EQ(
      run({"run", "study.yaml", "-o", "never.h5", "--set", "command.targets=[100000]", "--set", "trials=3"})
          .code,
      0);
  EXPECT_EQ(run({"jerks", "never.h5"}).code, 3);
  folder->write(
      "loads.yaml",
      "zerocount: 1\nname: loads\nseed: 1\ntrials: 2\ncommand: {torque: {levels: [0.1]}, hold: 0.1}\n");
  ASSERT_EQ(run({"run", "loads.yaml", "-o", "loads.h5"}).code, 0);
  EXPECT_EQ(run({"jerks", "loads.h5"}).code, 4);
}

TEST_F(BoundsCommands, RefuseInvalidOptions) {
  const std::vector<std::vector<std::string>> cases = {
      {"summary", "study.h5", "--confidence", "1"},
      {"summary", "study.h5", "--confidence", "95"},
      {"summary", "study.h5", "--confidence", "0.9x"},
      {"plan"},
      {"plan", "--confidence", "0.9"},
      {"plan", "--success", "1"},
      {"plan", "--success", "0.9", "--power", "0.9"},
      {"plan", "--success", "0.9", "--true-success", "0.8", "--power", "0.9"},
      {"plan", "--success", "0.9", "--failures", "-1"},
      {"plan", "--halfwidth", "0.7"},
      {"plan", "--halfwidth", "0.1", "--failures", "2"},
      {"plan", "--margin", "success_rate=0.02"},
      {"plan", "--margin", "success_rate=2", "study.yaml"},
      {"plan", "--margin", "speed=2", "study.yaml"},
      {"plan", "--margin", "arrival_time=x%", "study.yaml"},
      {"plan", "--margin", "arrival_time=5%", "study.yaml", "--success", "0.9"},
      {"plan", "--success", "0.9", "--set", "trials=3"},
      {"jerks"},
      {"jerks", "study.h5", "--point", "2"},
      {"jerks", "study.h5", "--point", "first"},
      {"jerks", "study.h5", "--creep-trials", "-1"},
      {"jerks", "missing.h5"},
  };
  for (const auto& words : cases) {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.code, 2) << ::testing::PrintToString(words) << result.err;
    EXPECT_FALSE(result.err.empty());
    EXPECT_TRUE(result.out.empty()) << result.out;
  }
}

// `zerocount sensitivity` from the command line, on studies that are run.

class SensitivityCommand : public ProgramTest {
 protected:
  // Four factors: k2, the target, phase and position are drawn, so 6 trials a row.
  SensitivityCommand() { folder_.write("study.yaml", small_manifest(180, "design: saltelli\n")); }
};

TEST_F(SensitivityCommand, NamesTheInfluencesInASaltelliDesign) {
  ASSERT_EQ(program({"run", "study.yaml", "-o", "study.h5", "--quiet", "--set", "friction.beta=2.0e+5"}).code,
            0);
  const ProgramResult table = program({"sensitivity", "study.h5"});
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_TRUE(says(table.out, "command.targets.0"));
  const ProgramResult found =
      program({"sensitivity", "study.h5", "--point", "0", "--output", "arrival_time", "--format", "json"});
  ASSERT_EQ(found.code, 0) << found.err;
  const auto json = nlohmann::json::parse(found.out);
  EXPECT_TRUE(json["design_is_saltelli"].get<bool>());
  ASSERT_EQ(json["points"].size(), 1u);
  const auto& output = json["points"][0]["outputs"][0];
  EXPECT_EQ(output["output"], "arrival_time");
  // The four factors, and the profile by its value at the start.
  EXPECT_EQ(output["factors"].size(), 5u);
  EXPECT_EQ(output["factors"][0]["name"], "command.targets.0") << "a longer way takes longer";
  EXPECT_TRUE(output["factors"][0]["matters"].get<bool>());
  EXPECT_TRUE(says(program({"sensitivity", "study.h5", "--format", "csv"}).out, "0,low,success,"));
}

TEST_F(SensitivityCommand, ExitsWithThreeIfNothingCanBeEstimated) {
  folder_.write("sure.yaml",
                "zerocount: 1\nname: sure\nseed: 1\ntrials: 60\ncommand: {targets: [0], hold: 0.1}\n"
                "friction: {k1: {uniform: [100, 120]}}\nverdict: {dwell: 0.02, window: 0.02}\n");
  ASSERT_EQ(program({"run", "sure.yaml", "-o", "sure.h5", "--quiet"}).code, 0);
  const ProgramResult nothing = program({"sensitivity", "sure.h5"});
  EXPECT_EQ(nothing.code, 3);
  EXPECT_TRUE(says(nothing.out, "success is 1 in all 60 trials: it has no variance"));
}

TEST_F(SensitivityCommand, BadQuestionsExitWithTwo) {
  ASSERT_EQ(program({"run", "study.yaml", "-o", "study.h5", "--quiet"}).code, 0);
  const std::vector<std::vector<std::string>> cases{{"sensitivity"},
                                                    {"sensitivity", "missing.h5"},
                                                    {"sensitivity", "study.h5", "--point", "2"},
                                                    {"sensitivity", "study.h5", "--point", "first"},
                                                    {"sensitivity", "study.h5", "--output", "sucess"},
                                                    {"sensitivity", "study.h5", "--confidence", "95"},
                                                    {"sensitivity", "study.h5", "--confidence", "0.99999"},
                                                    {"sensitivity", "study.h5", "--format", "xml"}};
  for (const auto& words : cases) {
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 2) << ::testing::PrintToString(words);
    EXPECT_FALSE(result.err.empty());
    EXPECT_TRUE(result.out.empty());
  }
}

}  // namespace
}  // namespace zerocount::testing
