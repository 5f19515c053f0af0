// A results file where a command expects a manifest: it stands for the study whose trials it holds.
#include <nlohmann/json.hpp>

#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Json = nlohmann::json;

class FileOperand : public ProgramTest {
 protected:
  void SetUp() override {
    folder_.write("axis.yaml",
                  "zerocount: 1\nname: axis\nseed: 3\ntrials: 40\ncommand: {targets: [20], hold: 0.2}\n"
                  "initial: {encoder_phase: {uniform: [0, 1]}}\n"
                  "goal: {band: 1, within: 0.1, moves: 0.5}\n"
                  "sweep: {grid: {controller.ki: [2.0e-6, 4.0e-5, 1.0e-5]}}\n");
    ASSERT_EQ(program({"run", "axis.yaml", "-o", "axis.h5", "--set", "friction.k1=150"}).code, 0);
  }
  std::string out(const std::vector<std::string>& words) {
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.out;
  }
};

TEST_F(FileOperand, IsTheStudyWithItsOverrides) {
  Json of_file = Json::parse(out({"check", "axis.h5", "--format", "json"}));
  Json of_manifest = Json::parse(out({"check", "axis.yaml", "--set", "friction.k1=150", "--format", "json"}));
  for (Json* plan : {&of_file, &of_manifest}) {
    for (const char* const measured : {"cost", "headline"}) plan->erase(measured);
  }
  EXPECT_EQ(of_file, of_manifest);

  out({"run", "axis.h5", "-o", "again.h5", "-q"});
  EXPECT_EQ(out({"summary", "again.h5", "--format", "json"}),
            out({"summary", "axis.h5", "--format", "json"}));
  EXPECT_EQ(out({"run", "axis.h5", "-o", "again.h5"}), "") << "complete already: it is the same study";

  EXPECT_EQ(Json::parse(out({"judge", "axis.h5", "--format", "json"}))["point"], 1);
  const std::string best = out({"controller", "axis.h5", "--point", "best"});
  EXPECT_EQ(best, out({"controller", "axis.yaml", "--set", "friction.k1=150", "--point", "1"}));
  EXPECT_NE(best, out({"controller", "axis.h5", "--point", "0"}));
}

TEST_F(FileOperand, IsNotChangedNorOverwritten) {
  EXPECT_TRUE(says(refusal({"run", "axis.h5", "-o", "axis.h5", "--force"}), "axis.h5"));
  EXPECT_TRUE(says(refusal({"check", "axis.h5", "--set", "trials=5"}), "expected a manifest"));
  EXPECT_TRUE(says(refusal({"controller", "axis.yaml", "--point", "best"}), "expected a results file"));
}

TEST_F(FileOperand, IsRefusedWhereItDoesNotTellTheStudy) {
  out({"controller", "axis.yaml", "-o", "law.c"});
  const std::string folder = folder_.path().string();
  ASSERT_EQ(std::system(("cc -shared -fPIC -DZEROCOUNT_PLUGIN -I " ZEROCOUNT_PLUGIN_HEADERS " " + folder +
                         "/law.c -o " + folder + "/law.so")
                            .c_str()),
            0);
  out({"run", "axis.yaml", "-o", "law.h5", "--set", "controller={plugin: ./law.so}", "--set",
       "sweep={grid: {friction.k1: [100]}}"});
  EXPECT_TRUE(says(refusal({"check", "law.h5"}), "its controller is a plugin"));
}

}  // namespace
}  // namespace zerocount::testing
