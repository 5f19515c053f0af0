// `zerocount sensitivity` from the command line, on studies that are run.
#include <nlohmann/json.hpp>

#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

class SensitivityCommand : public ProgramTest {
 protected:
  // Four factors: k2, the target, phase and position are drawn, so 6 trials a row.
  SensitivityCommand() { folder_.write("study.yaml", small_manifest(180, "design: saltelli\n")); }
};

TEST_F(SensitivityCommand, SaysWhatDrivesTheTrialsOfASaltelliDesign) {
  ASSERT_EQ(program({"run", "study.yaml", "-o", "study.h5", "--quiet", "--set", "friction.beta=2.0e+5"}).code,
            0);
  const ProgramResult table = program({"sensitivity", "study.h5"});
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_TRUE(says(table.out, "command.targets.0"));
  const ProgramResult found =
      program({"sensitivity", "study.h5", "--point", "0", "--output", "settling_time", "--format", "json"});
  ASSERT_EQ(found.code, 0) << found.err;
  const auto json = nlohmann::json::parse(found.out);
  EXPECT_TRUE(json["design_is_saltelli"].get<bool>());
  ASSERT_EQ(json["points"].size(), 1u);
  const auto& output = json["points"][0]["outputs"][0];
  EXPECT_EQ(output["output"], "settling_time");
  // The four factors, and the profile by its value at the start.
  EXPECT_EQ(output["factors"].size(), 5u);
  EXPECT_EQ(output["factors"][0]["name"], "command.targets.0") << "a longer way takes longer";
  EXPECT_TRUE(output["factors"][0]["matters"].get<bool>());
  EXPECT_TRUE(says(program({"sensitivity", "study.h5", "--format", "csv"}).out, "0,low,success,"));
}

TEST_F(SensitivityCommand, WhereNothingCanBeEstimatedTheExitCodeIsThree) {
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
