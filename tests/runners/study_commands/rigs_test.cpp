// Studies with rigs, from the manifest to the file and back.
#include <nlohmann/json.hpp>

#include "core/friction/profile.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/reading/first_difference.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

// Moves that slide and stick again, on machines that differ.
const char* const machines =
    "zerocount: 1\nname: machines\nseed: 5\ntrials: 40\nrigs: 8\n"
    "friction:\n"
    "  k1: {profile: {mean: {lognormal: {median: 110, cv: 0.2}}, cv: 0.1, correlation_length: 0.3}}\n"
    "  k2: {uniform: [600, 900]}\n"
    "  breakaway: {uniform: [0.02, 0.03], per: contact}\n"
    "command: {targets: [{integers: [200, 300]}, 0], hold: 0.1}\n"
    "initial: {position: {uniform: [0, 6.283185307179586]}}\n"
    "verdict: {dwell: 0.02, window: 0.02}\n"
    "sweep: {grid: {controller.ki: [2.0e-5, 6.0e-5]}}\n"
    "retain: {trials: [3]}\n";

class RigStudy : public ProgramTest {
 protected:
  RigStudy() { write_bytes(folder_ / "m.yaml", machines); }

  void run(std::vector<std::string> more) {
    std::vector<std::string> words{"run", "m.yaml"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = program(words);
    ASSERT_EQ(result.code, 0) << result.err;
  }
};

TEST_F(RigStudy, CheckSaysHowManyTrialsARigHasAndWhatItIsThatDiffers) {
  const ProgramResult result = program({"check", "m.yaml"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(says(result.out, " 8, 5 trials of each\n"));
  const auto plan = nlohmann::json::parse(program({"check", "m.yaml", "--format", "json"}).out);
  using Names = std::vector<std::string>;
  EXPECT_EQ(plan["differ_in_rigs"], (Names{"friction.k1.profile.mean", "friction.k2"}));
  EXPECT_EQ(plan["differ_in_trials"],
            (Names{"friction.k1", "friction.breakaway", "command.targets.0", "initial.position"}));
  EXPECT_EQ(plan["differ_in_contacts"], Names{"friction.breakaway"});
  EXPECT_EQ(plan["same_in_points"], Names{"controller.ki"});
}

// Of 200 rigs the softest is none of the first 20.
TEST_F(RigStudy, CheckGivesTheBoundsAtTheSoftestRotorOfAllRigs) {
  std::string text = machines;
  text.replace(text.find("trials: 40\nrigs: 8"), 18, "trials: 200\nrigs: 200");
  write_bytes(folder_ / "m.yaml", text);
  const study::Study study = manifest::load_study(folder_ / "m.yaml");
  double lowest = 1e9;
  std::int64_t softest = 0;
  for (std::int64_t rig = 0; rig < study.rigs; ++rig) {
    const std::shared_ptr<const friction::Profile> rotor = study.profiles.at(0).of_rig(rig);
    for (int i = 0; i < 4096; ++i) {
      const double k1 = friction::value_at(*rotor, i * study.period / 4096);
      if (k1 >= lowest) continue;
      lowest = k1;
      softest = rig;
    }
  }
  ASSERT_GE(softest, 20);

  // (6) of an integral control: ki < c·k1/J·Δx·T/2, with the numbers of the paper's rig.
  const double bound = 0.2 * lowest / 5.54e-4 * (study.period / 1'620'000) * 0.25e-3;
  const auto theory =
      nlohmann::json::parse(program({"check", "m.yaml", "--format", "json"}).out)["theory"][0];
  EXPECT_EQ(theory["lowest_k1_source"], "the lowest along the profiles of 200 rigs");
  EXPECT_NEAR(theory["lowest_k1"].get<double>(), lowest, 2e-3 * lowest);
  EXPECT_NEAR(theory["lowest_stable_below"].get<double>(), bound, 2e-3 * bound);
}

TEST_F(RigStudy, TheFileIsTheSameHoweverItWasRun) {
  run({"-o", "once.h5", "--threads", "1"});
  run({"-o", "a.h5", "--shard", "1/2"});
  run({"-o", "b.h5", "--shard", "2/2"});
  ASSERT_EQ(program({"merge", "a.h5", "b.h5", "-o", "joined.h5"}).code, 0);
  const reading::AllTrialsFile once(folder_ / "once.h5");
  const reading::AllTrialsFile joined(folder_ / "joined.h5");
  EXPECT_EQ(reading::first_difference(once.root(), joined.root()).value_or("none"), "none");
  std::vector<std::int64_t> success(2 * 8, 0);  // counted from the outcomes
  const std::int64_t trials = once.header().trials;
  for (std::int64_t row = 0; row < once.rows().count; ++row) {
    success[static_cast<std::size_t>(row / trials * 8 + row % trials % 8)] +=
        trial::succeeded(once.outcomes({row, 1}));
  }
  EXPECT_EQ(once.rigs().value().success, success);
  EXPECT_EQ(once.profiles().at(0).rigs, 8);
}

TEST_F(RigStudy, ATrialIsRunAgainAlone) {
  run({"-o", "once.h5", "--engine", "reference"});
  std::int64_t slid = 0;
  const reading::AllTrialsFile file(folder_ / "once.h5");
  for (const trial::MoveOutcome& move : file.outcomes(file.rows())) slid += move.broke_away;
  EXPECT_GT(slid, 20) << "the contacts after the first are to matter";
  for (const char* trial : {"3", "11", "39"}) {
    const ProgramResult result =
        program({"trace", "once.h5", "--point", "1", "--trial", trial, "--format", "json"});
    EXPECT_EQ(result.code, 0) << result.err;
    const std::string rig =
        std::string("\"trial\": ") + trial + ", \"rig\": " + std::to_string(std::stoi(trial) % 8);
    EXPECT_TRUE(says(result.out, rig)) << rig;
  }
}

}  // namespace
}  // namespace zerocount::testing
