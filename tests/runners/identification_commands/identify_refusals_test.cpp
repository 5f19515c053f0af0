// Refusals of `zerocount identify`: data without information, contradictory options, missing columns.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

class IdentifyRefusals : public ProgramTest {};

TEST_F(IdentifyRefusals, BadDataAreRefusedWithTheReason) {
  const auto refusal = [&](const std::string& name, const std::string& text) {
    folder_.write(name, text);
    const ProgramResult result = program({"identify", name});
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
  const ProgramResult once = program({"identify", "ramp.csv"});
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
    const ProgramResult result = program(all);
    EXPECT_EQ(result.code, 2) << ::testing::PrintToString(words) << result.err;
  }
}

TEST_F(IdentifyRefusals, ColumnsAreRefusedWithTheReason) {
  const auto refusal = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "identify");
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 2) << ::testing::PrintToString(words) << result.err;
    return result.err;
  };
  folder_.write("log.txt", "a b c\n1 2 3\n");
  EXPECT_NE(refusal({"log.txt", "--column", "speed=a"}).find("QUANTITY one of time"), std::string::npos);
  EXPECT_NE(refusal({"log.txt", "--column", "time=a", "--column", "time=b"}).find("given twice"),
            std::string::npos);
  EXPECT_NE(refusal({"log.txt", "--sample-time", "0"}).find("not a positive number"), std::string::npos);
  EXPECT_NE(refusal({"log.txt", "--separator", "dot"}).find("comma, semicolon, tab"), std::string::npos);
}

/// A log table of a turning motor, with its time in ms and its angle in the unit that `head` names.
/// @param per_count angle of one count in this unit
std::string turning(double per_count, const std::string& head) {
  std::string text = head + "\n";
  for (int k = 0; k < 400; ++k) {
    const double angle = std::round(2000.0 * std::sin(0.02 * k)) * per_count;
    text += fmt::format("{},{},{}\n", 0.5 * k, 0.03 * std::sin(0.05 * k), angle);
  }
  return text;
}

// A record under two names would narrow the intervals as a second test does.
TEST_F(IdentifyRefusals, ReadingsGivenTwiceAreRefused) {
  folder_.write("log.csv", turning(1.0, "ms,Nm,pos"));
  folder_.write("other.csv", turning(0.5, "ms,Nm,pos"));
  const std::vector<std::string> columns{"--sliding", "--column", "time=ms[ms]", "--column",
                                         "torque=Nm[N m]"};
  const auto said = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "identify");
    words.insert(words.end(), columns.begin(), columns.end());
    return program(words).err;
  };
  const std::string angle = "angle=pos[mrad]";
  EXPECT_TRUE(says(said({"log.csv", "log.csv", "--column", angle}),
                   "log.csv and log.csv have the same readings, which would count twice", "--allow-equal"));
  std::filesystem::create_symlink("log.csv", folder_.path() / "link.csv");
  EXPECT_TRUE(says(said({"log.csv", "other.csv", "link.csv", "--column", angle}),
                   "log.csv and link.csv have the same readings"));
  EXPECT_FALSE(says(said({"log.csv", "other.csv", "--column", angle}), "the same readings"));
  EXPECT_FALSE(says(said({"log.csv", "log.csv", "--allow-equal", "--column", angle}), "the same readings"));
}

// Without its unit an angle is never taken for rad where counts are meant.
TEST_F(IdentifyRefusals, WholeNumbersWithoutAUnitAreCountsOrAnError) {
  folder_.write("log.csv", turning(1.0, "ms,Nm,pos"));
  folder_.write("rad.csv", turning(1e-3, "ms,Nm,pos"));
  const auto identified = [&](const std::string& file, const std::string& angle,
                              const std::vector<std::string>& more) {
    std::vector<std::string> words{"identify", "--sliding",      file,       "--column", "time=ms[ms]",
                                   "--column", "torque=Nm[N m]", "--column", angle};
    words.insert(words.end(), more.begin(), more.end());
    return program(words);
  };
  const ProgramResult said = identified("log.csv", "angle=pos[count]", {"--counts-per-revolution", "5000"});
  EXPECT_EQ(said.code, 4) << said.err;  // the motion of a sine is not that of this torque
  const ProgramResult unsaid = identified("log.csv", "angle=pos", {"--counts-per-revolution", "5000"});
  EXPECT_EQ(unsaid.err, said.err);
  const auto refusal = [&](const std::string& file, const std::string& angle,
                           const std::vector<std::string>& more) {
    const ProgramResult refused = identified(file, angle, more);
    EXPECT_EQ(refused.code, 2) << refused.err;
    return refused.err;
  };
  EXPECT_NE(refusal("log.csv", "angle=pos", {}).find("expected --column 'angle=pos[count]'"),
            std::string::npos);
  EXPECT_NE(refusal("rad.csv", "angle=pos", {"--counts-per-revolution", "5000"}).find("is not in counts"),
            std::string::npos);
  EXPECT_NE(
      refusal("rad.csv", "angle=pos[mrad]", {"--resolution", "1e-3"}).find("'--resolution' has no effect"),
      std::string::npos);
  EXPECT_NE(identified("rad.csv", "angle=pos", {}).code, 2);
}

TEST_F(IdentifyRefusals, OptionsThatAffectNoRecordAreErrors) {
  folder_.write("log.csv", turning(1e-3, "time,torque,theta"));
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"--counts-per-revolution", "5000"},
           {"--dac-bits", "12"},
           {"--trial", "0"},
           {"--point", "0"},
           {"--sliding", "--any-magnitude"},
           {"--axis", "rotary", "--column", "force=torque[N]", "--column", "position=theta[mm]"},
           {"--force"}}) {
    std::vector<std::string> all{"identify", "log.csv"};
    all.insert(all.end(), words.begin(), words.end());
    const ProgramResult refused = program(all);
    EXPECT_EQ(refused.code, 2) << words.front() << refused.err;
    EXPECT_NE(refused.err.find(words.front()), std::string::npos) << refused.err;
  }
}

}  // namespace
}  // namespace zerocount::testing
