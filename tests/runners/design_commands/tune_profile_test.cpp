// `tune` of trajectories: the limits of a profile and the feedforward are free.
#include <nlohmann/json.hpp>

#include "tests/runners/design_commands/tune_fixture.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Json = nlohmann::json;

/// A rigid mass without friction that a converter of 0.4915 N m can accelerate by 983 rad/s^2.
constexpr std::string_view mass_with_profile = R"(zerocount: 1
name: axis
seed: 3
trials: 200
plant: {inertia: 5.0e-4, presliding_damping: 0, sliding_damping: 0}
friction: {model: none}
command: {targets: [40000, 0], hold: 0.2, profile: {shape: trapezoidal, velocity_limit: 100, acceleration_limit: 60}}
initial: {encoder_phase: {uniform: [0, 1]}, hardening: 0, preload: 0}
controller: {units: si, sample_rate: 8000, ki: 0, kp: 20, kd: 0.15}
goal: {band: 200, within: 0.15, moves: 0.9}
tune:
  free:
    command.profile.acceleration_limit: {log: [0.01, 5000]}
    controller.feedforward.acceleration: [0, 1.0e-3]
    controller.feedforward.velocity: [0, 0.5]
)";

// The time of the goal counts from the start of the move, so that slow profiles do not win by missing
// nothing, and fast ones saturate and overshoot: the best one takes all of the converter's torque, and its
// move lasts 2·sqrt(distance/acceleration). Below 21 rad/s^2 the travel is longer than the hold.
TEST_F(Tune, FindsTheFastestProfileThatTheConverterCanFollow) {
  folder_.write("axis.yaml", std::string(mass_with_profile));
  const ProgramResult result = tune({"--extras", "room", "-m", "tuned.yaml", "--report", "page.html"});
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  const Json answer = Json::parse(result.out);
  const std::string limit = "command.profile.acceleration_limit";
  const double acceleration = answer["gains"][limit];
  constexpr double highest = 0.49152 / 5.0e-4;
  EXPECT_GT(acceleration, 0.75 * highest);
  EXPECT_LT(acceleration, 1.25 * highest);
  const double distance = 40000.0 * 2.0 * 3.14159265358979323846 / 1620000.0;
  const double criterion = answer["proof"]["criterion"];
  EXPECT_LT(criterion, 1.25 * 2.0 * std::sqrt(distance / highest));
  EXPECT_GT(answer["behaviour"][0]["peak_of_range_max"], 0.75);
  EXPECT_GE(answer["margins"]["phase"], 30.0);
  EXPECT_GT(answer["room"][limit][0], 20.0) << "slower ones are not allowed in this hold";

  const auto later_with = [&](double factor) {
    EXPECT_EQ(program({"run", "tuned.yaml", "-o", "other.h5", "--force", "--set",
                       limit + "=" + std::to_string(factor * acceleration)})
                  .code,
              0);
    const Json point = Json::parse(program({"summary", "other.h5", "--format", "json"}).out)["points"][0];
    return point["bands"].back()["settling_time"]["p95"].get<double>();
  };
  EXPECT_NEAR(later_with(1.0), criterion, 0.1 * criterion);
  EXPECT_GT(later_with(0.5), 1.2 * criterion);
  EXPECT_GT(later_with(2.0), 1.2 * criterion);
  const ProgramResult code = program({"controller", "tuned.h5", "--point", "best"});
  EXPECT_NE(code.out.find("feedforward_acceleration = " +
                          answer["gains"]["controller.feedforward.acceleration"].dump()),
            std::string::npos)
      << code.out;
}

// Every limit in these ranges makes the travel longer than the hold: no point is simulated, and the margins
// are not to blame.
TEST_F(Tune, SaysWhyNoPointAtAllIsAllowed) {
  folder_.write("axis.yaml", std::string(mass_with_profile));
  const ProgramResult result =
      tune({"--set", "tune.free={command.profile.acceleration_limit: {log: [1, 10]}}"});
  EXPECT_EQ(result.code, 1) << result.err;
  const Json answer = Json::parse(result.out);
  EXPECT_EQ(answer["status"], "unreachable");
  const std::string headline = answer["headline"];
  EXPECT_NE(headline.find("is allowed: command.hold"), std::string::npos) << headline;
  EXPECT_EQ(headline.find("margins"), std::string::npos) << headline;
}

}  // namespace
}  // namespace zerocount::testing
