// What `tune` refuses: sections, budgets, and files that are in its way.
#include <nlohmann/json.hpp>

#include "tests/runners/design_commands/tune_fixture.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Json = nlohmann::json;

// What a budget must be for the search and the proof is what it says.
TEST_F(Tune, RefusesABudgetThatIsTooSmallWithWhatItNeeds) {
  write_axis("goal: {band: 1, within: 0.06, moves: 0.97}\n" + std::string(two_gains));
  const ProgramResult refused = tune({}, "100");
  EXPECT_EQ(refused.code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "tuned.h5"));
  const std::size_t at = refused.err.find("expected at least ");
  ASSERT_NE(at, std::string::npos) << refused.err;
  const int needed = std::stoi(refused.err.substr(at + 18));
  EXPECT_EQ(tune({}, std::to_string(needed - 1)).code, 2);
  const ProgramResult result = tune({}, std::to_string(needed));
  ASSERT_NE(result.code, 2) << result.err;
  EXPECT_LE(Json::parse(result.out)["spent_trials"], needed);
}

TEST_F(Tune, KeepsUnfinishedRunsAndTuningsOfOthers) {
  write_axis("goal: {band: 1, within: 0.1, moves: 0.98}\n" + std::string(two_gains));
  std::filesystem::create_directory(folder_.path() / "tuned.h5.shards");
  const std::vector<std::string> command{"tune", "axis.yaml", "-o", "tuned.h5", "--budget", "2500"};
  EXPECT_NE(program(command).err.find("has an unfinished run"), std::string::npos);
  std::filesystem::remove(folder_.path() / "tuned.h5.shards");
  folder_.write("tuned.h5.tuning", "{\"zerocount_tuning\":1,\"tuning\":\"of another study\"}\n");
  EXPECT_NE(program(command).err.find("unfinished tuning of another study"), std::string::npos);
  EXPECT_EQ(program({"tune", "axis.yaml", "-o", "tuned.h5", "--budget", "2500", "--force"}).code, 0);
}

TEST_F(Tune, NeedsAGoalAndFreeParameters) {
  write_axis("goal: {band: 1, within: 0.1, moves: 0.98}\n");
  EXPECT_EQ(tune().code, 2);
  EXPECT_NE(tune().err.find("does not say what to tune"), std::string::npos);
  write_axis(std::string(two_gains));
  EXPECT_NE(tune().err.find("axis.yaml:12:3: tune: without a goal"), std::string::npos) << tune().err;
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "tuned.h5"));
}

TEST_F(Tune, RefusesWrongSectionsWithTheirPlace) {
  const auto error_of = [this](const std::string& section) {
    write_axis("goal: {within: 0.1, moves: 0.98}\n" + section + "\n");
    const ProgramResult result = program({"check", "axis.yaml"});
    EXPECT_EQ(result.code, 2) << section;
    return result.err;
  };
  EXPECT_NE(error_of("tune: {free: {controller.ko: [0, 1]}}").find("12:15: tune.free.controller.ko"),
            std::string::npos);
  EXPECT_NE(error_of("tune: {free: {controller.ki: [1, 0]}}").find("1 is not below 0"), std::string::npos);
  EXPECT_NE(error_of("tune: {free: {controller.ki: {log: [0, 1]}}}").find("0 is not above 0"),
            std::string::npos);
  EXPECT_NE(error_of("tune: {free: {friction.k1: [10, 20]}}").find("swept or drawn at random"),
            std::string::npos);
  EXPECT_NE(error_of("tune: {free: {friction.model: [0, 1]}}").find("is not a number"), std::string::npos);
  EXPECT_NE(error_of("tune: {free: {command.profile.velocity_limit: [1, 2]}}")
                .find("12:15: tune.free.command.profile.velocity_limit: it has no effect"),
            std::string::npos);
  EXPECT_NE(error_of("tune: {free: {controller.observer.inertia: [1.0e-4, 1.0e-3]}}").find("no effect"),
            std::string::npos);
  write_axis(
      "goal: {within: 0.1, moves: 0.98}\ntune: {free: {controller.observer.inertia: [1.0e-4, 1.0e-3], "
      "controller.observer.bandwidth: [0, 100]}}\n");
  EXPECT_EQ(program({"check", "axis.yaml"}).code, 0) << "the bandwidth is free too";
  EXPECT_NE(error_of("tune: {free: {controller.ki: [0, 1]}, margins: {gain: no}}").find("tune.margins.gain"),
            std::string::npos);
}

// Gains in SI units of a linear axis are far larger than those per count.
TEST_F(Tune, TakesTheRangesOfGainsInTheirUnits) {
  folder_.write("stage.yaml", R"(zerocount: 1
name: stage
axis: linear
travel: 0.2
seed: 1
trials: 20
plant: {inertia: 5, presliding_damping: 1500, sliding_damping: 50}
friction: {k1: 1.0e+5, k2: 2.0e+7, beta: 2.0e+6, lambda: 1.0e+8, breakaway: 12, stribeck_velocity: 1.0e-3}
encoder: {resolution: 1.0e-9}
dac: {bits: 20, resolution: 5.0e-5}
controller: {units: si, sample_rate: 10000, kp: 2.0e+6, ki: 5.0e+8}
command: {targets: [10], hold: 0.2}
goal: {band: 1, within: 0.1, moves: 0.9}
tune: {free: {controller.ki: {log: [1.0e+7, 5.0e+9]}, controller.kp: [0, 1.0e+7]}}
)");
  const ProgramResult result = program({"check", "stage.yaml"});
  EXPECT_EQ(result.code, 0) << result.err;
}

TEST_F(Tune, RefusesACriterionThatIsNoQuantile) {
  write_axis("goal: {within: 0.1, moves: 0.98}\n" + std::string(two_gains) + "  minimise: ki\n");
  for (const ProgramResult& result : {tune(), program({"check", "axis.yaml"})}) {
    EXPECT_EQ(result.code, 2);
    EXPECT_NE(result.err.find("tune.minimise: 'ki' is no quantile"), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace zerocount::testing
