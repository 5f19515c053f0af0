// check and run warn of the same absurd values, and go on; the command line helps with what is misspelt.
#include <nlohmann/json.hpp>

#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

class Hints : public ProgramTest {
 protected:
  Hints() { std::ofstream(folder_.path() / "study.yaml") << small_manifest(2); }
  std::string warnings_of(const std::vector<std::string>& words) {
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  }
};

TEST_F(Hints, CheckAndRunWarnAlikeAndGoOn) {
  const std::vector<std::string> absurd{"--set", "friction.beta=0.1", "--set", "controller.kp=20"};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.end(), absurd.begin(), absurd.end());
    return words;
  };
  const std::string checked = warnings_of(with({"check", "study.yaml"}));
  EXPECT_TRUE(says(checked, "warning: --set friction.beta=0.1: friction.beta: the spring slides before",
                   "say controller.units: si"));
  const std::string ran = warnings_of(with({"run", "study.yaml", "-q", "-o", "out.h5"}));
  EXPECT_TRUE(says(checked, ran)) << ran;
}

TEST_F(Hints, CheckSaysInHowManyTrialsARuleHolds) {
  const auto trials_with = [&](const std::string& resolution) {
    const auto theory = nlohmann::json::parse(
        program({"check", "study.yaml", "--set", "trials=40", "--set", "friction.k1={uniform: [100, 200]}",
                 "--set", "dac.resolution=" + resolution, "--format", "json"})
            .out)["theory"][0];
    EXPECT_EQ(theory["rule_trials"], 40);
    return theory["fine_enough"].get<int>();
  };
  // k1·Δx lies between 3.9e-4 and 7.8e-4 N m.
  EXPECT_EQ(trials_with("1.0e-4"), 40);
  EXPECT_EQ(trials_with("1.0e-3"), 0);
  EXPECT_GT(trials_with("5.8e-4"), 0);
  EXPECT_LT(trials_with("5.8e-4"), 40);
}

TEST_F(Hints, CheckTellsTheCountsOfTargetsInSiUnits) {
  const std::string out =
      program({"check", "study.yaml", "--set", "command={units: si, targets: [1.0e-4, -2.0e-4]}"}).out;
  EXPECT_TRUE(says(out, "to the nearest of 3.879e-06 rad: 0.0001 rad = 26 counts, -0.0002 rad = -52 counts"));
}

TEST_F(Hints, AMisspeltCommandIsToldTheNearest) {
  EXPECT_TRUE(says(refusal({"chek", "study.yaml"}), "unknown command 'chek'; did you mean check? See"));
  EXPECT_EQ(program({"frobnicate"}).err, "zerocount: unknown command 'frobnicate'; see 'zerocount --help'\n");
}

TEST_F(Hints, CompletionTellsTheLabelsOfPoints) {
  warnings_of({"run", "study.yaml", "-q", "-o", "out.h5"});
  const std::string labels = program({"completion", "points", "study.yaml"}).out;
  EXPECT_EQ(std::count(labels.begin(), labels.end(), '\n'), 2) << labels;
  EXPECT_EQ(program({"completion", "points", "out.h5"}).out, labels);
  EXPECT_EQ(program({"completion", "points"}).code, 2);
  EXPECT_EQ(program({"completion", "bash", "study.yaml"}).code, 2);
  const std::string keys = program({"completion", "candidates", "--", "run", "study.yaml", "--set", "f"}).out;
  EXPECT_TRUE(says(keys, "\nfriction.k1=\n"));
}

}  // namespace
}  // namespace zerocount::testing
