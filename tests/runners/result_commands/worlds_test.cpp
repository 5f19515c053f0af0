// Studies with worlds, from the manifest to the answers: no rate is averaged over worlds without saying so.

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

/// Manifest of an axis with integral control in twelve worlds (possible sets of the values that all machines
/// share). The smaller the creep exponent n, the more the contact creeps.
constexpr const char* study_in_worlds =
    "zerocount: 1\n"
    "name: worlds\n"
    "seed: 11\n"
    "worlds: 12\n"
    "trials: 1200\n"
    "friction:\n"
    "  k1: {lognormal: {median: 110, cv: 0.1}}\n"
    "  n: {interval: [1.2, 2.4]}\n"
    "  alpha: {log_uniform: [0.2, 2], per: world}\n"
    "controller: {ki: 3.0e-5}\n"
    "command: {targets: [{integers: [1, 20]}], hold: 0.5}\n"
    "initial: {encoder_phase: {uniform: [0, 1]}, hardening: {uniform: [0, 1.0e-4]}}\n"
    "goal: {band: 0, within: 0.25, moves: 0.7}\n";

class WorldStudy : public ProgramTest {
 protected:
  void SetUp() override {
    folder_.write("study.yaml", study_in_worlds);
    const ProgramResult result = program({"run", "study.yaml", "-o", "out.h5"});
    ASSERT_EQ(result.code, 0) << result.err;
  }
};

TEST_F(WorldStudy, IsJudgedByItsWorstWorld) {
  const ProgramResult text = program({"judge", "out.h5"});
  EXPECT_EQ(text.code, 1);
  EXPECT_TRUE(says(text.out, "it must hold in each of 12 worlds", "where friction.n < "));
  const Json judged = json_of({"judge", "out.h5"});
  const std::vector<double> rates = judged["worlds"]["goal_rates"];
  ASSERT_EQ(rates.size(), 12U);
  EXPECT_EQ(judged["rate"].get<double>(), *std::ranges::min_element(rates));
  EXPECT_LT(judged["rate_high"].get<double>(), 0.7);
  EXPECT_EQ(judged["worlds"]["rule"]["conditions"][0]["parameter"], "friction.n");
  EXPECT_GT(judged["worlds"]["missed"].get<int>(), 0);
  EXPECT_GT(judged["worlds"]["met"].get<int>(), 0);
}

TEST_F(WorldStudy, HasASummaryByWorld) {
  const std::string text = program({"summary", "out.h5"}).out;
  EXPECT_TRUE(says(text, "rates over all trials are averages over the worlds", "moves in goal (worst world)",
                   "by world: the lowest, median and highest rate of 12 worlds"));
  const Json worlds = json_of({"summary", "out.h5"})["points"][0]["worlds"];
  EXPECT_EQ(worlds["n"], 12);
  EXPECT_LE(worlds["success"]["worst"], worlds["success"]["median"]);
  EXPECT_LE(worlds["success"]["median"], worlds["success"]["best"]);
  EXPECT_TRUE(says(program({"summary", "out.h5", "--format", "csv"}).out, "worlds_goal_missed"));
}

TEST_F(WorldStudy, NamesTheMeasurementToMakeNext) {
  const Json learned = json_of({"learn", "out.h5"});
  EXPECT_EQ(learned["worlds"], 12);
  EXPECT_EQ(learned["unknowns"][0]["parameter"], "creep_extension")
      << learned.dump(1);                     // of n, at one torque
  EXPECT_EQ(learned["unknowns"].size(), 4U);  // with the extension and the rate of creep
  const ProgramResult text = program({"learn", "out.h5"});
  EXPECT_EQ(text.code, 0);
  EXPECT_TRUE(says(text.out, "friction.n", "creep_extension (rad): ", "need not be the cause"));
  folder_.write("plain.yaml", small_manifest(4, ""));
  ASSERT_EQ(program({"run", "plain.yaml", "-o", "plain.h5"}).code, 0);
  EXPECT_TRUE(says(refusal({"learn", "plain.h5"}), "nothing differs between worlds"));
}

// Few trials decide no world, though all of them meet the goal as observed; many decide it. What is to be
// done next follows from the verdict.
TEST_F(WorldStudy, NamesTheNextStepForEachVerdict) {
  struct Case {
    std::string trials, moves, within, status, next;
    int code;
  };
  for (const Case& one : {Case{"48", "0.3", "0.25", "undecided", "more_trials", 3},
                          Case{"480", "0.2", "0.25", "met", "nothing", 0},
                          Case{"480", "0.9", "0.02", "missed", "change_axis", 0}}) {
    ASSERT_EQ(program({"run", "study.yaml", "-o", "case.h5", "--force", "--set", "trials=" + one.trials,
                       "--set", "friction.n={interval: [1.9, 2.0]}", "--set",
                       fmt::format("goal={{band: 0, within: {}, moves: {}}}", one.within, one.moves)})
                  .code,
              0);
    const Json judged = json_of({"judge", "case.h5"});
    const Json learned = json_of({"learn", "case.h5"});
    EXPECT_EQ(judged["status"], one.status) << judged;
    EXPECT_EQ(learned["status"], judged["status"]);
    EXPECT_EQ(learned["needed"], judged["needed"]);
    EXPECT_EQ(learned["next"], one.next) << learned;
    EXPECT_EQ(learned["undecided"], judged["worlds"]["undecided"]);
    const ProgramResult text = program({"learn", "case.h5"});
    EXPECT_EQ(text.code, one.code);
    EXPECT_TRUE(says(text.out, judged["headline"].get<std::string>()));
    EXPECT_EQ(text.out.find("no measurement is needed") != std::string::npos, one.status == "met")
        << text.out;
  }
}

TEST_F(WorldStudy, SeparatesInfluencesWithinAndBetweenWorlds) {
  const Json outputs = json_of({"sensitivity", "out.h5"})["points"][0]["outputs"];
  ASSERT_EQ(outputs.size(), 4U);
  EXPECT_EQ(outputs[1]["output"], "goal_between_worlds");
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (const Json& factor : outputs[i]["factors"]) {
      const std::string name = factor["name"];
      EXPECT_EQ(name == "friction.n" || name == "friction.alpha", i % 2 == 1) << name;
    }
  }
}

TEST_F(WorldStudy, IsPlottedByWorld) {
  const std::string figures = program({"plot", "out.h5"}).out;
  EXPECT_TRUE(says(figures, "worlds\n", "world-rate-2\n"));
}

TEST_F(WorldStudy, IsPlannedAndConfirmedInEqualWorlds) {
  const Json plan = json_of({"plan", "study.yaml"});
  EXPECT_EQ(plan["plans"][0]["trials"].get<std::int64_t>() % 12, 0);
  const ProgramResult confirmed = program({"summary", "out.h5", "--confirm", "240"});
  EXPECT_EQ(confirmed.code, 0) << confirmed.err;
  EXPECT_TRUE(says(confirmed.out, "it must hold in each of 12 worlds"));
}

// Trials of one world are alike: against other worlds, worlds are what is compared.
TEST_F(WorldStudy, IsComparedOverWorldsIfTheyDiffer) {
  ASSERT_EQ(program({"run", "study.yaml", "-o", "other.h5", "--set", "seed=12"}).code, 0);
  const ProgramResult other = program({"compare", "out.h5", "other.h5"});
  EXPECT_NE(other.code, 1) << other.out;
  EXPECT_TRUE(says(other.out, "tests and bounds are over worlds"));
  ASSERT_EQ(program({"run", "study.yaml", "-o", "same.h5", "--set", "controller.ki=2.9e-5"}).code, 0);
  const ProgramResult same = program({"compare", "out.h5", "same.h5"});
  EXPECT_FALSE(says(same.out, "tests and bounds are over worlds"));
  EXPECT_TRUE(says(same.out, "averages over the worlds"));
}

// The real machine lives in one of the worlds.
TEST_F(WorldStudy, AgreesWithARealMachineIfOneWorldDoes) {
  const auto verdict_of = [&](const std::string& successes) {
    folder_.write("observed.yaml", std::string(study_in_worlds) + "observed: {all: {successes: " + successes +
                                       ", of: 100}}\n");
    EXPECT_EQ(program({"run", "observed.yaml", "-o", "observed.h5", "--force"}).code, 0);
    return json_of({"summary", "observed.h5"})["points"][0]["observed_counts"]["verdict"].get<std::string>();
  };
  EXPECT_EQ(verdict_of("100"), "consistent");
  EXPECT_EQ(verdict_of("20"), "differs");
}

TEST_F(WorldStudy, IsTunedForItsWorstWorld) {
  const ProgramResult tuned =
      program({"tune", "study.yaml", "-o", "tuned.h5", "--quiet", "--budget", "20000", "--set",
               "goal={band: 4, within: 0.2, moves: 0.7}", "--set",
               "tune={free: {controller.ki: {log: [1.0e-5, 4.0e-5]}}}", "--format", "json"});
  ASSERT_EQ(tuned.code, 0) << tuned.err;
  const Json proof = Json::parse(tuned.out)["proof"];
  EXPECT_EQ(proof["worlds"]["met"], 12);
  EXPECT_EQ(proof["trials"].get<std::int64_t>() % 12, 0);
  const Json judged = json_of({"judge", "tuned.h5"});
  EXPECT_EQ(judged["rate"], proof["rate"]);
}

// Another seed draws other worlds: it is another series.
TEST_F(WorldStudy, HasAHistoryOfItsWorstWorldForEachSeed) {
  ASSERT_EQ(program({"run", "study.yaml", "-o", "other.h5", "--set", "seed=12"}).code, 0);
  for (const char* file : {"out.h5", "other.h5"})
    ASSERT_EQ(program({"history", "add", file, "--database", "runs.sqlite"}).code, 0);
  const Json series = Json::parse(
      program({"history", "show", "--database", "runs.sqlite", "--measure", "goal_rate", "--format", "json"})
          .out,
      nullptr, false)["series"];
  ASSERT_EQ(series.size(), 2U) << series.dump(1);
  EXPECT_TRUE(says(series.dump(), json_of({"judge", "out.h5"})["rate"].dump()));
}

}  // namespace
}  // namespace zerocount::testing
