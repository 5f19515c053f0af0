// The command line: help, usage errors, exit codes.
#include <csignal>
#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

using ::testing::Values;

class CommandLine : public ::testing::Test {
 protected:
  ProgramResult run(const std::vector<std::string>& words) {
    return zerocount_program(words, folder_.path());
  }
  TemporaryFolder folder_;
};

TEST_F(CommandLine, HelpGoesToStandardOutput) {
  const ProgramResult help = run({"--help"});
  EXPECT_EQ(help.code, 0);
  for (const char* verb : {"check", "run", "summary", "trace", "merge", "export", "parameters", "schema"}) {
    EXPECT_NE(help.out.find(verb), std::string::npos) << verb;
    const ProgramResult more = run({verb, "--help"});
    EXPECT_EQ(more.code, 0) << verb;
    EXPECT_NE(more.out.find("usage: zerocount " + std::string(verb)), std::string::npos) << verb;
    EXPECT_EQ(run({"help", verb}).out, more.out);
  }
  EXPECT_EQ(run({"--version"}).code, 0);
}

TEST_F(CommandLine, BadUsageExitsWithTwoAndOneMessage) {
  folder_.write("study.yaml", small_manifest(2));
  const std::vector<std::vector<std::string>> cases = {
      {},
      {"fly"},
      {"run"},
      {"run", "study.yaml"},
      {"run", "study.yaml", "-o"},
      {"run", "study.yaml", "-o", "a.h5", "-o", "b.h5"},
      {"run", "study.yaml", "-o", ""},
      {"run", "study.yaml", "-o", "a.h5", "--thread", "2"},
      {"run", "study.yaml", "-o", "a.h5", "--threads", "0"},
      {"run", "study.yaml", "-o", "a.h5", "--threads", "two"},
      {"run", "study.yaml", "-o", "a.h5", "--shard", "3/2"},
      {"run", "study.yaml", "-o", "a.h5", "--shard", "0/2"},
      {"run", "study.yaml", "-o", "a.h5", "--shard", "1"},
      {"run", "study.yaml", "-o", "a.h5", "--shard", "1/5"},
      {"run", "study.yaml", "more", "-o", "a.h5"},
      {"run", "study.yaml", "-o", "a.h5", "--set", "controller.kii=1"},
      {"run", "study.yaml", "-o", "a.h5", "--set", "controller.ki"},
      {"run", "study.yaml", "-o", "a.h5", "--quiet=yes"},
      {"check", "missing.yaml"},
      {"summary", "missing.h5"},
      {"summary", "study.yaml", "--format", "xml"},
      {"trace", "study.yaml", "--point", "2"},
      {"trace", "study.yaml", "--trial", "2"},
      {"trace", "study.yaml", "--trial", "-1"},
      {"trace", "missing.yaml"},
      {"merge", "missing.h5", "-o", "a.h5"},
      {"parameters", "study.yaml"},
  };
  for (const auto& words : cases) {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.code, 2) << ::testing::PrintToString(words) << result.err;
    EXPECT_FALSE(result.err.empty());
    EXPECT_TRUE(result.out.empty()) << result.out;
    EXPECT_EQ(result.err.find("exception"), std::string::npos) << result.err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "a.h5"));
}

TEST_F(CommandLine, SaysWhatIsWrongWithAnOption) {
  EXPECT_NE(run({"run", "s.yaml", "-o", "a.h5", "--quiet=1"}).err.find("'--quiet' takes no value"),
            std::string::npos);
  EXPECT_NE(run({"run", "s.yaml", "-o"}).err.find("needs a value"), std::string::npos);
  EXPECT_NE(run({"run", "s.yaml", "--outptu", "a.h5"}).err.find("unknown option '--outptu'"),
            std::string::npos);
}

TEST_F(CommandLine, DataThatCannotBeUsedExitsWithFour) {
  folder_.write("text.h5", "this is no HDF5 file, but it is long enough to look at\n");
  EXPECT_EQ(run({"summary", "text.h5"}).code, 4);
  EXPECT_EQ(run({"export", "text.h5", "-o", "csv"}).code, 4);
  EXPECT_EQ(run({"merge", "text.h5", "-o", "all.h5"}).code, 4);
}

TEST_F(CommandLine, ManifestErrorsAreAllReportedWithTheirPlace) {
  folder_.write(
      "bad.yaml",
      "zerocount: 1\nname: bad\nseed: 1\ntrials: 10\nfrictoin: {k1: 3}\nfriction: {k1: -5, n: 0.5}\n"
      "command: {targets: [1], hold: no}\n");
  const ProgramResult result = run({"check", "bad.yaml"});
  EXPECT_EQ(result.code, 2);
  for (const char* place : {"bad.yaml:5:1: frictoin", "bad.yaml:6:16: friction.k1",
                            "bad.yaml:6:23: friction.n", "bad.yaml:7:31: command.hold"}) {
    EXPECT_NE(result.err.find(place), std::string::npos) << place << "\n" << result.err;
  }
}

TEST_F(CommandLine, CheckPrintsThePlanAndTheCriteria) {
  folder_.write("study.yaml", "zerocount: 1\nname: rig\nseed: 1\ntrials: 10\ncommand: {targets: [5]}\n");
  const ProgramResult result = run({"check", "study.yaml"});
  EXPECT_EQ(result.code, 0) << result.err;
  for (const char* text : {"1 design point × 10 trials", "3.85e-05", "3.01e-04", "3.57e-05", "198"}) {
    const std::string short_form = std::string(text) == "3.01e-04" ? "0.000301" : text;
    EXPECT_NE(result.out.find(short_form), std::string::npos) << short_form << "\n" << result.out;
  }
}

TEST_F(CommandLine, CheckSaysNothingOfBoundsWhereTheTheoryIsNotAboutTheLoop) {
  const std::string head = "zerocount: 1\nname: rig\nseed: 1\ntrials: 10\n";
  folder_.write("open.yaml", head + "command: {torque: {levels: [0.1], through: exact}}\n");
  folder_.write("models.yaml", head + "command: {targets: [5]}\n" +
                                   "sweep: {grid: {friction.model: [coulomb, none, spring]}}\n");
  const std::string open = run({"check", "open.yaml"}).out;
  EXPECT_NE(open.find("do not apply: the loop is open"), std::string::npos) << open;
  for (const char* bound : {"(6)", "(7)", "sampled loop", "DAC", "natural frequency", "N m/count"}) {
    EXPECT_EQ(open.find(bound), std::string::npos) << bound;
  }
  const std::string models = run({"check", "models.yaml"}).out;
  const std::size_t none = models.find("friction.model=none"), spring = models.find("friction.model=spring");
  const std::string of_coulomb = models.substr(0, none), of_none = models.substr(none, spring - none);
  EXPECT_NE(of_coulomb.find("do not apply: friction.model coulomb has no spring"), std::string::npos)
      << models;
  for (const char* prediction :
       {"by describing function: no lasting cycle", "by stick-slip: no lasting cycle"})
    EXPECT_NE(of_coulomb.find(prediction), std::string::npos) << models;
  EXPECT_NE(of_none.find("do not apply: friction.model none has no spring"), std::string::npos) << models;
  EXPECT_NE(of_none.find("sampled loop unstable"), std::string::npos) << models;
  EXPECT_EQ(models.find("do not apply", spring), std::string::npos) << models;
}

// One count of the coarse encoder is 18.75 of the fine one: k1·Δx is 0.008 N m, not 4.27e-4.
TEST_F(CommandLine, CheckTakesTheCountThatIsFedBackForTheRuleOfTheDac) {
  folder_.write("coarse.yaml",
                "zerocount: 1\nname: rig\nseed: 1\ntrials: 1\ncommand: {targets: [5]}\n"
                "controller: {encoder: coarse}\ndac: {resolution: 5.0e-4}\n");
  const std::string out = run({"check", "coarse.yaml"}).out;
  EXPECT_NE(out.find("DAC: resolution 0.0005 N m, must be below k1·Δx = 0.008 N m with the Δx of the coarse "
                     "encoder: holds\n"),
            std::string::npos)
      << out;
}

TEST_F(CommandLine, CheckPredictsNoHuntingOfALoopThatThePredictionsLeaveOut) {
  folder_.write("rig.yaml",
                "zerocount: 1\nname: rig\nseed: 1\ntrials: 3\ncommand: {targets: [5]}\n"
                "friction: {model: coulomb}\n");
  for (const auto& [set, left_out] : std::vector<std::pair<std::string, std::string>>{
           {"plant.load.inertia=1e-4", "the second mass"},
           {"controller.deadband=2", "the deadband"},
           {"controller.integrator_zone=10", "the integrator zone"}}) {
    const std::string out = run({"check", "rig.yaml", "--set", set}).out;
    EXPECT_NE(out.find("hunting of trial 0: not predicted, since the predictions leave out " + left_out),
              std::string::npos)
        << out;
  }
}

// At a k1 that is the same in all trials the sampled loop may still be stable in some trials only.
TEST_F(CommandLine, CheckJudgesTheSampledLoopOfEachTrial) {
  folder_.write("rig.yaml",
                "zerocount: 1\nname: rig\nseed: 1\ntrials: 20\ncommand: {targets: [5]}\n"
                "plant: {presliding_damping: {uniform: [0.1, 0.4]}}\n");
  const std::string out = run({"check", "rig.yaml"}).out;
  EXPECT_NE(out.find("sampled loop at k1 unstable in some trials"), std::string::npos) << out;
  EXPECT_NE(out.find(": unstable in some trials\n"), std::string::npos) << out;
}

TEST_F(CommandLine, CheckCallsALoopThatNothingReturnsMarginal) {
  folder_.write("rig.yaml",
                "zerocount: 1\nname: rig\nseed: 1\ntrials: 2\ncommand: {targets: [5]}\n"
                "controller: {ki: 0}\n");
  const std::string out = run({"check", "rig.yaml"}).out;
  EXPECT_NE(
      out.find("while sliding: no phase crossover, no gain crossover: marginal, with an eigenvalue of 1\n"),
      std::string::npos)
      << out;
}

TEST_F(CommandLine, CheckTellsTheCriteriaFromTheSampledLoop) {
  const std::string head = "zerocount: 1\nname: rig\nseed: 1\ntrials: 10\ncommand: {targets: [5]}\n";
  folder_.write("rig.yaml", head + "friction: {k1: 110}\n");
  const std::string between = run({"check", "rig.yaml", "--set", "controller.ki=3.8e-5"}).out;
  EXPECT_NE(between.find("by (6) and (7) stable; sampled loop at k1 unstable"), std::string::npos) << between;
  const std::string low = run({"check", "rig.yaml", "--set", "controller.ki=1e-5"}).out;
  EXPECT_NE(low.find("by (6) and (7) stable; sampled loop at k1 stable"), std::string::npos) << low;
  const std::string none = run({"check", "rig.yaml", "--set", "controller.ki=0"}).out;
  EXPECT_NE(none.find("no integral control"), std::string::npos) << none;
  EXPECT_EQ(none.find("slowest time constant"), std::string::npos) << none;
}

TEST_F(CommandLine, ParametersAndSchemaComeFromTheSameTable) {
  const ProgramResult parameters = run({"parameters"});
  EXPECT_EQ(parameters.code, 0);
  EXPECT_NE(parameters.out.find("friction.k1"), std::string::npos);
  EXPECT_NE(run({"parameters", "--format", "markdown"}).out.find("|"), std::string::npos);
  const auto schema = nlohmann::json::parse(run({"schema"}).out);
  EXPECT_TRUE(schema["properties"].contains("friction"));
}

TEST_F(CommandLine, AFullStandardOutputExitsWithFive) {
  folder_.write("study.yaml", small_manifest(2));
  const std::string command =
      "cd " + folder_.path().string() + " && " ZEROCOUNT_PROGRAM " trace study.yaml > /dev/full 2> err";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 5);
  EXPECT_NE(folder_.read("err").find("standard output"), std::string::npos);
}

TEST_F(CommandLine, AStandardErrorThatCannotBeWrittenStopsNothing) {
  folder_.write("study.yaml", small_manifest(20));
  for (const std::string to : {"2> /dev/full", "2>&-", "2>&1 | true"}) {
    const std::string command =
        "cd " + folder_.path().string() +
        " && rm -f a.h5 && { " ZEROCOUNT_PROGRAM " run study.yaml -o a.h5; echo $? > code; } " + to;
    std::system(command.c_str());
    EXPECT_EQ(folder_.read("code"), "0\n") << to;
    const ProgramResult summary = run({"summary", "a.h5"});
    EXPECT_EQ(summary.code, 0) << to << ": " << summary.err;
  }
}

// As any program that writes to a pipe: killed by the signal, without a message.
TEST_F(CommandLine, AReaderThatHasEnoughEndsTheProgram) {
  const std::string command =
      "cd " + folder_.path().string() + " && { " ZEROCOUNT_PROGRAM " schema 2> err; echo $? > code; } | true";
  std::system(command.c_str());
  EXPECT_EQ(folder_.read("code"), fmt::format("{}\n", 128 + SIGPIPE));
  EXPECT_EQ(folder_.read("err"), "");
}

}  // namespace
}  // namespace zerocount::testing
