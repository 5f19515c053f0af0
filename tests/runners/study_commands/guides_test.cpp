// From the name of a guide to the results of a study of it.

#include "experiments/guides/guide_table.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

class NewGuide : public ::testing::Test {
 protected:
  ProgramResult run(const std::vector<std::string>& words) const {
    return zerocount_program(words, folder.path());
  }
  void expect_refused(const std::vector<std::string>& words, const std::string& message) const {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.code, 2) << message;
    EXPECT_TRUE(says(result.err, message));
  }

  TemporaryFolder folder;
};

TEST_F(NewGuide, EachStudyRunsAndStaysWithinOneCount) {
  for (const guides::Guide& guide : guides::guide_table()) {
    const std::string name(guide.name);
    ASSERT_EQ(run({"new", "--guide", name}).code, 0) << name;
    const ProgramResult check = run({"check", name + ".yaml"});
    EXPECT_EQ(check.code, 0) << check.err;
    EXPECT_EQ(check.err, "");
    ASSERT_EQ(run({"run", name + ".yaml", "-o", name + ".h5", "--set", "trials=100"}).code, 0) << name;
    const auto point =
        nlohmann::json::parse(run({"summary", name + ".h5", "--format", "json"}).out)["points"][0];
    EXPECT_EQ(point["nonfinite"], 0) << name;
    // The air bearing hunts by one count.
    EXPECT_EQ(point["bands"][1]["band"], 1) << point.dump(2);
    EXPECT_TRUE(point["bands"][1]["settling_time"]["p95"].is_number()) << name << "\n" << point.dump(2);
  }
}

TEST_F(NewGuide, FrictionScalesWithTheLoad) {
  const ProgramResult usual = run({"new", "--guide", "ball-rail", "-o", "-"});
  const ProgramResult more = run(
      {"new", "--guide", "ball-rail", "--preload", "800", "--mass", "12", "--resolution", "1e-9", "-o", "-"});
  EXPECT_NE(usual.out, more.out);
  EXPECT_TRUE(says(more.out, "preload of 800 N", "inertia: 12 ", "resolution: 1e-09"));
}

TEST_F(NewGuide, StartsFromAMeasuredSpring) {
  const std::vector<std::string> words{"new",        "--guide",  "crossed-roller", "--breakaway",
                                       "4",          "--travel", "10e-6",          "--secant",
                                       "1.5e6@2e-6", "-o",       "axis.yaml"};
  ASSERT_EQ(run(words).code, 0);
  const ProgramResult check = run({"check", "axis.yaml"});
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_EQ(run({"run", "axis.yaml", "-o", "axis.h5", "--set", "trials=50"}).code, 0);
  expect_refused({"new", "--guide", "crossed-roller", "--breakaway", "4"},
                 "'--travel' is missing; a measured spring has --breakaway, --travel and --secant");
  const auto with_secant = [&](const std::string& secant, const std::string& guide = "crossed-roller") {
    return std::vector<std::string>{"new",      "--guide", guide,      "--breakaway", "4",
                                    "--travel", "10e-6",   "--secant", secant};
  };
  expect_refused(with_secant("1.5e6"), "expected N/m@m");
  expect_refused(with_secant("1.5e6@2e-5"), "travel of 2e-05 is not below the travel up to breakaway, 1e-05");
  expect_refused(with_secant("2.5e6@2e-6"), "carries 5, which is not below the breakaway of 4");
  expect_refused(with_secant("3e5@2e-6"), "300000 is not above breakaway over travel, 4/1e-05 = 400000");
  expect_refused(with_secant("1.5e6@2e-6", "air-bearing"), "'--breakaway' has no effect on air-bearing");
}

TEST_F(NewGuide, IsListed) {
  const std::string list = run({"new", "--list"}).out;
  for (const guides::Guide& guide : guides::guide_table())
    EXPECT_TRUE(says(list, "\n" + std::string(guide.name) + " "));
}

TEST_F(NewGuide, RefusesUnknownGuidesAndOptions) {
  std::string names;
  for (const guides::Guide& guide : guides::guide_table())
    names += (names.empty() ? "" : ", ") + std::string(guide.name);
  expect_refused({"new", "--guide", "bal-rail"}, "'bal-rail' is not one of " + names);
  expect_refused({"new", "--guide"}, "option '--guide' needs a value, one of " + names);
  expect_refused({"new", "paper-gains", "--guide", "plain"}, "expected either the name of a manifest");
  expect_refused({"new", "paper-gains", "--mass", "5"}, "option '--mass' needs '--guide'");
  expect_refused({"new", "--guide", "air-bearing", "--preload", "5"}, "has no effect on air-bearing");
  expect_refused({"new", "--guide", "rotary-ball", "--mass", "5"}, "has no effect on rotary-ball");
  expect_refused({"new", "--guide", "plain", "--mass", "-5"}, "expected a number above 0");
  expect_refused({"parameters", "--guides", "--axis", "linear"},
                 "options '--axis' and '--guides' exclude each other");
}

// check and run warn of the same absurd values, and go on; the command line helps with what is misspelt.

class Hints : public ProgramTest {
 protected:
  Hints() { std::ofstream(folder_.path() / "study.yaml") << small_manifest(2); }
  std::string warnings_of(const std::vector<std::string>& words) {
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  }
};

TEST_F(Hints, CheckAndRunGiveTheSameWarnings) {
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

TEST_F(Hints, CheckCountsTheTrialsInWhichARuleHolds) {
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

TEST_F(Hints, CheckStatesTheCountsOfTargetsInSiUnits) {
  const std::string out =
      program({"check", "study.yaml", "--set", "command={units: si, targets: [1.0e-4, -2.0e-4]}"}).out;
  EXPECT_TRUE(says(out, "to the nearest of 3.879e-06 rad: 0.0001 rad = 26 counts, -0.0002 rad = -52 counts"));
}

TEST_F(Hints, AMisspeltCommandIsAnsweredWithTheNearest) {
  EXPECT_TRUE(says(refusal({"chek", "study.yaml"}), "unknown command 'chek'; did you mean check? See"));
  EXPECT_EQ(program({"frobnicate"}).err, "zerocount: unknown command 'frobnicate'; see 'zerocount --help'\n");
}

TEST_F(Hints, CompletionListsTheLabelsOfPoints) {
  warnings_of({"run", "study.yaml", "-q", "-o", "out.h5"});
  const std::string labels = program({"completion", "points", "study.yaml"}).out;
  EXPECT_EQ(std::count(labels.begin(), labels.end(), '\n'), 2) << labels;
  EXPECT_EQ(program({"completion", "points", "out.h5"}).out, labels);
  EXPECT_EQ(program({"completion", "points"}).code, 2);
  EXPECT_EQ(program({"completion", "bash", "study.yaml"}).code, 2);
  const std::string keys = program({"completion", "candidates", "--", "run", "study.yaml", "--set", "f"}).out;
  EXPECT_TRUE(says(keys, "\nfriction.k1=\n"));
}

// A results file where a command expects a manifest: it stands for the study whose trials it holds.

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

TEST_F(FileOperand, MeansItsStudyWithItsOverrides) {
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

TEST_F(FileOperand, IsRefusedIfItDoesNotContainTheStudy) {
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
