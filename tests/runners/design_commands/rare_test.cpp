// `rare`, from the manifest to the replayed failure.

#include "core/numerics/normal_distribution.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

/// Manifest of a move by 30 counts against a spring without creep. The highest code of the converter is 2047,
/// and the target count begins at 29.5 counts. So the move reaches its target if and only if k1 is at most
/// 2047·resolution/(29.5·2π/1620000).
/// @param probability probability that k1 is larger, with which a trial fails
std::string spring(double probability) {
  const double spread = std::sqrt(std::log(1.01));
  const double k1 = 110.0 * std::exp(-spread * numerics::normal_quantile(probability));
  return fmt::format(
      "zerocount: 1\n"
      "name: spring\n"
      "seed: 1\n"
      "trials: 100\n"
      "friction: {{model: spring, k1: {{lognormal: {{median: 110, cv: 0.1}}}}, k2: 0, breakaway: 10}}\n"
      "dac: {{bits: 12, resolution: {}}}\n"
      "controller: {{ki: 1.0e-5}}\n"
      "command: {{targets: [30], hold: 1.0}}\n"
      "initial: {{encoder_phase: 0.5}}\n"
      "goal: {{band: 0, within: 0.8, moves: 0.99}}\n",
      k1 * 29.5 * 2.0 * std::numbers::pi / 1620000.0 / 2047.0);
}

constexpr const char* on_rotors =
    "zerocount: 1\n"
    "name: rotors\n"
    "seed: 12\n"
    "machines: 100\n"
    "trials: 100\n"
    "friction:\n"
    "  k1: {profile: {mean: {lognormal: {median: 110, cv: 0.1}}, cv: 0.1, correlation_length: 0.2}}\n"
    "  k2: {truncated_normal: {mean: 750, sd: 110, low: 500, high: 1000}}\n"
    "command: {targets: [{integers: [1, 30]}], hold: 0.06}\n"
    "initial: {encoder_phase: {uniform: [0, 1]}, position: {uniform: [0, 6.283185307179586]}}\n"
    "controller: {ki: 5.0e-5, kp: 2.0e-4}\n"
    "goal: {band: 1, within: 0.03, moves: 0.99}\n";

class Rare : public ProgramTest {
 protected:
  Json answer_to(std::vector<std::string> words, int code = 0) {
    words.insert(words.end(), {"--format", "json", "-q"});
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, code) << result.err;
    return Json::parse(result.out, nullptr, false);
  }
  void expect_refused(const std::vector<std::string>& words, const std::string& reason, int code = 2) {
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, code) << result.out;
    EXPECT_TRUE(says(result.err, reason));
  }
};

// Bounds of 95 % hold in both repetitions with a probability of 0.9 at least; here they do.
TEST_F(Rare, BoundsHoldIfASpringSaturatesTheConverter) {
  for (const double probability : {1e-4, 1e-8}) {
    folder_.write("spring.yaml", spring(probability));
    const Json answer = answer_to({"rare", "spring.yaml", "-o", "rare.h5", "--force"});
    EXPECT_EQ(answer["status"], "estimated");
    EXPECT_LE(answer["low"].get<double>(), probability) << answer;
    EXPECT_GE(answer["high"].get<double>(), probability) << answer;
    EXPECT_LE(answer["high"].get<double>(), 2.0 * answer["low"].get<double>());
    EXPECT_LT(answer["trials"].get<std::int64_t>(), 150'000);
    EXPECT_EQ(answer["inputs"][0]["parameter"], "friction.k1");
    EXPECT_GT(answer["inputs"][0]["shift"].get<double>(), 3.0);
  }
}

TEST_F(Rare, FailuresAreReplayed) {
  folder_.write("rotors.yaml", on_rotors);
  const Json answer = answer_to({"rare", "rotors.yaml", "-o", "rare.h5"});
  EXPECT_EQ(answer["machines"]["examined"], 48);
  const ProgramResult text = program({"rare", "rotors.yaml", "-o", "rare.h5"});
  EXPECT_EQ(text.code, 0);
  const auto at = text.out.find("--trial ");
  ASSERT_NE(at, std::string::npos) << text.out;
  const std::string trial = text.out.substr(at + 8, text.out.find_first_of(",\n", at) - at - 8);
  EXPECT_EQ(program({"trace", "rare.h5", "--trial", trial, "-o", "failure.csv"}).code, 0);
  expect_refused({"trace", "rare.h5", "--trial", "100000000"}, "--trial");
  expect_refused({"trace", "rare.h5", "--point", "0"}, "belongs to one point of one manifest");
}

// With a larger budget the same command goes on; the answer is that of one run.
TEST_F(Rare, AnUnfinishedEstimateContinues) {
  folder_.write("spring.yaml", spring(1e-5));
  const std::vector<std::string> narrow{"rare", "spring.yaml", "--ratio", "1.25", "-o"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> words = narrow;
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const Json whole = answer_to(with({"whole.h5"}));
  const Json part =
      answer_to(with({"part.h5", "--budget", std::to_string(whole["trials"].get<int>() - 900)}), 3);
  EXPECT_EQ(part["status"], "undecided");
  const Json rest = answer_to(with({"part.h5"}));
  for (const char* key : {"probability", "low", "high", "trials", "status"})
    EXPECT_EQ(rest[key], whole[key]) << key;
  expect_refused({"rare", "spring.yaml", "-o", "whole.h5", "--set", "seed=9"}, "--force to replace it");
  expect_refused({"rare", "spring.yaml", "-o", "whole.h5", "--event", "arrival_time > 0.1"},
                 "--force to replace it");
}

// The event that is the missed goal has the same trials and the same answer. Other commands say that its file
// holds no study.
TEST_F(Rare, AnEventIsDefinedByAMeasure) {
  folder_.write("spring.yaml", spring(1e-4));
  const Json goal = answer_to({"rare", "spring.yaml", "-o", "goal.h5"});
  const Json event =
      answer_to({"rare", "spring.yaml", "-o", "event.h5", "--event", "band_settling_time[0] > 0.8"});
  EXPECT_EQ(goal["probability"], event["probability"]);
  EXPECT_EQ(event["event"], "band_settling_time[0] > 0.8");
  for (const char* command : {"summary", "judge", "sensitivity"})
    expect_refused({command, "goal.h5"}, "an estimate of 'zerocount rare'", 4);
}

// Nothing leads to an event that does not exist.
TEST_F(Rare, IsUndecidedIfNothingFails) {
  folder_.write("spring.yaml", spring(1e-4));
  const Json answer = answer_to(
      {"rare", "spring.yaml", "-o", "rare.h5", "--event", "holding_torque < -1", "--budget", "100000"}, 3);
  EXPECT_EQ(answer["status"], "undecided");
  EXPECT_TRUE(answer["probability"].is_null());
  EXPECT_EQ(answer["low"], 0.0);
  const double plain = answer["plain"]["trials"];
  EXPECT_GE(plain, 3'000);  // the search for failures takes the others
  EXPECT_LT(answer["high"].get<double>(), 10.0 / plain);
  EXPECT_EQ(answer["budget"]["trials"], 100000);
}

// Of 12 000 loads in a list one takes more torque than the converter has. Its neighbours in the list are like
// all others, and the failure of stiff contacts, to which a score leads, is 800 times rarer.
TEST_F(Rare, TriesEveryEntryOfAChoice) {
  constexpr std::int64_t entries = 12'000;
  std::string loads;
  for (std::int64_t i = 0; i < entries; ++i)
    loads += fmt::format("{}{:.3e}", i == 0 ? "" : ", ",
                         i == 8345 ? -0.05 : 1e-11 * static_cast<double>(i * 7919 % entries));
  folder_.write("listed.yaml", spring(1e-7) + "disturbance: {torque: {choice: [" + loads + "]}}\n");
  const double probability = 1.0 / static_cast<double>(entries) + 1e-7;
  const Json answer = answer_to({"rare", "listed.yaml", "-o", "rare.h5"});
  EXPECT_LE(answer["low"].get<double>(), probability) << answer;
  EXPECT_GE(answer["high"].get<double>(), probability) << answer;
  ASSERT_EQ(answer["values"].size(), 1U) << answer;
  EXPECT_EQ(answer["values"][0]["parameter"], "disturbance.torque");
  EXPECT_EQ(answer["values"][0]["value"], "-0.05");
  const ProgramResult text = program({"rare", "listed.yaml", "-o", "rare.h5"});  // goes on
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_TRUE(says(text.out, "single values at which failures are frequent"));
}

// The answer of a budget in time depends on the machine, and says so.
TEST_F(Rare, ReportsThatATimeBudgetDependsOnTheComputer) {
  folder_.write("spring.yaml", spring(1e-6));
  const std::string words = "depend on the machine";
  const ProgramResult in_time = program({"rare", "spring.yaml", "-o", "time.h5", "--budget", "0.01s"});
  EXPECT_EQ(in_time.code, 3);
  EXPECT_TRUE(says(in_time.out, words));
  const ProgramResult in_trials = program({"rare", "spring.yaml", "-o", "trials.h5", "--budget", "2000"});
  EXPECT_EQ(in_trials.code, 3);
  EXPECT_FALSE(says(in_trials.out, words));
}

// The likely machine that the gain suits worst looks like the machines of rare failures.
TEST_F(Rare, TheWorstLikelyMachineLooksLikeTheFailures) {
  folder_.write("creeping.yaml",
                "zerocount: 1\n"
                "name: creeping\n"
                "seed: 11\n"
                "trials: 500\n"
                "friction:\n"
                "  k1: {lognormal: {median: 110, cv: 0.1}}\n"
                "  k2: {truncated_normal: {mean: 750, sd: 110, low: 500, high: 1000}}\n"
                "  beta: {lognormal: {median: 1.0e+5, cv: 0.2}}\n"
                "command: {targets: [{integers: [1, 30]}], hold: 0.06}\n"
                "initial: {encoder_phase: {uniform: [0, 1]}}\n"
                "controller: {ki: 3.0e-5}\n"
                "goal: {band: 1, within: 0.042, moves: 0.99}\n");
  const Json failures = answer_to({"rare", "creeping.yaml", "-o", "rare.h5"});
  const Json worst = Json::parse(program({"worst", "creeping.yaml", "--format", "json"}).out);
  int compared = 0;
  for (const Json& input : failures["inputs"]) {
    const double shift = input["shift"];
    const std::string name = input["parameter"];
    if (std::abs(shift) < 1.0 || !worst["likely"]["inputs"].contains(name)) continue;
    const double value = worst["likely"]["inputs"][name];
    EXPECT_EQ(value > input["usual"]["median"].get<double>(), shift > 0.0) << name << ' ' << worst;
    ++compared;
  }
  EXPECT_GE(compared, 1);
  EXPECT_GE(worst["likely"]["met"].get<double>(), worst["box"]["met"].get<double>());
}

// The estimate under a condition is that of the study whose manifest has its overrides, and goes on as such.
TEST_F(Rare, EstimatesTheSelectedCondition) {
  const std::string text = spring(1e-4);
  folder_.write("both.yaml", text + "conditions: {usual: {}, weak: {dac.bits: 11}}\n");
  folder_.write("weak.yaml", text);
  expect_refused({"rare", "both.yaml", "-o", "out.h5"}, "expected --condition with one of usual, weak");
  expect_refused({"rare", "both.yaml", "-o", "out.h5", "--condition", "strong"},
                 "expected --condition with one of usual, weak");
  expect_refused({"rare", "weak.yaml", "-o", "out.h5", "--condition", "weak"},
                 "it has no conditions; expected no --condition");
  for (const auto& [condition, bits] : {std::pair{"usual", "12"}, std::pair{"weak", "11"}}) {
    const Json alone = answer_to({"rare", "weak.yaml", "-o", "alone.h5", "--force", "--set",
                                  std::string("dac.bits=") + bits, "--set", "trials=50"});
    const Json of_it = answer_to({"rare", "both.yaml", "-o", "rare.h5", "--force", "--condition", condition});
    EXPECT_EQ(of_it["condition"], condition);
    for (const char* const number : {"probability", "low", "high", "trials"})
      EXPECT_EQ(of_it[number], alone[number]) << condition;
    EXPECT_FALSE(alone.contains("condition"));
  }
  // The file knows its condition: it goes on with it, refuses another, and replays its trials.
  answer_to({"rare", "both.yaml", "-o", "rare.h5", "--condition", "weak"});
  expect_refused({"rare", "both.yaml", "-o", "rare.h5", "--condition", "usual"}, "its condition differs");
  EXPECT_EQ(program({"trace", "rare.h5", "--trial", "0", "-o", "trial.csv"}).code, 0);
}

// A move that no goal is about does not dilute the probability.
TEST_F(Rare, CountsOnlyMovesThatTheGoalJudges) {
  const std::string text = spring(1e-3);
  folder_.write("one.yaml", text);
  const double one = answer_to({"rare", "one.yaml", "-o", "one.h5"})["probability"];
  std::string two = text;
  const std::string goal = "goal: {band: 0";
  two.replace(two.find(goal), goal.size(), "goal: {on: [0], band: 0");
  folder_.write("two.yaml", two);
  const Json answer = answer_to({"rare", "two.yaml", "-o", "two.h5", "--set", "command.targets=[30, 0]"});
  EXPECT_NEAR(answer["probability"].get<double>(), one, 0.4 * one);
}

TEST_F(Rare, MissingInputsAreRefusedWithTheReason) {
  folder_.write("fixed.yaml",
                "zerocount: 1\nname: fixed\nseed: 1\ntrials: 1\ncommand: {targets: [1], hold: 0.1}\n"
                "goal: {band: 0, within: 0.1, moves: 0.9}\n");
  expect_refused({"rare", "fixed.yaml", "-o", "out.h5"}, "it draws nothing for each trial");
  const std::string text = spring(1e-4);
  folder_.write("swept.yaml", text + "sweep: {grid: {controller.kp: [0, 1.0e-5]}}\n");
  expect_refused({"rare", "swept.yaml", "-o", "out.h5"}, "expected one with --point");
  folder_.write("worlds.yaml", text + "worlds: 4\n");
  expect_refused({"rare", "worlds.yaml", "-o", "out.h5", "--set", "friction.k2={interval: [0, 1]}"},
                 "expected one with --world");
  folder_.write("spring.yaml", text);
  for (const auto& [option, value] : std::vector<std::pair<std::string, std::string>>{{"--ratio", "0.9"},
                                                                                      {"--budget", "soon"},
                                                                                      {"--confidence", "1"},
                                                                                      {"--event", "x > 1"},
                                                                                      {"--world", "0"}})
    expect_refused({"rare", "spring.yaml", "-o", "out.h5", option, value}, option);
}

}  // namespace
}  // namespace zerocount::testing
