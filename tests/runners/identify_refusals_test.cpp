// Refusals of `zerocount identify`: data without information, contradictory options, missing columns.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

class IdentifyRefusals : public ::testing::Test {
 protected:
  ProgramResult run(const std::vector<std::string>& words) {
    return zerocount_program(words, folder_.path());
  }

  TemporaryFolder folder_;
};

TEST_F(IdentifyRefusals, BadDataAreRefusedWithTheReason) {
  const auto refusal = [&](const std::string& name, const std::string& text) {
    folder_.write(name, text);
    const ProgramResult result = run({"identify", name});
    EXPECT_EQ(result.code, 4) << result.err;
    EXPECT_EQ(result.err.find(name), 0u) << result.err;
    EXPECT_EQ(result.out, "");
    return result.err;
  };
  std::string ramp = "t,torque,theta\n";
  for (int k = 0; k < 300; ++k) {
    ramp += std::to_string(k * 5e-4) + "," + std::to_string(k * 5e-4) + "," + std::to_string(k * 4e-6) + "\n";
  }
  EXPECT_NE(
      refusal("text.csv", ramp + "0.15,much,0\n").find("text.csv:302: torque: 'much' is not a finite number"),
      std::string::npos);
  EXPECT_NE(refusal("back.csv", ramp + "0.1,0,0\n").find("does not come after"), std::string::npos);
  folder_.write("ramp.csv", ramp);
  const ProgramResult once = run({"identify", "ramp.csv"});
  EXPECT_EQ(once.code, 4);
  EXPECT_NE(once.err.find("too few reversals"), std::string::npos) << once.err;
}

TEST_F(IdentifyRefusals, BadUsageIsRefused) {
  folder_.write("data.csv", "t,torque,count\n0,0,0\n");
  folder_.write("times.csv", "t,time,torque,theta\n0,0,0,0\n");
  folder_.write("motor.csv", "t,drive_torque,theta\n0,0,0\n");
  folder_.write("wrong.csv", "time [ms],torque,theta\n0,0,0\n");
  folder_.write("linear.csv", "t,force,count\n0,0,0\n");
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {},
           {"nothing.csv"},
           {"data.csv"},
           {"wrong.csv", "--column", "time=t"},
           {"data.csv", "--counts-per-revolution", "many"},
           {"data.csv", "--counts-per-revolution", "1000", "--angle", "theta"},
           {"linear.csv", "--counts-per-revolution", "1000"},
           {"linear.csv", "--axis", "rotary", "--resolution", "1e-9"},
           {"times.csv"},
           {"data.csv", "--fix", "friction.k3=1"},
           {"data.csv", "--fix", "friction.n=0.5"},
           {"data.csv", "--fix", "friction.n=2", "--fix", "friction.n=3"},
           {"data.csv", "--point", "1", "--counts-per-revolution", "1000"},
           {"data.csv", "--counts-per-revolution", "1000", "--amplifier-bandwidth", "1e-9"},
           {"data.csv", "--counts-per-revolution", "1000", "--delay", "-1"},
           {"motor.csv", "--delay", "2"},
           {"data.csv", "--counts-per-revolution", "1000", "--draws", "5"},
           {"data.csv", "--counts-per-revolution", "1000", "--posterior", "p.csv", "--draws", "0"},
           {"data.csv", "--counts-per-revolution", "1000", "--posterior", "data.csv"},
           {"data.csv", "--counts-per-revolution", "1000", "--plot", "fit.pdf"},
           {"data.csv", "--counts-per-revolution", "1000", "--plot", "data.csv"},
           {"data.csv", "--counts-per-revolution", "1000", "--plot", "-"},
           {"data.csv", "--counts-per-revolution", "1000", "--plot", "fit.html", "-o", "fit.html"},
           {"data.csv", "--sliding", "--plot", "fit.html"},
           {"data.csv", "--sliding", "--model", "lugre"},
           {"data.csv", "--counts-per-revolution", "1000", "--model", "coulomb"},
           {"data.csv", "--counts-per-revolution", "1000", "--model", "all", "--fix", "friction.n=2"},
           {"data.csv", "--counts-per-revolution", "1000", "--series-compliance", "--plot", "fit.html"},
           {"data.csv", "--counts-per-revolution", "1000", "--dac-bits", "1"},
           {"data.csv", "--format", "xml"}}) {
    std::vector<std::string> all{"identify"};
    all.insert(all.end(), words.begin(), words.end());
    const ProgramResult result = run(all);
    EXPECT_EQ(result.code, 2) << ::testing::PrintToString(words) << result.err;
  }
}

TEST_F(IdentifyRefusals, ColumnsAreRefusedWithTheReason) {
  const auto refusal = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "identify");
    const ProgramResult result = run(words);
    EXPECT_EQ(result.code, 2) << ::testing::PrintToString(words) << result.err;
    return result.err;
  };
  folder_.write("log.txt", "a b c\n1 2 3\n");
  folder_.write("old.mat", std::string("MATLAB 5.0 MAT-file, Platform: GLNXA64\n"));
  EXPECT_NE(refusal({"log.txt", "--column", "speed=a"}).find("QUANTITY one of time"), std::string::npos);
  EXPECT_NE(refusal({"log.txt", "--column", "time=a", "--column", "time=b"}).find("given twice"),
            std::string::npos);
  EXPECT_NE(refusal({"log.txt", "--sample-time", "0"}).find("not a positive number"), std::string::npos);
  EXPECT_NE(refusal({"log.txt", "--separator", "dot"}).find("comma, semicolon, tab"), std::string::npos);
  EXPECT_NE(refusal({"old.mat"}).find("version 7.3"), std::string::npos);
}

}  // namespace
}  // namespace zerocount::testing
