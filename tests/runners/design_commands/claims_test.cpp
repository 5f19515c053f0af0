// `tune`, `limits` and `worst` of several goals under several conditions: each claim is that of the study
// whose manifest has the overrides of its condition in the sections.

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

/// A condition of a study, written as overrides and as sections of a manifest with the same values.
struct Condition {
  std::string name;
  std::string overrides;
  std::string inertia, delay;
};

const std::vector<Condition> two_conditions{
    {"empty", "{}", "5.54e-4", "1"},
    {"loaded", "{plant.inertia: 8.0e-4, controller.delay: {uniform: [1, 1.5]}}", "8.0e-4",
     "{uniform: [1, 1.5]}"}};

constexpr std::string_view two_goals =
    "goals:\n"
    "  large: {on: [0, 1], band: 1, within: 0.03, moves: 0.9, machines: 0.8}\n"
    "  small: {on: [2], band: 1, within: 0.03, moves: 0.8, limits: {overshoot: 10}}\n";

class Claims : public ProgramTest {
 protected:
  /// A manifest with `trials` trials under each of these conditions; with a single one, its values are in the
  /// sections.
  static std::string study(const std::vector<Condition>& conditions, int trials, const std::string& more,
                           const std::string& command = "{targets: [29, 0, 5], hold: 0.1}") {
    std::string text = fmt::format(
        "zerocount: 1\nname: axis\nseed: 7\nmachines: 40\ntrials: {}\ncommand: {}\n"
        "friction: {{k1: {{lognormal: {{median: 130, cv: 0.2}}, per: machine}}}}\n"
        "initial: {{encoder_phase: {{uniform: [0, 1]}}}}\n",
        trials * static_cast<int>(conditions.size()), command);
    const Condition& in_sections = conditions.front();
    text += fmt::format("plant: {{inertia: {}}}\ncontroller: {{ki: 3.0e-5, delay: {}}}\n",
                        in_sections.inertia, in_sections.delay);
    if (conditions.size() > 1) {
      text += "conditions:\n";
      for (const Condition& one : conditions) text += fmt::format("  {}: {}\n", one.name, one.overrides);
    }
    return text + more;
  }

  Json answer(std::vector<std::string> words, int code = 0) {
    words.insert(words.end(), {"--format", "json"});
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, code) << result.err << result.out;
    return Json::parse(result.out);
  }
};

constexpr std::string_view three_gains =
    "tune: {free: {controller.ki: {log: [5.0e-6, 1.0e-3]}, controller.kp: [0, 5.0e-3], "
    "controller.kd: [0, 3.0e-3]}, margins: off}\n";

// The proof is a plain run: each goal under each condition has the rate of a study of that condition alone.
TEST_F(Claims, TuningAgreesWithPlainRunsAtTheTunedValues) {
  const std::string goals =
      "goals:\n"
      "  large: {on: [0, 1], band: 1, within: 0.012, moves: 0.9, machines: 0.8}\n"
      "  small: {on: [2], band: 1, within: 0.005, moves: 0.7}\n";
  folder_.write("axis.yaml", study(two_conditions, 80, goals + std::string(three_gains)));
  const ProgramResult result = program(
      {"tune", "axis.yaml", "-o", "tuned.h5", "--budget", "16000", "--extras", "none", "--format", "json"});
  ASSERT_NE(result.code, 2) << result.err;
  const Json tuned = Json::parse(result.out);
  ASSERT_EQ(tuned["claims"].size(), 4U) << result.out;
  int below_one = 0;
  for (const Condition& condition : two_conditions) {
    folder_.write("alone.yaml", study({condition}, 80, goals));
    std::vector<std::string> words{"run", "alone.yaml", "-o", "alone.h5", "--force", "--quiet"};
    const auto set = [&](const std::string& key, const std::string& value) {
      words.insert(words.end(), {"--set", key + "=" + value});
    };
    const Json& proof = tuned["proof"];
    set("trials", std::to_string(proof["trials"].get<int>() / 2));
    set("machines", proof["machine_count"].dump());
    set("seed", proof["seed"].dump());
    for (const auto& [name, value] : tuned["gains"].items()) set(name, value.dump());
    ASSERT_EQ(program(words).code, 0);
    const Json alone = answer({"summary", "alone.h5"})["points"][0]["goals"];
    for (const Json& claim : tuned["claims"]) {
      if (claim["condition"] != condition.name) continue;
      const Json& expected = alone[claim["goal"].get<std::string>()];
      EXPECT_EQ(claim["rate"], expected["rate"]) << claim;
      EXPECT_EQ(claim.contains("machines"), claim["goal"] == "large") << claim;
      if (claim.contains("machines")) {
        EXPECT_EQ(claim["machines"], expected["machines"]) << claim;
      }
      EXPECT_LE(claim["rate_low"], expected["rate_low"]) << "allows for the attempts";
      below_one += claim["rate"] < 1.0 ? 1 : 0;
    }
  }
  EXPECT_GT(below_one, 0);
  // The worst of them is the headline's, and that of the file.
  const Json judged = Json::parse(program({"judge", "tuned.h5", "--format", "json"}).out);
  for (const char* const key : {"status", "rate", "rate_low", "rate_high", "machines_low"})
    EXPECT_EQ(tuned["proof"].value(key, Json()), judged.value(key, Json())) << key;
  EXPECT_EQ(tuned["proof"]["goal"], judged["worst_goal"]);
  EXPECT_EQ(tuned["proof"]["condition"], judged["worst_condition"]);
  EXPECT_EQ(tuned["needed"], judged["needed"]);
}

// Gains for one condition fail the other; those for both are met wherever some are.
TEST_F(Claims, TuningForAllConditionsIsNotWorseThanForOne) {
  const std::vector<Condition> apart{
      {"light", "{}", "3.0e-4", "1"},
      {"heavy", "{plant.inertia: 2.4e-3, controller.delay: 2}", "2.4e-3", "2"}};
  const std::string goal =
      "goal: {band: 1, within: 0.06, moves: 0.9, limits: {overshoot: 14}}\n" + std::string(three_gains);
  const auto status_at = [&](const Json& gains) {
    std::vector<std::string> words{"run",   "both.yaml", "-o",    "at.h5",       "--force", "--quiet",
                                   "--set", "seed=99",   "--set", "trials=3200", "--set",   "machines=800"};
    for (const auto& [name, value] : gains.items())
      words.insert(words.end(), {"--set", name + "=" + value.dump()});
    EXPECT_EQ(program(words).code, 0);
    return Json::parse(program({"judge", "at.h5", "--format", "json"}).out);
  };
  const auto tune = [&](const std::string& manifest) {
    const ProgramResult result = program({"tune", manifest, "-o", "tuned.h5", "--force", "--budget", "20000",
                                          "--extras", "none", "--format", "json"});
    EXPECT_NE(result.code, 2) << result.err;
    return Json::parse(result.out)["gains"];
  };
  folder_.write("both.yaml", study(apart, 80, goal));
  double worst = 1.0;
  for (const Condition& condition : apart) {
    folder_.write("alone.yaml", study({condition}, 80, goal));
    worst = std::min(worst, status_at(tune("alone.yaml"))["rate"].get<double>());
  }
  const Json both = status_at(tune("both.yaml"));
  EXPECT_EQ(both["status"], "met") << both;
  EXPECT_LT(worst, 0.9) << "one condition alone is not enough";
}

TEST_F(Claims, LimitsAgreeWithEachConditionAlone) {
  folder_.write("both.yaml", study(two_conditions, 80, std::string(two_goals)));
  const Json both = answer({"limits", "both.yaml"})["limits"];
  std::vector<Json> alone;
  for (const Condition& condition : two_conditions) {
    folder_.write("alone.yaml", study({condition}, 80, std::string(two_goals)));
    alone.push_back(answer({"limits", "alone.yaml"})["limits"]);
  }
  ASSERT_GT(both.size(), 5U);
  for (const Json& limit : both) {
    const std::string cause = limit["cause"];
    if (cause.find(" and ") != std::string::npos) continue;
    SCOPED_TRACE(cause);
    for (std::size_t condition = 0; condition < alone.size(); ++condition) {
      const auto same =
          std::ranges::find_if(alone[condition], [&](const Json& one) { return one["cause"] == cause; });
      ASSERT_NE(same, alone[condition].end());
      for (const char* const goal : {"large", "small"})
        EXPECT_EQ(limit["rates"][fmt::format("{}, {}", goal, two_conditions[condition].name)],
                  (*same)["rates"][goal]);
    }
    const std::string worst =
        fmt::format("{}, {}", limit["goal"].get<std::string>(), limit["condition"].get<std::string>());
    EXPECT_EQ(limit["rate"], limit["rates"][worst]);
  }
  // Of one goal the rate is the lowest of all conditions.
  const std::string goal = "goal: {band: 1, within: 0.03, moves: 0.9}\n";
  folder_.write("both.yaml", study(two_conditions, 80, goal));
  double lowest = 1.0;
  for (const Condition& condition : two_conditions) {
    folder_.write("alone.yaml", study({condition}, 80, goal));
    lowest = std::min(lowest, answer({"limits", "alone.yaml"})["limits"][0]["rate"].get<double>());
  }
  EXPECT_EQ(answer({"limits", "both.yaml"})["limits"][0]["rate"], lowest);
}

TEST_F(Claims, WorstMachineIsThatOfItsWorstCondition) {
  const std::string goal = "goal: {band: 1, within: 0.02, moves: 0.9}\n";
  const std::string command = "{targets: [29], hold: 0.05}";
  folder_.write("both.yaml", study(two_conditions, 80, goal, command));
  const Json both = answer({"worst", "both.yaml", "-o", "worst.yaml"});
  std::vector<Json> alone;
  for (const Condition& condition : two_conditions) {
    folder_.write("alone.yaml", study({condition}, 80, goal, command));
    alone.push_back(answer({"worst", "alone.yaml"}));
  }
  for (const char* const machine : {"box", "likely"}) {
    const auto met = [&](const Json& one) { return one[machine]["met"].get<double>(); };
    const auto worst = std::ranges::min_element(alone, {}, met);
    EXPECT_EQ(both[machine]["condition"],
              two_conditions[static_cast<std::size_t>(worst - alone.begin())].name);
    EXPECT_EQ(both[machine]["met"], met(*worst));
    EXPECT_EQ(both[machine]["quantiles"], (*worst)[machine]["quantiles"]);
  }
  // Its manifest has the condition in its sections.
  ASSERT_EQ(program({"run", "worst.yaml", "-o", "worst.h5", "--quiet"}).code, 0);
  const Json replayed = Json::parse(program({"judge", "worst.h5", "--format", "json"}).out);
  EXPECT_TRUE(!replayed["claims"][0].contains("condition")) << replayed;
  EXPECT_DOUBLE_EQ(replayed["rate"].get<double>(), both["box"]["met"].get<double>());
  EXPECT_FALSE(both["box"].contains("goal")) << "there is one";
  // The trial that is named is one under the named condition.
  const int trial = both["trial"];
  EXPECT_EQ(both["condition"], two_conditions[static_cast<std::size_t>(trial / 40 % 2)].name);
  EXPECT_EQ(both["machine"], trial % 40);
}

// Of several goals it is named which one the worst machine meets the least often, as its manifest shows.
TEST_F(Claims, WorstMachineNamesTheGoal) {
  const std::string goals =
      "goals:\n  large: {on: [0, 1], band: 1, within: 0.03, moves: 0.9}\n"
      "  small: {on: [2], band: 40, within: 0.09, moves: 0.8}\n";
  folder_.write("both.yaml", study(two_conditions, 80, goals));
  const Json box = answer({"worst", "both.yaml", "-o", "worst.yaml", "--set", "controller.ki=1.0e-5"})["box"];
  ASSERT_LT(box["met"], 1.0);
  ASSERT_EQ(program({"run", "worst.yaml", "-o", "worst.h5", "--quiet"}).code, 0);
  const Json claims = Json::parse(program({"judge", "worst.h5", "--format", "json"}).out)["claims"];
  ASSERT_EQ(claims.size(), 2U);
  ASSERT_NE(claims[0]["rate"], claims[1]["rate"]);
  EXPECT_EQ(box["goal"], claims[claims[0]["rate"] < claims[1]["rate"] ? 0 : 1]["goal"]) << claims;
}

}  // namespace
}  // namespace zerocount::testing
