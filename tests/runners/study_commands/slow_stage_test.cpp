// A linear stage whose integral gain is too low for its hold: nobody is told that it is unstable, and the
// hold that is advised decides.
#include <nlohmann/json.hpp>

#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

constexpr const char* stage =
    "zerocount: 1\nname: stage\naxis: linear\nseed: 19900701\ntrials: 40\n"
    "plant: {inertia: 5, presliding_damping: 1500, sliding_damping: 50}\n"
    "friction: {k1: {uniform: [0.9e+5, 1.1e+5]}, k2: {uniform: [1.6e+7, 2.4e+7]},\n"
    "           beta: {lognormal: {median: 2.0e+6, cv: 0.2}}, alpha: {log_uniform: [0.1, 2]},\n"
    "           lambda: 1.0e+8, breakaway: 12, stribeck_velocity: 1.0e-3}\n"
    "encoder: {resolution: 1.0e-9}\n"
    "dac: {bits: 20, resolution: 5.0e-5}\n"
    "controller: {sample_rate: 10000, kp: 0, ki: 5.0e-6}\n"
    "command: {targets: [{integers: [-30, 30]}, 0, {integers: [-30, 30]}, 0, {integers: [-30, 30]}, 0], "
    "hold: 0.3}\n"
    "initial: {encoder_phase: {uniform: [0, 1]}, preload: {uniform: [-1, 1]}}\n"
    "verdict: {dwell: 0.02, window: 0.05}\n";
constexpr std::int64_t moves_of_stage = 240;

/// What the recorded moves say, counted here.
struct Recorded {
  std::int64_t off_target{0};
  std::int64_t still_falling{0};
  std::int64_t arrived{0};
};

class SlowStage : public ::testing::Test {
 protected:
  SlowStage() { folder_.write("stage.yaml", stage); }
  ProgramResult run(std::vector<std::string> words, const std::vector<std::string>& settings = {}) const {
    for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
    return zerocount_program(words, folder_.path());
  }
  Recorded recorded(const std::string& file) const {
    Recorded counted;
    const reading::AllTrialsFile study(folder_.path() / file);
    for (const trial::MoveOutcome& move : study.outcomes(study.rows())) {
      counted.arrived += move.arrived;
      if (move.outcome != trial::Outcome::off_target) continue;
      ++counted.off_target;
      counted.still_falling += std::abs(move.final_error) < std::abs(move.midway_error);
    }
    return counted;
  }
  nlohmann::json undecided(const std::string& file) const {
    return nlohmann::json::parse(run({"summary", file, "--format", "json"}).out)["points"][0]["undecided"];
  }

  /// Runs the stage, and once more with the hold that the summary advises: how many moves of it arrive.
  std::int64_t arrived_with_advised_hold(std::vector<std::string> settings) const {
    EXPECT_EQ(run({"run", "stage.yaml", "-q", "-o", "slow.h5"}, settings).code, 0);
    const nlohmann::json said = undecided("slow.h5");
    if (!said["hold_at_least"].is_number()) return 0;
    settings.push_back(fmt::format("command.hold={}", said["hold_at_least"].get<double>()));
    EXPECT_EQ(run({"run", "stage.yaml", "-q", "-o", "advised.h5"}, settings).code, 0);
    return recorded("advised.h5").arrived;
  }

  TemporaryFolder folder_;
};

TEST_F(SlowStage, IsCalledUndecidedWithTheHoldThatDecides) {
  ASSERT_EQ(run({"run", "stage.yaml", "-q", "-o", "slow.h5"}).code, 0);
  const Recorded counted = recorded("slow.h5");
  EXPECT_LT(counted.arrived, moves_of_stage / 5);
  EXPECT_GT(counted.off_target, moves_of_stage / 2);

  const nlohmann::json said = undecided("slow.h5");
  EXPECT_EQ(said["moves"], moves_of_stage);
  EXPECT_EQ(said["off_target"], counted.off_target);
  EXPECT_EQ(said["still_falling"], counted.still_falling);
  // Of a time constant T·(k1 + k2)·Δx/(2·ki) of 0.16 to 0.24 s, up to ln(2·30) are needed.
  EXPECT_GT(said["hold_at_least"], 0.6);
  EXPECT_LT(said["hold_at_least"], 1.1);

  const std::string table = run({"summary", "slow.h5"}).out;
  const std::string sentence = fmt::format(
      "\n{} of 240 moves ended more than one count off their target without oscillating; the error "
      "was still falling in {} of 240 moves at the end of the hold",
      counted.off_target, counted.still_falling);
  const std::string advice = fmt::format(
      "; hold ≥ about {} s\nSuch moves are undecided: neither stable nor "
      "shown unstable.",
      said["hold_at_least"].get<double>());
  EXPECT_TRUE(says(table, sentence)) << sentence << "\n" << table;
  EXPECT_TRUE(says(table, advice)) << advice << "\n" << table;
}

// The count chatters on its edges: some of these moves count as oscillating, and the last edge takes its
// time.
TEST_F(SlowStage, ArrivesWithTheAdvisedHoldUnderAProportionalGain) {
  EXPECT_GE(arrived_with_advised_hold({"controller.kp=0.01"}), moves_of_stage * 95 / 100);
  EXPECT_GT(undecided("slow.h5")["falling_with_ripple"], 0);
  const std::string table = run({"summary", "slow.h5"}).out;
  EXPECT_TRUE(says(table, "; it was falling, with a ripple of one count, in "));
}

TEST_F(SlowStage, IsToldOfByCheckBeforeItRuns) {
  const std::string slow = run({"check", "stage.yaml"}).err;
  EXPECT_TRUE(says(slow, "warning: point 0 (all): the loop's slowest time constant is 0.2",
                   "longer than the hold of 0.3 s: moves may end before they arrive"));
  const std::string slower = run({"check", "stage.yaml"}, {"controller.ki=1.0e-6"}).err;
  EXPECT_TRUE(says(slower, "exceeds the hold of 0.3 s; a move of "));
  EXPECT_EQ(run({"check", "stage.yaml"}, {"command.hold=1.1"}).err, "");
}

}  // namespace
}  // namespace zerocount::testing
