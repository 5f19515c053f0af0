#include <chrono>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::manifest {
namespace {

std::string failure_of(const std::string& text) {
  try {
    study_of(text);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_input);
    return failure.what();
  }
  return "";
}

struct Case {
  const char* line;     // the sixth line of an otherwise good manifest
  const char* message;  // the whole message
};

// The line names the test.
void PrintTo(const Case& tested, std::ostream* out) {
  *out << tested.line;
}

class SixthLine : public testing::TestWithParam<Case> {};

TEST_P(SixthLine, IsReported) {
  EXPECT_EQ(failure_of(minimal_manifest(GetParam().line)), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    UnknownKeys, SixthLine,
    testing::Values(
        Case{"plant: {inertai: 1}",
             "m.yaml:6:9: plant.inertai: unknown key, nearest known: inertia; expected one of inertia, "
             "presliding_damping, sliding_damping, load"},
        Case{"friction: {kp: 1}",
             "m.yaml:6:12: friction.kp: unknown key, nearest known: controller.kp; expected one of model, "
             "k1, k2, "
             "beta, "
             "alpha, lambda, n, breakaway, coulomb_ratio, stribeck_velocity, sigma0, sigma1, gms"},
        Case{"frictoin: {k1: 1}",
             "m.yaml:6:1: frictoin: unknown key, nearest known: friction; expected one of zerocount, name, "
             "description, axis, travel, seed, trials, rigs, design, independent_points, retain, keep, stop, "
             "correlation, samples, observed, sweep, "
             "plant, "
             "friction, "
             "encoder, dac, amplifier, controller, command, initial, verdict"},
        Case{"friction: {k1: {unifrom: [1, 2]}}",
             "m.yaml:6:17: friction.k1.unifrom: unknown distribution, nearest known: uniform; expected a map "
             "with one "
             "of uniform, log_uniform, normal, truncated_normal, lognormal, triangular, integers, choice, "
             "profile; per may stand beside it"},
        Case{"friction: {k1: {lognormal: {median: 1, cv: 1, mean: 1}}}",
             "m.yaml:6:47: friction.k1.lognormal.mean: unknown key, nearest known: median; expected one of "
             "median, cv"},
        Case{"retain: {trails: [1]}",
             "m.yaml:6:10: retain.trails: unknown key, nearest known: trials; expected one of trials"},
        Case{"sweep: {gird: {}}",
             "m.yaml:6:9: sweep.gird: unknown key, nearest known: grid; expected one of grid, cases"},
        Case{"observed: {all: {successes: 3, of: 2}}",
             "m.yaml:6:29: observed.all.successes: '3' is out of range; expected a whole number from 0 to "
             "2"},
        Case{"observed: {all: {successes: 3}}",
             "m.yaml:6:17: observed.all: the key 'of' is missing; expected a text, or counts: {successes: 9, "
             "of: 10}"},
        Case{"observed: {b: text}",
             "m.yaml:6:12: observed.b: no case or point has this label, nearest known: all; expected the "
             "name of a case "
             "or the label of a point"}));

INSTANTIATE_TEST_SUITE_P(
    WrongTypes, SixthLine,
    testing::Values(
        Case{"plant: 3", "m.yaml:6:8: plant: the single value '3' stands here; expected a map"},
        Case{"plant: {inertia: heavy}",
             "m.yaml:6:18: plant.inertia: 'heavy' is not a number; expected a number greater than 0"},
        Case{"plant: {inertia: \"1\"}",
             "m.yaml:6:18: plant.inertia: '1' is a quoted text; expected a number greater than 0"},
        Case{"plant: {inertia: [1]}",
             "m.yaml:6:18: plant.inertia: a list stands here; expected a number greater than 0"},
        Case{"plant: {inertia: }",
             "m.yaml:6:18: plant.inertia: the value is empty; expected a number greater than 0"},
        Case{"plant: {inertia: ~}",
             "m.yaml:6:18: plant.inertia: the value is empty; expected a number greater than 0"},
        Case{"dac: {bits: 12.5}",
             "m.yaml:6:13: dac.bits: '12.5' is not written as a whole number; expected a whole number from 1 "
             "to 32"},
        Case{"dac: {bits: 1.2e1}",
             "m.yaml:6:13: dac.bits: '1.2e1' is not written as a whole number; expected a whole number from "
             "1 to 32"},
        Case{
            "controller: {anti_windup: klamp}",
            "m.yaml:6:27: controller.anti_windup: 'klamp' is none of its words; expected one of clamp, none"},
        Case{"design: random",
             "m.yaml:6:9: design: 'random' is none of its words; expected one of monte_carlo, "
             "latin_hypercube, "
             "sobol, saltelli"},
        Case{"design: ~",
             "m.yaml:6:9: design: the value is empty; expected one of monte_carlo, latin_hypercube, sobol, "
             "saltelli"},
        Case{"independent_points: 1",
             "m.yaml:6:21: independent_points: '1' is not a truth value; expected true or false"},
        Case{"independent_points: \"true\"",
             "m.yaml:6:21: independent_points: 'true' is a quoted text; expected true or false"},
        Case{"verdict: {stop: 1}",
             "m.yaml:6:17: verdict.stop: '1' is not a truth value; expected true or false"},
        Case{"verdict: {stop: yes}",
             "m.yaml:6:17: verdict.stop: 'yes' is a truth value only in some versions of YAML; expected true "
             "or false"},
        Case{"verdict: {stop: 'true'}",
             "m.yaml:6:17: verdict.stop: 'true' is a quoted text; expected true or false"},
        Case{"verdict: {stop: {choice: [0, 1]}}",
             "m.yaml:6:17: verdict.stop: a map stands here; expected true or false"},
        Case{"verdict: {stop: true, limit: 1}",
             "m.yaml:6:30: verdict.limit: '1' is out of range; expected a number greater than 1"},
        Case{"description: 12",
             "m.yaml:6:14: description: '12' reads as a number or a truth value; expected a text, in "
             "quotation marks "
             "where it could be taken for something else"},
        Case{"description: [a]", "m.yaml:6:14: description: a list stands here; expected a text"},
        Case{"retain: {trials: 1}",
             "m.yaml:6:18: retain.trials: the single value '1' stands here; expected a list of trial "
             "indices"}));

INSTANTIATE_TEST_SUITE_P(
    YamlTraps, SixthLine,
    testing::Values(
        Case{"independent_points: yes",
             "m.yaml:6:21: independent_points: 'yes' is a truth value only in some versions of YAML; "
             "expected true or "
             "false"},
        Case{"controller: {kp: no}",
             "m.yaml:6:18: controller.kp: 'no' is a truth value; expected a number at least 0 and at most "
             "1000000"},
        Case{"controller: {kp: 010}",
             "m.yaml:6:18: controller.kp: '010' starts with a zero, which some read as octal; expected a "
             "number at least "
             "0 and at most 1000000"},
        Case{"dac: {bits: 010}",
             "m.yaml:6:13: dac.bits: '010' starts with a zero, which some read as octal; expected a whole "
             "number from 1 "
             "to 32"},
        Case{"controller: {kp: 0x10}",
             "m.yaml:6:18: controller.kp: '0x10' is not decimal; expected a number at least 0 and at most "
             "1000000"},
        Case{"controller: {kp: 1_000}",
             "m.yaml:6:18: controller.kp: '1_000' has underscores in it; expected a number at least 0 and at "
             "most 1000000"},
        Case{"controller: {kp: 1:30}",
             "m.yaml:6:18: controller.kp: '1:30' has a colon in it, which some read to base 60; expected a "
             "number at "
             "least 0 and at most 1000000"},
        Case{"controller: {kp: +1}",
             "m.yaml:6:18: controller.kp: '+1' starts with a plus sign; expected a number at least 0 and at "
             "most 1000000"},
        Case{"controller: {kp: .inf}",
             "m.yaml:6:18: controller.kp: '.inf' is not finite; expected a number at least 0 and at most "
             "1000000"},
        Case{"controller: {kp: nan}",
             "m.yaml:6:18: controller.kp: 'nan' is not finite; expected a number at least 0 and at most "
             "1000000"},
        Case{"initial: {position: -.INF}",
             "m.yaml:6:21: initial.position: '-.INF' is not finite; expected any finite number"},
        Case{"controller: {kp: 1e999}",
             "m.yaml:6:18: controller.kp: '1e999' is too large or too small for a double; expected a number "
             "at least 0 and at most 1000000"},
        Case{"dac: {bits: 99999999999999999999}",
             "m.yaml:6:13: dac.bits: '99999999999999999999' is out of range; expected a whole number from 1 "
             "to 32"}));

INSTANTIATE_TEST_SUITE_P(
    OutOfRange, SixthLine,
    testing::Values(
        Case{"plant: {inertia: 0}",
             "m.yaml:6:18: plant.inertia: '0' is out of range; expected a number greater than 0"},
        Case{"plant: {presliding_damping: -1}",
             "m.yaml:6:29: plant.presliding_damping: '-1' is out of range; expected a number at least 0"},
        Case{"friction: {n: 0.99}",
             "m.yaml:6:15: friction.n: '0.99' is out of range; expected a number at least 1"},
        Case{"friction: {coulomb_ratio: 1.01}",
             "m.yaml:6:27: friction.coulomb_ratio: '1.01' is out of range; expected a number greater than 0 "
             "and at most "
             "1"},
        Case{"initial: {encoder_phase: 1}",
             "m.yaml:6:26: initial.encoder_phase: '1' is out of range; expected a number at least 0 and less "
             "than 1"},
        Case{"dac: {bits: 33}",
             "m.yaml:6:13: dac.bits: '33' is out of range; expected a whole number from 1 to 32"},
        Case{"controller: {delay: -1}",
             "m.yaml:6:21: controller.delay: '-1' is out of range; expected a whole number from 0 to 100"},
        Case{"encoder: {fine: 0}",
             "m.yaml:6:17: encoder.fine: '0' is out of range; expected a whole number from 1 to "
             "1000000000000"},
        Case{"retain: {trials: [10]}",
             "m.yaml:6:19: retain.trials.0: '10' is out of range; expected a whole number from 0 to 9"},
        Case{"retain: {trials: [1, 1]}",
             "m.yaml:6:18: retain.trials: a trial stands twice in the list; expected each trial once"},
        Case{"rigs: 1",
             "m.yaml:6:7: rigs: '1' is out of range; expected a whole number from 2 to 4294967296"},
        Case{
            "rigs: 4",
            "m.yaml:4:9: trials: 10 trials cannot be divided equally among 4 rigs; expected a multiple of 4, "
            "such as 8 or 12"},
        Case{"friction: {k1: {uniform: [1, 2], per: rig}}",
             "m.yaml:6:39: friction.k1.per: the study has no rigs; expected the key rigs, or study, trial or "
             "contact here"},
        Case{"friction: {k1: {uniform: [1, 2], per: move}}",
             "m.yaml:6:39: friction.k1.per: 'move' is none of its words; expected one of study, rig, trial, "
             "contact"},
        Case{"friction: {k1: {per: trial}}",
             "m.yaml:6:16: friction.k1: a map with 1 keys stands here; expected a map with one of uniform, "
             "log_uniform, normal, truncated_normal, lognormal, triangular, integers, choice, profile; per "
             "may stand beside it"},
        Case{"plant: {inertia: {uniform: [1, 2], per: contact}}",
             "m.yaml:6:41: plant.inertia.per: only friction is drawn anew at each contact; expected study, "
             "rig or trial"},
        Case{"friction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: 1}, per: trial}}",
             "m.yaml:6:76: friction.k1.per: a profile is that of a rotor, which no trial has for itself; "
             "expected study or rig (a rotor for every trial: rigs, as many as trials)"},
        Case{
            "friction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: 1}, per: contact}}",
            "m.yaml:6:76: friction.k1.per: a profile is that of a rotor, and a contact takes its value where "
            "it forms; expected study or rig"},
        Case{"friction: {k1: {profile: {mean: {uniform: [1, 2], per: rig}, cv: 0.1, correlation_length: 1}}}",
             "m.yaml:6:33: friction.k1.profile.mean: the mean is drawn for every rotor, as often as the "
             "profile; expected per beside profile"},
        Case{"friction: {k1: {profile: {mean: {normal: {mean: 1, sd: 1}}, cv: 0.1, correlation_length: 1}}}",
             "m.yaml:6:33: friction.k1.profile.mean: its values (-inf, inf) are not all positive and finite; "
             "expected a distribution of numbers greater than 0"},
        Case{"rigs: 20",
             "m.yaml:4:9: trials: 10 trials cannot be divided equally among 20 rigs; expected a multiple of "
             "20, such as 20"}));

INSTANTIATE_TEST_SUITE_P(
    Distributions, SixthLine,
    testing::Values(
        Case{"friction: {k1: {normal: {mean: 110, sd: 1}}}",
             "m.yaml:6:25: friction.k1.normal: its values (-inf, inf) leave the range allowed (0, inf); "
             "expected numbers "
             "greater than 0 only"},
        Case{"friction: {k1: {uniform: [0, 1]}}",
             "m.yaml:6:26: friction.k1.uniform: its values [0, 1) leave the range allowed (0, inf); expected "
             "numbers "
             "greater than 0 only"},
        Case{"friction: {coulomb_ratio: {lognormal: {median: 0.5, cv: 0.1}}}",
             "m.yaml:6:39: friction.coulomb_ratio.lognormal: its values (0, inf) leave the range allowed (0, "
             "1]; expected "
             "numbers greater than 0 and at most 1 only"},
        Case{"friction: {k1: {profile: {mean: 110, cv: 0.6, correlation_length: 0.2, marginal: normal}}}",
             "m.yaml:6:26: friction.k1.profile: its values along the rotor, -36.5976 to 299.45 with this "
             "seed, leave "
             "the range allowed (0, inf); expected numbers greater than 0 only"},
        Case{"friction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: 7}}}",
             "m.yaml:6:67: friction.k1.profile.correlation_length: '7' is out of range; expected a number at "
             "least 0.001 "
             "and at most 6.283185307179586"},
        Case{"friction: {k1: {profile: {mean: 110, cv: 0.1}}}",
             "m.yaml:6:26: friction.k1.profile: correlation_length is missing; expected profile: {mean, cv, "
             "correlation_length, marginal}"},
        Case{"friction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: 1, marginal: gauss}}}",
             "m.yaml:6:80: friction.k1.profile.marginal: 'gauss' is no marginal; expected normal or "
             "lognormal"},
        Case{"plant: {inertia: {profile: {mean: 1, cv: 0.1, correlation_length: 1}}}",
             "m.yaml:6:28: plant.inertia.profile: this parameter does not vary along the rotor; expected a "
             "number or a "
             "distribution other than profile"},
        Case{"friction: {k1: {uniform: [2, 1]}}",
             "m.yaml:6:26: friction.k1.uniform: low 2 is not below high 1; expected low < high (for a "
             "constant, the number "
             "itself)"},
        Case{"friction: {k1: {uniform: [1, 2, 3]}}",
             "m.yaml:6:26: friction.k1.uniform: a list of 3 stands here; expected uniform: [low, high]"},
        Case{"friction: {k1: {uniform: {low: 1}}}",
             "m.yaml:6:26: friction.k1.uniform: a map stands here; expected uniform: [low, high]"},
        Case{"friction: {k1: {uniform: [1, no]}}",
             "m.yaml:6:30: friction.k1.uniform.1: 'no' is a truth value; expected any finite number"},
        Case{"friction: {k1: {log_uniform: [0, 2]}}",
             "m.yaml:6:30: friction.k1.log_uniform: low is 0; expected low greater than 0"},
        Case{"initial: {position: {normal: {mean: 0, sd: -1}}}",
             "m.yaml:6:30: initial.position.normal: sd is -1; expected sd greater than 0"},
        Case{"initial: {position: {normal: {mean: 0}}}",
             "m.yaml:6:30: initial.position.normal: sd is missing; expected normal: {mean, sd}"},
        Case{"initial: {position: {normal: [0, 1]}}",
             "m.yaml:6:30: initial.position.normal: a list stands here; expected normal: {mean, sd}"},
        Case{"friction: {k1: {lognormal: {median: 1, cv: 11}}}",
             "m.yaml:6:28: friction.k1.lognormal: cv is 11; expected cv at most 10"},
        Case{"friction: {k1: {lognormal: {median: 1.0e308, cv: 1}}}",
             "m.yaml:6:28: friction.k1.lognormal: its extreme values are too large or too small for a "
             "double; expected "
             "numbers greater than 0 only"},
        Case{"friction: {k1: {triangular: [1, 5, 3]}}",
             "m.yaml:6:29: friction.k1.triangular: the mode 5 is outside of 1 to 3; expected low <= mode <= "
             "high"},
        Case{"friction: {k1: {truncated_normal: {mean: 0, sd: 1, low: 20, high: 30}}}",
             "m.yaml:6:35: friction.k1.truncated_normal: only the proportion 2.75e-89 of the normal "
             "distribution "
             "lies between "
             "low and high; expected at least 1e-12"},
        Case{"friction: {k1: {choice: []}}",
             "m.yaml:6:25: friction.k1.choice: there is nothing to choose from; expected a list of at least "
             "one number"},
        Case{"friction: {k1: {choice: [1, -1]}}",
             "m.yaml:6:25: friction.k1.choice: its values [-1, 1] leave the range allowed (0, inf); expected "
             "numbers "
             "greater than 0 only"},
        Case{"friction: {k1: {uniform: [1, 2], choice: [1]}}",
             "m.yaml:6:16: friction.k1: a map with 2 keys stands here; expected a map with one of uniform, "
             "log_uniform, "
             "normal, truncated_normal, lognormal, triangular, integers, choice, profile; per may stand "
             "beside it"},
        Case{"dac: {bits: {uniform: [8, 16]}}",
             "m.yaml:6:23: dac.bits.uniform: its values are not whole numbers; expected integers, or a "
             "choice of whole "
             "numbers"},
        Case{"dac: {bits: {integers: [8, 16.5]}}",
             "m.yaml:6:28: dac.bits.integers.1: '16.5' is not written as a whole number; expected a whole "
             "number from "
             "-9007199254740992 to 9007199254740992"},
        Case{"dac: {bits: {integers: [16, 8]}}",
             "m.yaml:6:24: dac.bits.integers: low 16 is above high 8; expected low <= high"},
        Case{"controller: {anti_windup: {choice: [0, 1]}}",
             "m.yaml:6:27: controller.anti_windup: '{choice: [0, 1]}' is none of its words; expected one of "
             "clamp, "
             "none"}));

INSTANTIATE_TEST_SUITE_P(
    BetweenParameters, SixthLine,
    testing::Values(
        Case{"verdict: {dwell: 2}",
             "m.yaml:6:18: verdict.dwell: 2 s can be longer than the hold of 1 s; expected at most "
             "command.hold"},
        Case{"verdict: {window: 1.0e-5}",
             "m.yaml:6:19: verdict.window: 1e-05 s can be less than one sample at 2000 Hz; expected at least "
             "one sample"},
        Case{"controller: {sample_rate: 1}",
             "m.yaml:6:27: verdict.dwell: 0.05 s can be less than one sample at 1 Hz; expected at least one "
             "sample\n"
             "m.yaml:6:27: verdict.window: 0.05 s can be less than one sample at 1 Hz; expected at least one "
             "sample"},
        Case{
            "initial: {preload: -0.3}",
            "m.yaml:6:20: initial.preload: a preload of 0.3 N m can reach the breakaway of 0.3 N m; expected "
            "|initial.preload| below friction.breakaway"},
        Case{
            "initial: {preload: {normal: {mean: 0, sd: 0.01}}}",
            "m.yaml:6:20: initial.preload: a preload of inf N m can reach the breakaway of 0.3 N m; expected "
            "|initial.preload| below friction.breakaway"},
        Case{"controller: {sample_rate: 1.0e13}",
             "m.yaml:6:27: command.hold: 1 moves of 1 s at 10000000000000 Hz can be more than 1000000000000 "
             "samples; "
             "expected at most 1000000000000 samples in a trial"}));

TEST(ManifestErrors, EveryRequiredKeyIsMissed) {
  EXPECT_EQ(failure_of("description: x\n"),
            "m.yaml:1:1: zerocount: the key is missing; expected zerocount: 1\n"
            "m.yaml:1:1: name: the key is missing; expected a name for the study\n"
            "m.yaml:1:1: seed: the key is missing; expected a whole number\n"
            "m.yaml:1:1: trials: the key is missing; expected the number of trials at each design point\n"
            "m.yaml:1:1: command: the key is missing; expected command: {targets: [..]}");
  EXPECT_EQ(
      failure_of("zerocount: 1\nname: x\nseed: 1\ntrials: 1\ncommand: {hold: 1}\n"),
      "m.yaml:5:10: command: it does not say what the moves go to; expected exactly one of targets, torque, "
      "sequence");
}

TEST(ManifestErrors, AMergeKeyIsAKeyLikeAnyOther) {
  EXPECT_EQ(failure_of(minimal_manifest("<<: {name: x}")),
            "m.yaml:6:1: <<: unknown key, nearest known: dac; expected one of zerocount, name, description, "
            "axis, travel, "
            "seed, trials, rigs, design, independent_points, retain, keep, stop, correlation, samples, "
            "observed, sweep, "
            "plant, friction, "
            "encoder, "
            "dac, amplifier, controller, command, initial, verdict");
}

TEST(ManifestErrors, ANewerManifestSaysSo) {
  EXPECT_EQ(failure_of("zerocount: 2\nname: x\nseed: 1\ntrials: 1\ncommand: {targets: [1]}\n"),
            "m.yaml:1:12: zerocount: the manifest is of version 2, newer than this program; expected version "
            "1, or a newer "
            "program");
}

TEST(ManifestErrors, ValuesThatCannotBeReadAreLikeNoOther) {
  const std::string message = failure_of(
      "zerocount: 1\nname: m\nseed: 1\ntrials: 1\ncommand: {targets: [1]}\n"
      "sweep: {grid: {friction.k1: [-1, -2, 5]}}\n");
  EXPECT_NE(message.find("sweep.grid.friction.k1.0"), std::string::npos) << message;
  EXPECT_NE(message.find("sweep.grid.friction.k1.1"), std::string::npos) << message;
  EXPECT_EQ(message.find("twice"), std::string::npos) << message;
}

TEST(ManifestErrors, NumbersOfTheStudyAreChecked) {
  EXPECT_EQ(failure_of("zerocount: 0\nname: ''\nseed: -1\ntrials: 0\ncommand: {targets: []}\n"),
            "m.yaml:1:12: zerocount: there is no version 0 of manifests; expected version 1\n"
            "m.yaml:2:7: name: the name is empty; expected a name for the study\n"
            "m.yaml:3:7: seed: '-1' is out of range; expected a whole number from 0 to 18446744073709551615\n"
            "m.yaml:4:9: trials: '0' is out of range; expected a whole number from 1 to 9007199254740992\n"
            "m.yaml:5:20: command.targets: a list of 0 stands here; expected a list of 1 to 3000 targets");
}

TEST(ManifestErrors, TargetsAreWholeNumbers) {
  EXPECT_EQ(
      failure_of(
          "zerocount: 1\nname: x\nseed: 1\ntrials: 1\ncommand: {targets: [1, 2.5, {uniform: [1, 2]}]}\n"),
      "m.yaml:5:24: command.targets.1: '2.5' is not written as a whole number; expected a whole number from "
      "-1000000000000 to 1000000000000\n"
      "m.yaml:5:39: command.targets.2.uniform: its values are not whole numbers; expected integers, or a "
      "choice of "
      "whole numbers");
}

TEST(ManifestErrors, AllErrorsAreToldInTheOrderOfTheFile) {
  EXPECT_EQ(
      failure_of(minimal_manifest("verdict: {dwell: 2}\n"
                                  "plant: {inertia: no, inertia: 1}\n"
                                  "dac: {bits: 0}\n"
                                  "sead: 1\n"
                                  "sweep: {grid: {controller.ki: [-1]}}\n")),
      "m.yaml:6:18: verdict.dwell: 2 s can be longer than the hold of 1 s; expected at most command.hold\n"
      "m.yaml:7:18: plant.inertia: 'no' is a truth value; expected a number greater than 0\n"
      "m.yaml:7:22: plant.inertia: the key stands twice in the same map; expected each key once\n"
      "m.yaml:8:13: dac.bits: '0' is out of range; expected a whole number from 1 to 32\n"
      "m.yaml:9:1: sead: unknown key, nearest known: seed; expected one of zerocount, name, description, "
      "axis, travel, "
      "seed, "
      "trials, rigs, design, independent_points, retain, keep, stop, correlation, samples, observed, sweep, "
      "plant, "
      "friction, encoder, "
      "dac, "
      "amplifier, controller, "
      "command, initial, verdict\n"
      "m.yaml:10:32: sweep.grid.controller.ki.0: '-1' is out of range; expected a number at least 0 and at "
      "most 1000000");
}

TEST(ManifestErrors, AManifestIsAMap) {
  EXPECT_EQ(failure_of("- 1\n"),
            "m.yaml:1:1: manifest: a list stands here; expected a map with the keys zerocount, name, seed, "
            "trials, command");
  EXPECT_EQ(failure_of(""),
            "m.yaml:1:1: manifest: the manifest is empty; expected the keys zerocount, name, seed, trials, "
            "command");
}

TEST(ManifestErrors, AHugeTextIsRefusedUnread) {
  EXPECT_EQ(failure_of(std::string(100'000'000, '[')),
            "m.yaml:1:1: manifest: the file is too large; expected at most 1048576 bytes");
}

}  // namespace
}  // namespace zerocount::manifest
