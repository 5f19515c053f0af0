// Controllers of the user's own that cannot be used: each is refused, with its place in the manifest.
#include <nlohmann/json.hpp>

#include "tests/runners/plugins/plugin_manifest.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

struct Fault {
  int number;
  const char* message;
};

class BadPlugin : public ::testing::TestWithParam<Fault> {};

TEST_P(BadPlugin, IsRefused) {
  const TemporaryFolder folder;
  folder.write("study.yaml", plugin_manifest(faulty_controller(GetParam().number)));
  for (const std::string verb : {"check", "trace"}) {
    const ProgramResult result = zerocount_program({verb, "study.yaml"}, folder.path());
    EXPECT_EQ(result.code, 2) << verb;
    EXPECT_NE(result.err.find("study.yaml:5:22: controller.plugin: "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(GetParam().message), std::string::npos) << result.err;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, BadPlugin,
    ::testing::Values(
        Fault{1, "it is made for version 99 of zerocount/controller.h; expected version 1"},
        Fault{2, "its zerocount_controller has 16 bytes; expected size = sizeof(zerocount_controller)"},
        Fault{3, "it has no name"}, Fault{4, "it lacks a function; expected start and step"},
        Fault{5, "the name of its parameter 0 is 'Gain 1'; expected lower-case letters"},
        Fault{6, "two of its parameters have the name ki"},
        Fault{7, "the range of its parameter ki is from 2 to 1"},
        Fault{8, "the default of its parameter ki is -1; expected a number from 0 to 1"},
        Fault{9, "its state has 1073741824 bytes"}, Fault{10, "has no function zerocount_controller_entry"},
        Fault{11, "zerocount_controller_entry() returned nothing"}));

TEST(BadPlugins, AMissingFileIsRefused) {
  const TemporaryFolder folder;
  folder.write("study.yaml", plugin_manifest("none.so"));
  const ProgramResult result = zerocount_program({"run", "study.yaml", "-o", "out.h5"}, folder.path());
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("controller.plugin: none.so: no such file"), std::string::npos) << result.err;
}

TEST(BadPlugins, AMissingFileIsNotBlamedOnTheParametersThatAreSwept) {
  const TemporaryFolder folder;
  folder.write("study.yaml",
               plugin_manifest("none.so") + "sweep: {grid: {controller.parameters.ki: [1.0e-5, 2.0e-5]}}\n");
  const ProgramResult result = zerocount_program({"check", "study.yaml"}, folder.path());
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.err.find("unknown key"), std::string::npos) << result.err;
}

TEST(BadPlugins, AnotherFileIsNoLibrary) {
  const TemporaryFolder folder;
  folder.write("text.so", "no library");
  folder.write("study.yaml", plugin_manifest("text.so"));
  const ProgramResult result = zerocount_program({"check", "study.yaml"}, folder.path());
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("text.so is not a shared library"), std::string::npos) << result.err;
}

TEST(BadPlugins, TheReasonOfARefusedStartIsTold) {
  const TemporaryFolder folder;
  folder.write("study.yaml", plugin_manifest(faulty_controller(16)));
  const ProgramResult result = zerocount_program({"check", "study.yaml"}, folder.path());
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("the controller faulty cannot start: gain and zone do not fit"),
            std::string::npos)
      << result.err;
}

// A global integral, one that start resets, and a pointer into the state: the second works as long as trials
// run one after the other, the third as long as the state stays where it is.
TEST(BadPlugins, StateOutsideTheStateIsFound) {
  for (const int fault : {12, 13, 14}) {
    const TemporaryFolder folder;
    folder.write("study.yaml", plugin_manifest(faulty_controller(fault)));
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"check", "study.yaml"}, {"run", "study.yaml", "-o", "out.h5"}}) {
      const ProgramResult result = zerocount_program(words, folder.path());
      EXPECT_EQ(result.code, 2) << fault;
      EXPECT_NE(result.err.find("the controller faulty keeps something outside its state"), std::string::npos)
          << fault << result.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "out.h5"));
  }
}

TEST(BadPlugins, TorquesThatAreNoNumbersEndTheTrialAndSaySo) {
  const TemporaryFolder folder;
  folder.write("study.yaml", plugin_manifest(faulty_controller(15)));
  const ProgramResult result = zerocount_program({"run", "study.yaml", "-o", "out.h5"}, folder.path());
  EXPECT_EQ(result.code, 0) << result.err;
  const ProgramResult summary = zerocount_program({"summary", "out.h5", "--format", "json"}, folder.path());
  const nlohmann::json point = nlohmann::json::parse(summary.out)["points"][0];
  EXPECT_EQ(point["nonfinite"], point["trials"]);
  EXPECT_NE(zerocount_program({"summary", "out.h5"}, folder.path()).out.find("controller failed"),
            std::string::npos);
  const ProgramResult trace = zerocount_program({"trace", "study.yaml"}, folder.path());
  EXPECT_EQ(std::count(trace.out.begin(), trace.out.end(), '\n'), 102);  // the head and samples 0 to 100
  EXPECT_NE(trace.err.find("the controller returned a non-finite torque"), std::string::npos);
}

TEST(BadPlugins, TheModeOfArithmeticIsRestored) {
  const TemporaryFolder folder;
  folder.write("study.yaml", plugin_manifest("none.so"));
  const auto trace = [&](int fault) {
    return zerocount_program(
               {"trace", "study.yaml", "--set", "controller.plugin=" + faulty_controller(fault)},
               folder.path())
        .out;
  };
  EXPECT_FALSE(trace(0).empty());
  EXPECT_EQ(trace(17), trace(0));
  EXPECT_EQ(zerocount_program({"check", "study.yaml", "--set", "controller.plugin=" + faulty_controller(17)},
                              folder.path())
                .code,
            0);
}

}  // namespace
}  // namespace zerocount::testing
