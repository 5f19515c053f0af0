// Values that do not fit one another are refused, wherever they can meet.

#include <ostream>

#include <gtest/gtest.h>

#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::rules {
namespace {

struct UnfitCase {
  const char* command;
  const char* more;     // from the sixth line on
  const char* message;  // the whole message; empty: understood
};

void PrintTo(const UnfitCase& tested, std::ostream* out) {
  *out << tested.command << " " << tested.more;
}

class ValueRules : public testing::TestWithParam<UnfitCase> {};

TEST_P(ValueRules, AreChecked) {
  EXPECT_EQ(refusal_of(manifest_commanding(GetParam().command, GetParam().more)), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Start, ValueRules,
    testing::Values(
        UnfitCase{"{targets: [1]}", "initial: {history: {reversals: 3, torque: 0.3}}",
                  "m.yaml:6:43: initial.history.torque: a history of 0.3 N m can reach the breakaway of 0.3 "
                  "N m; expected initial.history.torque below friction.breakaway"},
        UnfitCase{"{targets: [1]}",
                  "initial: {history: {reversals: 3, torque: {uniform: [0, 0.35]}}}\n"
                  "friction: {breakaway: {uniform: [0.3, 0.4]}}",
                  "m.yaml:6:43: initial.history.torque: a history of 0.35 N m can reach the breakaway of 0.3 "
                  "N m; expected initial.history.torque below friction.breakaway"},
        UnfitCase{"{targets: [1]}",
                  "initial: {history: {reversals: 3, torque: 0.25}}\n"
                  "sweep: {grid: {friction.breakaway: [0.3, 0.2]}}",
                  "m.yaml:7:42: initial.history.torque: a history of 0.25 N m can reach the breakaway of 0.2 "
                  "N m; expected initial.history.torque below friction.breakaway"},
        UnfitCase{"{targets: [1]}", "initial: {history: {reversals: 3, torque: 0.29}}", ""},
        UnfitCase{"{targets: [1]}", "initial: {mode: slide}",
                  "m.yaml:6:17: initial.velocity: the velocity can be 0 where the hook slides at the start; "
                  "expected a velocity that is never 0 with initial.mode: slide"},
        UnfitCase{"{targets: [1]}", "initial: {mode: slide, velocity: {uniform: [-1, 1]}}",
                  "m.yaml:6:34: initial.velocity: the velocity can be 0 where the hook slides at the start; "
                  "expected a velocity that is never 0 with initial.mode: slide"},
        UnfitCase{"{targets: [1]}", "initial: {mode: slide, velocity: {choice: [-1, 1]}}", ""},
        UnfitCase{"{targets: [1]}", "initial: {mode: slide, velocity: {uniform: [0.1, 1]}}", ""},
        UnfitCase{"{targets: [1]}", "initial: {velocity: {uniform: [-1, 1]}}", ""},
        UnfitCase{"{targets: [1]}",
                  "initial: {velocity: 0.1}\n"
                  "sweep: {cases: {a: {}, b: {initial.mode: slide, initial.velocity: 0}}}",
                  "m.yaml:7:67: initial.velocity: the velocity can be 0 where the hook slides at the start; "
                  "expected a velocity that is never 0 with initial.mode: slide"}));

INSTANTIATE_TEST_SUITE_P(
    TwoPhases, ValueRules,
    testing::Values(
        UnfitCase{"{targets: [1]}", "controller: {kd: 1.0e-4, coarse: {coarse_beyond: 1000}}",
                  "m.yaml:6:18: controller.kd: 0.0001 N m/count can act in the fine phase of a control with "
                  "two; expected 0 where there is a coarse phase: the derivative belongs to it alone "
                  "(controller.coarse.kd)"},
        UnfitCase{"{targets: [1]}",
                  "controller: {coarse: {coarse_beyond: 1000}}\n"
                  "sweep: {grid: {controller.kd: [0, 1.0e-4]}}",
                  "m.yaml:7:35: controller.kd: 0.0001 N m/count can act in the fine phase of a control with "
                  "two; expected 0 where there is a coarse phase: the derivative belongs to it alone "
                  "(controller.coarse.kd)"},
        UnfitCase{
            "{targets: [1]}",
            "sweep: {cases: {one: {controller.kd: 1.0e-4}, two: {controller.coarse.coarse_beyond: 1000}}}",
            ""},
        UnfitCase{"{targets: [1]}", "controller: {kd: 1.0e-4, coarse: {coarse_beyond: 1000000000000}}", ""},
        UnfitCase{
            "{targets: [1]}", "controller: {coarse: {coarse_beyond: 99}}",
            "m.yaml:6:38: controller.coarse.fine_within: the fine phase can be entered at 100 counts and "
            "left beyond 99; expected at most controller.coarse.coarse_beyond"},
        UnfitCase{
            "{targets: [1]}",
            "controller: {coarse: {coarse_beyond: {uniform: [50, 90]}, fine_within: {uniform: [10, 60]}}}",
            "m.yaml:6:72: controller.coarse.fine_within: the fine phase can be entered at 60 counts and "
            "left beyond 50; expected at most controller.coarse.coarse_beyond"},
        UnfitCase{"{targets: [1]}", "controller: {coarse: {coarse_beyond: 60, fine_within: 60}}", ""}));

INSTANTIATE_TEST_SUITE_P(
    Blocks, ValueRules,
    testing::Values(
        UnfitCase{
            "{targets: [1]}", "controller: {deadband: {enter: 2, leave: 1}}",
            "m.yaml:6:42: controller.deadband.leave: the deadband can be left at 1 counts and entered at "
            "2; expected at least the |error| with which it is entered"},
        UnfitCase{"{targets: [1]}", "controller: {deadband: {enter: 2, leave: 2}}", ""},
        UnfitCase{"{targets: [1]}", "controller: {observer: {bandwidth: 1000}}",
                  "m.yaml:6:36: controller.observer.bandwidth: 1000 Hz can be half the sample rate, 2000 Hz, "
                  "or more; expected a bandwidth below half of controller.sample_rate"},
        UnfitCase{"{targets: [1]}", "controller: {observer: {bandwidth: 999}}", ""}));

INSTANTIATE_TEST_SUITE_P(
    EarlyDecision, ValueRules,
    testing::Values(
        UnfitCase{"{sequence: {targets: [5, 10], overrun: 3}}", "verdict: {stop: true}",
                  "m.yaml:6:17: verdict.stop: the values of ISO 230-2 are of the ends of all moves, which a "
                  "trial that is ended early does not have; expected false with command.sequence"},
        UnfitCase{"{sequence: {targets: [5, 10], overrun: 3}}",
                  "sweep: {grid: {verdict.stop: [false, true]}}",
                  "m.yaml:6:38: verdict.stop: the values of ISO 230-2 are of the ends of all moves, which a "
                  "trial that is ended early does not have; expected false with command.sequence"},
        UnfitCase{"{sequence: {targets: [5, 10], overrun: 3}}", "verdict: {stop: false}", ""},
        UnfitCase{"{targets: [5, 10]}", "verdict: {stop: true}", ""}));

TEST(EarlyDecision, IsAWarningWhereACoarsePhaseMayUndoIt) {
  const auto warnings = [](const std::string& more) { return study_of(minimal_manifest(more)).warnings; };
  const std::string coarse = "controller: {coarse: {coarse_beyond: 300}}\n";
  EXPECT_EQ(warnings(coarse + "verdict: {stop: true}\n"),
            (std::vector<std::string>{
                "m.yaml:7:17: verdict.stop: the coarse phase may bring a rotor back from beyond "
                "verdict.limit, and so change an outcome that was taken as decided"}));
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
        UnfitCase{"{torque: {levels: [0.1]}, hold: 1.0e-4}", "",
                  "m.yaml:5:42: command.hold: 0.0001 s can be less than one sample at 2000 Hz; expected at "
                  "least one sample"},
        // Nothing is judged, so neither dwell nor window must fit.
        UnfitCase{"{torque: {levels: [0.1]}, hold: 0.01}", "", ""},
        // A level is reached at the rate; beyond the breakaway the rotor may well slide.
        UnfitCase{"{torque: {levels: [0.4, -0.4]}}", "", ""},
        UnfitCase{
            "{torque: {levels: [0.1, {normal: {mean: 0, sd: 1}}]}}", "",
            "m.yaml:5:34: command.torque.levels.1: its values have no limit, so that the torque can take for "
            "ever to the level; expected a distribution of the level with a lowest and a highest value"},
        UnfitCase{"{torque: {levels: [0.1], rate: {lognormal: {median: 1, cv: 0.1}}}}", "",
                  "m.yaml:5:41: command.torque.rate: the rate can be so small that the torque takes for ever "
                  "to a level; expected a rate with a lowest value above 0"},
        // The torque stays at 0, where it is already: however small the rate, that takes no time.
        UnfitCase{"{torque: {levels: [0, 0], rate: {lognormal: {median: 1, cv: 0.1}}}, hold: 1}", "", ""},
        UnfitCase{
            "{torque: {levels: [0, 0], rate: {lognormal: {median: 1, cv: 0.1}}}, hold: 1.0e+9}", "",
            "m.yaml:5:84: command.hold: 2 levels held for 1000000000 s, and 0 s on the way to them, can "
            "be more than 1000000000000 samples at 2000 Hz; expected at most 1000000000000 samples in a "
            "trial"},
        UnfitCase{"{torque: {levels: [0.1]}, hold: {lognormal: {median: 1, cv: 0.1}}}", "",
                  "m.yaml:5:42: command.hold: 0 s can be less than one sample at 2000 Hz; expected at least "
                  "one sample\n"
                  "m.yaml:5:42: command.hold: its values have no upper limit, so that a trial can have any "
                  "number of samples; expected a distribution of the hold with a highest value"},
        UnfitCase{
            "{torque: {levels: [0.1], rate: 1.0e-10}}", "",
            "m.yaml:5:41: command.hold: 1 levels held for 1 s, and 1000000000 s on the way to them, can "
            "be more than 1000000000000 samples at 2000 Hz; expected at most 1000000000000 samples in a "
            "trial"}));

INSTANTIATE_TEST_SUITE_P(
    Samples, ValueRules,
    testing::Values(
        UnfitCase{"{targets: [1], hold: {truncated_normal: {mean: 1, sd: 0.1, low: 0.5, high: 1.0e+9}}}", "",
                  "m.yaml:5:31: command.hold: 1 moves of 1000000000 s at 2000 Hz can be more than "
                  "1000000000000 samples; expected at most 1000000000000 samples in a trial"},
        UnfitCase{"{targets: [1]}",
                  "controller: {sample_rate: {lognormal: {median: 2000, cv: 0.1}}}\n"
                  "verdict: {dwell: 0.05, window: 0.05}",
                  "m.yaml:6:27: controller.sample_rate: its values have no upper limit, so that a trial can "
                  "have any number of samples; expected a distribution of the sample rate with a highest "
                  "value\n"
                  "m.yaml:7:18: verdict.dwell: 0.05 s can be less than one sample at 0 Hz; expected at least "
                  "one sample\n"
                  "m.yaml:7:32: verdict.window: 0.05 s can be less than one sample at 0 Hz; expected at "
                  "least one sample"}));

// Paper's rig: 2π/1 620 000 rad a count. From 0 to 1° = 4500 counts = 0.01745 rad: with 2 rad/s and 100
// rad/s² the velocity stays below its limit, and the travel takes 2√(0.01745/100) = 0.0264222 s.
INSTANTIATE_TEST_SUITE_P(
    Travel, ValueRules,
    testing::Values(
        UnfitCase{"{targets: [4500], hold: 0.0764, profile: {shape: trapezoidal}}", "",
                  "m.yaml:5:34: command.hold: a travel of 4500 counts can take 0.0264222 s, which leaves no "
                  "window of 0.05 s in the hold of 0.0764 s; expected command.hold at least 0.0764222 s, or "
                  "higher limits of the profile"},
        UnfitCase{"{targets: [4500], hold: 0.0765, profile: {shape: trapezoidal}}", "", ""},
        UnfitCase{"{targets: [4500], hold: 0.06, profile: {shape: step}}", "", ""},
        // The way back is the longest: 9000 counts.
        UnfitCase{"{targets: [4500, -4500], hold: 0.08, profile: {shape: trapezoidal}}", "",
                  "m.yaml:5:41: command.hold: a travel of 9000 counts can take 0.0373666 s, which leaves no "
                  "window of 0.05 s in the hold of 0.08 s; expected command.hold at least 0.0873666 s, or "
                  "higher limits of the profile"},
        UnfitCase{"{targets: [{integers: [-10, 4500]}], hold: 0.0764, profile: {shape: trapezoidal}}", "",
                  "m.yaml:5:53: command.hold: a travel of 4500 counts can take 0.0264222 s, which leaves no "
                  "window of 0.05 s in the hold of 0.0764 s; expected command.hold at least 0.0764222 s, or "
                  "higher limits of the profile"},
        // At 0.01 rad/s and ever higher accelerations: 1.7453 s.
        UnfitCase{"{targets: [4500], profile: {shape: s_curve, velocity_limit: {uniform: [0.01, 1]}}}",
                  "sweep: {grid: {command.profile.acceleration_limit: [1.0e6, 1.0e7], "
                  "command.profile.jerk_limit: [1.0e12]}}",
                  "m.yaml:6:53: command.hold: a travel of 4500 counts can take 1.74533 s, which leaves no "
                  "window of 0.05 s in the hold of 1 s; expected command.hold at least 1.79533 s, or higher "
                  "limits of the profile"},
        UnfitCase{
            "{targets: [4500], profile: {shape: trapezoidal, velocity_limit: {lognormal: {median: 2, cv: "
            "0.1}}}}",
            "",
            "m.yaml:5:45: command.hold: a limit of the profile can be so small that the travel takes "
            "for ever; expected limits of the profile with a lowest value above 0"},
        // From one end of the axis to the other; the overrun; and in a cycle from one side the way back.
        UnfitCase{
            "{sequence: {targets: [0, 4500], overrun: 10}, hold: 0.0764, profile: {shape: trapezoidal}}", "",
            "m.yaml:5:62: command.hold: a travel of 4500 counts can take 0.0264222 s, which leaves no "
            "window of 0.05 s in the hold of 0.0764 s; expected command.hold at least 0.0764222 s, or "
            "higher limits of the profile"},
        UnfitCase{
            "{sequence: {targets: [0, 10], overrun: 4500}, hold: 0.0764, profile: {shape: trapezoidal}}", "",
            "m.yaml:5:62: command.hold: a travel of 4500 counts can take 0.0264222 s, which leaves no "
            "window of 0.05 s in the hold of 0.0764 s; expected command.hold at least 0.0764222 s, or "
            "higher limits of the profile"},
        UnfitCase{
            "{sequence: {targets: [4510, 4520], overrun: 10, cycles: 1}, hold: 0.0764, profile: {shape: "
            "trapezoidal}}",
            "",
            "m.yaml:5:76: command.hold: a travel of 4500 counts can take 0.0264222 s, which leaves no "
            "window of 0.05 s in the hold of 0.0764 s; expected command.hold at least 0.0764222 s, or "
            "higher limits of the profile"},
        UnfitCase{"{sequence: {targets: [0, 2240, 4490], overrun: 10, approach: positive}, hold: 0.0764, "
                  "profile: {shape: trapezoidal}}",
                  "",
                  "m.yaml:5:88: command.hold: a travel of 4500 counts can take 0.0264222 s, which leaves no "
                  "window of 0.05 s in the hold of 0.0764 s; expected command.hold at least 0.0764222 s, or "
                  "higher limits of the profile"},
        UnfitCase{"{sequence: {targets: [0, 2240, 4490], overrun: 10, approach: positive, cycles: 1}, hold: "
                  "0.0764, profile: {shape: trapezoidal}}",
                  "", ""},
        UnfitCase{"{sequence: {targets: [-4490, -2240, 0], overrun: 10, approach: negative}, hold: 0.0764, "
                  "profile: {shape: trapezoidal}}",
                  "",
                  "m.yaml:5:90: command.hold: a travel of 4500 counts can take 0.0264222 s, which leaves no "
                  "window of 0.05 s in the hold of 0.0764 s; expected command.hold at least 0.0764222 s, or "
                  "higher limits of the profile"}));

TEST(FittingValues, ATorqueBeyondTheConverterIsClippedAndSaysSo) {
  const auto warnings = [](const std::string& torque, const std::string& more = "") {
    return study_of(manifest_commanding("{torque: " + torque + "}", more)).warnings;
  };
  using Warnings = std::vector<std::string>;
  // 12 bits at 2.4e-4 N m: −2048 … 2047 codes.
  EXPECT_EQ(warnings("{levels: [0.49, 0.4913, -0.4915]}"),
            (Warnings{"m.yaml:5:35: command.torque.levels.1: 0.4913 N m can be beyond the converter's range "
                      "from -0.49152 to 0.49128 N m, and is clipped to it"}));
  EXPECT_EQ(warnings("{levels: [{uniform: [-0.5, 0]}]}").size(), 1u);
  EXPECT_EQ(warnings("{levels: [0.49, 0.5], through: exact}"), Warnings{});
  EXPECT_EQ(warnings("{levels: [0.49]}", "sweep: {grid: {dac.bits: [12, 11]}}\n"),
            (Warnings{"m.yaml:6:31: command.torque.levels.0: 0.49 N m can be beyond the converter's range "
                      "from -0.24576 to 0.24552 N m, and is clipped to it"}));
}

TEST(FittingValues, TheSamplesOfASequenceAreThoseOfAllItsMoves) {
  EXPECT_EQ(refusal_of(manifest_commanding("{sequence: {targets: [1, 2], overrun: 1, cycles: 10000}}",
                                           "controller: {sample_rate: 2.0e7}")),
            "m.yaml:6:27: command.hold: 60000 moves of 1 s at 20000000 Hz can be more than 1000000000000 "
            "samples; expected at most 1000000000000 samples in a trial");
}

}  // namespace
}  // namespace zerocount::rules
