// Values that do not fit one another are refused, wherever they can meet.
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::rules {
namespace {

struct UnfitCase {
  const char* command;
  const char* more;    // from the sixth line on
  const char* faults;  // see has_faults(); empty: understood
};

void PrintTo(const UnfitCase& tested, std::ostream* out) {
  *out << tested.command << " " << tested.more;
}

class ValueRules : public testing::TestWithParam<UnfitCase> {};

TEST_P(ValueRules, AreChecked) {
  EXPECT_TRUE(
      has_faults(refusal_of(manifest_commanding(GetParam().command, GetParam().more)), GetParam().faults));
}

INSTANTIATE_TEST_SUITE_P(
    Start, ValueRules,
    testing::Values(UnfitCase{"{targets: [1]}", "initial: {history: {reversals: 3, torque: 0.3}}",
                              "6:43: initial.history.torque | breakaway of"},
                    UnfitCase{"{targets: [1]}",
                              "initial: {history: {reversals: 3, torque: {uniform: [0, 0.35]}}}\n"
                              "friction: {breakaway: {uniform: [0.3, 0.4]}}",
                              "6:43: initial.history.torque | breakaway of"},
                    UnfitCase{"{targets: [1]}",
                              "initial: {history: {reversals: 3, torque: 0.25}}\n"
                              "sweep: {grid: {friction.breakaway: [0.3, 0.2]}}",
                              "7:42: initial.history.torque | breakaway of"},
                    UnfitCase{"{targets: [1]}", "initial: {history: {reversals: 3, torque: 0.29}}", ""},
                    UnfitCase{"{targets: [1]}", "initial: {mode: slide}", "6:17: initial.velocity | never 0"},
                    UnfitCase{"{targets: [1]}", "initial: {mode: slide, velocity: {uniform: [-1, 1]}}",
                              "6:34: initial.velocity | never 0"},
                    UnfitCase{"{targets: [1]}", "initial: {mode: slide, velocity: {choice: [-1, 1]}}", ""},
                    UnfitCase{"{targets: [1]}", "initial: {mode: slide, velocity: {uniform: [0.1, 1]}}", ""},
                    UnfitCase{"{targets: [1]}", "initial: {velocity: {uniform: [-1, 1]}}", ""},
                    UnfitCase{"{targets: [1]}",
                              "initial: {velocity: 0.1}\n"
                              "sweep: {cases: {a: {}, b: {initial.mode: slide, initial.velocity: 0}}}",
                              "7:67: initial.velocity | never 0"}));

INSTANTIATE_TEST_SUITE_P(
    TwoPhases, ValueRules,
    testing::Values(
        UnfitCase{"{targets: [1]}", "controller: {kd: 1.0e-4, coarse: {coarse_beyond: 1000}}",
                  "6:18: controller.kd | controller.coarse.kd"},
        UnfitCase{"{targets: [1]}",
                  "controller: {coarse: {coarse_beyond: 1000}}\n"
                  "sweep: {grid: {controller.kd: [0, 1.0e-4]}}",
                  "7:35: controller.kd | controller.coarse.kd"},
        UnfitCase{
            "{targets: [1]}",
            "sweep: {cases: {one: {controller.kd: 1.0e-4}, two: {controller.coarse.coarse_beyond: 1000}}}",
            ""},
        UnfitCase{"{targets: [1]}", "controller: {kd: 1.0e-4, coarse: {coarse_beyond: 1000000000000}}", ""},
        UnfitCase{"{targets: [1]}", "controller: {coarse: {coarse_beyond: 99}}",
                  "6:38: controller.coarse.fine_within | at most controller.coarse.coarse_beyond"},
        UnfitCase{
            "{targets: [1]}",
            "controller: {coarse: {coarse_beyond: {uniform: [50, 90]}, fine_within: {uniform: [10, 60]}}}",
            "6:72: controller.coarse.fine_within | at most controller.coarse.coarse_beyond"},
        UnfitCase{"{targets: [1]}", "controller: {coarse: {coarse_beyond: 60, fine_within: 60}}", ""}));

INSTANTIATE_TEST_SUITE_P(
    Blocks, ValueRules,
    testing::Values(UnfitCase{"{targets: [1]}", "controller: {deadband: {enter: 2, leave: 1}}",
                              "6:42: controller.deadband.leave | deadband"},
                    UnfitCase{"{targets: [1]}", "controller: {deadband: {enter: 2, leave: 2}}", ""},
                    UnfitCase{"{targets: [1]}", "controller: {observer: {bandwidth: 1000}}",
                              "6:36: controller.observer.bandwidth | half the sample rate"},
                    UnfitCase{"{targets: [1]}", "controller: {observer: {bandwidth: 999}}", ""}));

INSTANTIATE_TEST_SUITE_P(EarlyDecision, ValueRules,
                         testing::Values(UnfitCase{"{sequence: {targets: [5, 10], overrun: 3}}",
                                                   "verdict: {stop: true}", "6:17: verdict.stop | ISO 230-2"},
                                         UnfitCase{"{sequence: {targets: [5, 10], overrun: 3}}",
                                                   "sweep: {grid: {verdict.stop: [false, true]}}",
                                                   "6:38: verdict.stop | ISO 230-2"},
                                         UnfitCase{"{sequence: {targets: [5, 10], overrun: 3}}",
                                                   "verdict: {stop: false}", ""},
                                         UnfitCase{"{targets: [5, 10]}", "verdict: {stop: true}", ""}));

TEST(EarlyDecision, IsAWarningWhereACoarsePhaseMayUndoIt) {
  const auto warnings = [](const std::string& more) { return study_of(minimal_manifest(more)).warnings; };
  const std::string coarse = "controller: {coarse: {coarse_beyond: 300}}\n";
  EXPECT_TRUE(has_faults(warnings(coarse + "verdict: {stop: true}\n"), "7:17: verdict.stop | coarse phase"));
  EXPECT_TRUE(warnings(coarse + "verdict: {stop: false}\n").empty());
  EXPECT_TRUE(warnings("verdict: {stop: true}\n").empty());
  // Never both at one point.
  EXPECT_TRUE(warnings("sweep: {cases: {one: {verdict.stop: true}, two: {controller.coarse.coarse_beyond: "
                       "300}}}\n")
                  .empty());
}

INSTANTIATE_TEST_SUITE_P(
    OpenLoop, ValueRules,
    testing::Values(
        UnfitCase{"{torque: {levels: [0.1]}, hold: 1.0e-4}", "", "5:42: command.hold | less than one sample"},
        // Nothing is judged, so neither dwell nor window must fit.
        UnfitCase{"{torque: {levels: [0.1]}, hold: 0.01}", "", ""},
        // A level is reached at the rate; beyond the breakaway the rotor may well slide.
        UnfitCase{"{torque: {levels: [0.4, -0.4]}}", "", ""},
        UnfitCase{"{torque: {levels: [0.1, {normal: {mean: 0, sd: 1}}]}}", "",
                  "5:34: command.torque.levels.1 | unbounded"},
        UnfitCase{"{torque: {levels: [0.1], rate: {lognormal: {median: 1, cv: 0.1}}}}", "",
                  "5:41: command.torque.rate | a ramp takes for ever"},
        // The torque stays at 0, where it is already: however small the rate, that takes no time.
        UnfitCase{"{torque: {levels: [0, 0], rate: {lognormal: {median: 1, cv: 0.1}}}, hold: 1}", "", ""},
        UnfitCase{"{torque: {levels: [0, 0], rate: {lognormal: {median: 1, cv: 0.1}}}, hold: 1.0e+9}", "",
                  "5:84: command.hold | 1000000000000 samples"},
        UnfitCase{"{torque: {levels: [0.1]}, hold: {lognormal: {median: 1, cv: 0.1}}}", "",
                  "5:42: command.hold | less than one sample\n"
                  "5:42: command.hold | unbounded"},
        UnfitCase{"{torque: {levels: [0.1], rate: 1.0e-10}}", "",
                  "5:41: command.hold | 1000000000000 samples"}));

INSTANTIATE_TEST_SUITE_P(
    Samples, ValueRules,
    testing::Values(
        UnfitCase{"{targets: [1], hold: {truncated_normal: {mean: 1, sd: 0.1, low: 0.5, high: 1.0e+9}}}", "",
                  "5:31: command.hold | 1000000000000 samples"},
        UnfitCase{"{targets: [1]}",
                  "controller: {sample_rate: {lognormal: {median: 2000, cv: 0.1}}}\n"
                  "verdict: {dwell: 0.05, window: 0.05}",
                  "6:27: controller.sample_rate | unbounded\n"
                  "7:18: verdict.dwell | less than one sample\n"
                  "7:32: verdict.window | less than one sample"}));

// Paper's rig: 2π/1 620 000 rad a count. From 0 to 1° = 4500 counts = 0.01745 rad: with 2 rad/s and 100
// rad/s² the velocity stays below its limit, and the travel takes 2√(0.01745/100) = 0.0264222 s.
INSTANTIATE_TEST_SUITE_P(
    Travel, ValueRules,
    testing::Values(
        UnfitCase{"{targets: [4500], hold: 0.0764, profile: {shape: trapezoidal}}", "",
                  "5:34: command.hold | 0.0264222 s | at least 0.0764222 s"},
        UnfitCase{"{targets: [4500], hold: 0.0765, profile: {shape: trapezoidal}}", "", ""},
        UnfitCase{"{targets: [4500], hold: 0.06, profile: {shape: step}}", "", ""},
        // The way back is the longest: 9000 counts.
        UnfitCase{"{targets: [4500, -4500], hold: 0.08, profile: {shape: trapezoidal}}", "",
                  "5:41: command.hold | 0.0373666 s | at least 0.0873666 s"},
        UnfitCase{"{targets: [{integers: [-10, 4500]}], hold: 0.0764, profile: {shape: trapezoidal}}", "",
                  "5:53: command.hold | 0.0264222 s | at least 0.0764222 s"},
        // At 0.01 rad/s and ever higher accelerations: 1.7453 s.
        UnfitCase{"{targets: [4500], profile: {shape: s_curve, velocity_limit: {uniform: [0.01, 1]}}}",
                  "sweep: {grid: {command.profile.acceleration_limit: [1.0e6, 1.0e7], "
                  "command.profile.jerk_limit: [1.0e12]}}",
                  "6:53: command.hold | 1.74533 s | at least 1.79533 s"},
        UnfitCase{
            "{targets: [4500], profile: {shape: trapezoidal, velocity_limit: {lognormal: {median: 2, cv: "
            "0.1}}}}",
            "", "5:45: command.hold | takes for ever"},
        // From one end of the axis to the other; the overrun; and in a cycle from one side the way back.
        UnfitCase{
            "{sequence: {targets: [0, 4500], overrun: 10}, hold: 0.0764, profile: {shape: trapezoidal}}", "",
            "5:62: command.hold | 0.0264222 s | at least 0.0764222 s"},
        UnfitCase{
            "{sequence: {targets: [0, 10], overrun: 4500}, hold: 0.0764, profile: {shape: trapezoidal}}", "",
            "5:62: command.hold | 0.0264222 s | at least 0.0764222 s"},
        UnfitCase{
            "{sequence: {targets: [4510, 4520], overrun: 10, cycles: 1}, hold: 0.0764, profile: {shape: "
            "trapezoidal}}",
            "", "5:76: command.hold | 0.0264222 s | at least 0.0764222 s"},
        UnfitCase{"{sequence: {targets: [0, 2240, 4490], overrun: 10, approach: positive}, hold: 0.0764, "
                  "profile: {shape: trapezoidal}}",
                  "", "5:88: command.hold | 0.0264222 s | at least 0.0764222 s"},
        UnfitCase{"{sequence: {targets: [0, 2240, 4490], overrun: 10, approach: positive, cycles: 1}, hold: "
                  "0.0764, profile: {shape: trapezoidal}}",
                  "", ""},
        UnfitCase{"{sequence: {targets: [-4490, -2240, 0], overrun: 10, approach: negative}, hold: 0.0764, "
                  "profile: {shape: trapezoidal}}",
                  "", "5:90: command.hold | 0.0264222 s | at least 0.0764222 s"}));

TEST(FittingValues, ATorqueBeyondTheConverterIsClippedAndSaysSo) {
  const auto warnings = [](const std::string& torque, const std::string& more = "") {
    return study_of(manifest_commanding("{torque: " + torque + "}", more)).warnings;
  };
  using Warnings = std::vector<std::string>;
  // 12 bits at 2.4e-4 N m: −2048 … 2047 codes.
  EXPECT_TRUE(
      has_faults(warnings("{levels: [0.49, 0.4913, -0.4915]}"), "5:35: command.torque.levels.1 | converter"));
  EXPECT_EQ(warnings("{levels: [{uniform: [-0.5, 0]}]}").size(), 1u);
  EXPECT_EQ(warnings("{levels: [0.49, 0.5], through: exact}"), Warnings{});
  EXPECT_TRUE(has_faults(warnings("{levels: [0.49]}", "sweep: {grid: {dac.bits: [12, 11]}}\n"),
                         "6:31: command.torque.levels.0 | converter"));
}

TEST(FittingValues, TheSamplesOfASequenceAreThoseOfAllItsMoves) {
  EXPECT_TRUE(
      has_faults(refusal_of(manifest_commanding("{sequence: {targets: [1, 2], overrun: 1, cycles: 10000}}",
                                                "controller: {sample_rate: 2.0e7}")),
                 "6:27: command.hold | 1000000000000 samples"));
}

}  // namespace
}  // namespace zerocount::rules
