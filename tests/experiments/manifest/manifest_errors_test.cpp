#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::manifest {
namespace {

struct Case {
  const char* line;    // the sixth line of an otherwise good manifest
  const char* faults;  // see has_faults()
};

// The line names the test.
void PrintTo(const Case& tested, std::ostream* out) {
  *out << tested.line;
}

class FaultOnTheSixthLine : public ::testing::TestWithParam<Case> {};

TEST_P(FaultOnTheSixthLine, IsReported) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(GetParam().line)), GetParam().faults));
}

INSTANTIATE_TEST_SUITE_P(
    UnknownKeys, FaultOnTheSixthLine,
    ::testing::Values(Case{"plant: {«inertai»: 1}", "«»: plant.inertai | inertia"},
                      Case{"friction: {«kp»: 1}", "«»: friction.kp | controller.kp"},
                      Case{"«frictoin»: {k1: 1}", "«»: frictoin | friction"},
                      Case{"friction: {k1: {«unifrom»: [1, 2]}}", "«»: friction.k1.unifrom | uniform"},
                      Case{"friction: {k1: {lognormal: {median: 1, cv: 1, «mean»: 1}}}",
                           "«»: friction.k1.lognormal.mean | median"},
                      Case{"retain: {«trails»: [1]}", "«»: retain.trails | trials"},
                      Case{"sweep: {«gird»: {}}", "«»: sweep.gird | grid"},
                      Case{"observed: {all: {successes: «3», of: 2}}",
                           "«»: observed.all.successes | from 0 to 2"},
                      Case{"observed: {all: «{successes: 3}»}", "«»: observed.all.of | the key is missing"},
                      Case{"observed: {«b»: text}", "«»: observed.b | nearest known: all"}));

INSTANTIATE_TEST_SUITE_P(
    WrongTypes, FaultOnTheSixthLine,
    ::testing::Values(Case{"plant: «3»", "«»: plant | '3'"},
                      Case{"plant: {inertia: «heavy»}", "«»: plant.inertia | is not a number"},
                      Case{"plant: {inertia: «\"1\"»}", "«»: plant.inertia | quoted text"},
                      Case{"plant: {inertia: «[1]»}", "«»: plant.inertia | a list"},
                      Case{"plant: {inertia: «»}", "«»: plant.inertia | the value is empty"},
                      Case{"plant: {inertia: «~»}", "«»: plant.inertia | the value is empty"},
                      Case{"dac: {bits: «12.5»}", "«»: dac.bits | not written as a whole number"},
                      Case{"dac: {bits: «1.2e1»}", "«»: dac.bits | not written as a whole number"},
                      Case{"controller: {anti_windup: «klamp»}", "«»: controller.anti_windup | 'klamp'"},
                      Case{"design: «random»", "«»: design | 'random'"},
                      Case{"design: «~»", "«»: design | the value is empty"},
                      Case{"independent_points: «1»", "«»: independent_points | truth value"},
                      Case{"independent_points: «\"true\"»", "«»: independent_points | quoted text"},
                      Case{"verdict: {stop: «1»}", "«»: verdict.stop | truth value"},
                      Case{"verdict: {stop: «yes»}", "«»: verdict.stop | truth value"},
                      Case{"verdict: {stop: «'true'»}", "«»: verdict.stop | quoted text"},
                      Case{"verdict: {stop: «{choice: [0, 1]}»}", "«»: verdict.stop | a map"},
                      Case{"verdict: {stop: true, limit: «1»}", "«»: verdict.limit | greater than 1"},
                      Case{"description: «12»", "«»: description | truth value"},
                      Case{"description: «[a]»", "«»: description | a list"},
                      Case{"retain: {trials: «1»}", "«»: retain.trials | '1'"}));

INSTANTIATE_TEST_SUITE_P(
    YamlTraps, FaultOnTheSixthLine,
    ::testing::Values(Case{"independent_points: «yes»", "«»: independent_points | truth value"},
                      Case{"controller: {kp: «no»}", "«»: controller.kp | truth value"},
                      Case{"controller: {kp: «010»}", "«»: controller.kp | octal"},
                      Case{"dac: {bits: «010»}", "«»: dac.bits | octal"},
                      Case{"controller: {kp: «0x10»}", "«»: controller.kp | not decimal"},
                      Case{"controller: {kp: «1_000»}", "«»: controller.kp | underscores"},
                      Case{"controller: {kp: «1:30»}", "«»: controller.kp | base 60"},
                      Case{"controller: {kp: «-07.5»}", "«»: controller.kp | octal"},
                      Case{"controller: {kp: «+-07»}", "«»: controller.kp | plus sign"},
                      Case{"controller: {kp: «-0o17»}", "«»: controller.kp | not decimal"},
                      Case{"controller: {kp: «0b2_0»}", "«»: controller.kp | not decimal"},
                      Case{"controller: {kp: «0x»}", "«»: controller.kp | is not a number"},
                      Case{"controller: {kp: «0xg»}", "«»: controller.kp | is not a number"},
                      Case{"controller: {kp: «-1e_3»}", "«»: controller.kp | underscores"},
                      Case{"controller: {kp: «1_a»}", "«»: controller.kp | is not a number"},
                      Case{"controller: {kp: «-1:30:0.5»}", "«»: controller.kp | base 60"},
                      Case{"controller: {kp: «1.5:30»}", "«»: controller.kp | is not a number"},
                      Case{"controller: {kp: «'1::30'»}", "«»: controller.kp | quoted text"},
                      Case{"controller: {kp: «1::30»}", "«»: controller.kp | is not a number"},
                      Case{"dac: {bits: «1.0»}", "«»: dac.bits | not written as a whole number"},
                      Case{"controller: {kp: «+1»}", "«»: controller.kp | plus sign"},
                      Case{"controller: {kp: «.inf»}", "«»: controller.kp | not finite"},
                      Case{"controller: {kp: «nan»}", "«»: controller.kp | not finite"},
                      Case{"initial: {position: «-.INF»}", "«»: initial.position | not finite"},
                      Case{"controller: {kp: «1e999»}", "«»: controller.kp | too large or too small"},
                      Case{"dac: {bits: «99999999999999999999»}", "«»: dac.bits | from 1 to 32"}));

INSTANTIATE_TEST_SUITE_P(
    OutOfRange, FaultOnTheSixthLine,
    ::testing::Values(
        Case{"plant: {inertia: «0»}", "«»: plant.inertia | greater than 0"},
        Case{"plant: {presliding_damping: «-1»}", "«»: plant.presliding_damping | at least 0"},
        Case{"friction: {n: «0.99»}", "«»: friction.n | at least 1"},
        Case{"friction: {coulomb_ratio: «1.01»}",
             "«»: friction.coulomb_ratio | greater than 0 and at most 1"},
        Case{"initial: {encoder_phase: «1»}", "«»: initial.encoder_phase | at least 0 and less than 1"},
        Case{"dac: {bits: «33»}", "«»: dac.bits | from 1 to 32"},
        Case{"controller: {delay: «-1»}", "«»: controller.delay | at least 0 and at most 100"},
        Case{"encoder: {fine: «0»}", "«»: encoder.fine | from 1 to 1000000000000"},
        Case{"retain: {trials: [«10»]}", "«»: retain.trials.0 | from 0 to 9"},
        Case{"retain: {trials: [1, «1»]}", "«»: retain.trials.1 | duplicate"},
        Case{"machines: «1»", "«»: machines | from 2 to 4294967296"},
        Case{"machines: 4", "4:9: trials | cannot be divided equally"},
        Case{"friction: {k1: {uniform: [1, 2], per: «machine»}}", "«»: friction.k1.per | has no machines"},
        Case{"friction: {k1: {uniform: [1, 2], per: «move»}}", "«»: friction.k1.per | 'move'"},
        Case{"friction: {k1: «{per: trial}»}", "«»: friction.k1 | map with 1 keys"},
        Case{"plant: {inertia: {uniform: [1, 2], per: «contact»}}", "«»: plant.inertia.per | only friction"},
        Case{"friction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: 1}, per: «trial»}}",
             "«»: friction.k1.per | study or machine"},
        Case{"friction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: 1}, per: «contact»}}",
             "«»: friction.k1.per | study or machine"},
        Case{
            "friction: {k1: {profile: {mean: «{uniform: [1, 2], per: machine}», cv: 0.1, correlation_length: "
            "1}}}",
            "«»: friction.k1.profile.mean | per beside profile"},
        Case{
            "friction: {k1: {profile: {mean: «{normal: {mean: 1, sd: 1}}», cv: 0.1, correlation_length: 1}}}",
            "«»: friction.k1.profile.mean | not all positive"},
        Case{"machines: 20", "4:9: trials | cannot be divided equally"}));

INSTANTIATE_TEST_SUITE_P(
    Distributions, FaultOnTheSixthLine,
    ::testing::Values(
        Case{"friction: {k1: {normal: «{mean: 110, sd: 1}»}}", "«»: friction.k1.normal | (0, inf)"},
        Case{"friction: {k1: {uniform: «[0, 1]»}}", "«»: friction.k1.uniform | (0, inf)"},
        Case{"friction: {coulomb_ratio: {lognormal: «{median: 0.5, cv: 0.1}»}}",
             "«»: friction.coulomb_ratio.lognormal | (0, 1]"},
        Case{"friction: {k1: {profile: «{mean: 110, cv: 0.6, correlation_length: 0.2, marginal: normal}»}}",
             "«»: friction.k1.profile | (0, inf)"},
        Case{"friction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: «7»}}}",
             "«»: friction.k1.profile.correlation_length | at least 0.001 and at most 6.283185307179586"},
        Case{"friction: {k1: {profile: «{mean: 110, cv: 0.1}»}}",
             "«»: friction.k1.profile.correlation_length | missing"},
        Case{"friction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: 1, marginal: «gauss»}}}",
             "«»: friction.k1.profile.marginal | 'gauss'"},
        Case{"plant: {inertia: {profile: «{mean: 1, cv: 0.1, correlation_length: 1}»}}",
             "«»: plant.inertia.profile | along the rotor"},
        Case{"friction: {k1: {uniform: «[2, 1]»}}", "«»: friction.k1.uniform | low 2 is not below high 1"},
        Case{"friction: {k1: {uniform: «[1, 2, 3]»}}", "«»: friction.k1.uniform | list of 3"},
        Case{"friction: {k1: {uniform: «{low: 1}»}}", "«»: friction.k1.uniform | a map"},
        Case{"friction: {k1: {uniform: [1, «no»]}}", "«»: friction.k1.uniform.1 | truth value"},
        Case{"friction: {k1: {log_uniform: «[0, 2]»}}", "«»: friction.k1.log_uniform | low is 0"},
        Case{"initial: {position: {normal: «{mean: 0, sd: -1}»}}", "«»: initial.position.normal | sd is -1"},
        Case{"initial: {position: {normal: «{mean: 0}»}}", "«»: initial.position.normal.sd | missing"},
        Case{"initial: {position: {normal: «[0, 1]»}}", "«»: initial.position.normal | a list"},
        Case{"friction: {k1: {lognormal: «{median: 1, cv: 11}»}}", "«»: friction.k1.lognormal | cv is 11"},
        Case{"friction: {k1: {lognormal: «{median: 1.0e308, cv: 1}»}}",
             "«»: friction.k1.lognormal | too large or too small"},
        Case{"friction: {k1: {triangular: «[1, 5, 3]»}}", "«»: friction.k1.triangular | mode 5"},
        Case{"friction: {k1: {truncated_normal: «{mean: 0, sd: 1, low: 20, high: 30}»}}",
             "«»: friction.k1.truncated_normal | 2.75e-89"},
        Case{"friction: {k1: {choice: «[]»}}", "«»: friction.k1.choice | empty"},
        Case{"friction: {k1: {choice: «[1, -1]»}}", "«»: friction.k1.choice | (0, inf)"},
        Case{"friction: {k1: «{uniform: [1, 2], choice: [1]}»}", "«»: friction.k1 | map with 2 keys"},
        Case{"dac: {bits: {uniform: «[8, 16]»}}", "«»: dac.bits.uniform | not whole numbers"},
        Case{"dac: {bits: {integers: [8, «16.5»]}}",
             "«»: dac.bits.integers.1 | not written as a whole number"},
        Case{"dac: {bits: {integers: «[16, 8]»}}", "«»: dac.bits.integers | low 16 is above high 8"},
        Case{"controller: {anti_windup: «{choice: [0, 1]}»}",
             "«»: controller.anti_windup | '{choice: [0, 1]}'"}));

INSTANTIATE_TEST_SUITE_P(
    BetweenParameters, FaultOnTheSixthLine,
    ::testing::Values(
        Case{"verdict: {dwell: «2»}", "«»: verdict.dwell | longer than the hold"},
        Case{"verdict: {window: «1.0e-5»}", "«»: verdict.window | less than one sample"},
        Case{"controller: {sample_rate: «1»}",
             "«»: verdict.dwell | less than one sample\n"
             "«»: verdict.window | less than one sample"},
        Case{"initial: {preload: «-0.3»}", "«»: initial.preload | breakaway of"},
        Case{"initial: {preload: «{normal: {mean: 0, sd: 0.01}}»}", "«»: initial.preload | breakaway of"},
        Case{"controller: {sample_rate: «1.0e13»}", "«»: command.hold | 1000000000000 samples"}));

TEST(ManifestErrors, AMissingRequiredKeyIsReported) {
  EXPECT_TRUE(has_faults(refusal_of("description: x\n"),
                         "1:1: zerocount | missing\n"
                         "1:1: name | missing\n"
                         "1:1: seed | missing\n"
                         "1:1: trials | missing\n"
                         "1:1: command | missing"));
  EXPECT_TRUE(has_faults(refusal_of("zerocount: 1\nname: x\nseed: 1\ntrials: 1\ncommand: «{hold: 1}»\n"),
                         "«»: command | exactly one of"));
}

TEST(ManifestErrors, MergeKeysAreRefused) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("«<<»: {name: x}")), "«»: manifest | merge keys"));
}

TEST(ManifestErrors, ANewerFormatVersionIsReported) {
  EXPECT_TRUE(has_faults(refusal_of("zerocount: «2»\nname: x\nseed: 1\ntrials: 1\ncommand: {targets: [1]}\n"),
                         "«»: zerocount | newer"));
}

TEST(ManifestErrors, UnreadableValuesAreNotCalledDuplicates) {
  const std::string message = refusal_of(
      "zerocount: 1\nname: m\nseed: 1\ntrials: 1\ncommand: {targets: [1]}\n"
      "sweep: {grid: {friction.k1: [-1, -2, 5]}}\n");
  EXPECT_TRUE(says(message, "sweep.grid.friction.k1.0", "sweep.grid.friction.k1.1"));
  EXPECT_FALSE(says(message, "twice"));
}

TEST(ManifestErrors, NumbersOfTheStudyAreChecked) {
  EXPECT_TRUE(has_faults(
      refusal_of("zerocount: «0»\nname: «''»\nseed: «-1»\ntrials: «0»\ncommand: {targets: «[]»}\n"),
      "«1»: zerocount | version 0\n"
      "«2»: name | the text is empty\n"
      "«3»: seed | from 0 to 18446744073709551615\n"
      "«4»: trials | from 1 to 9007199254740992\n"
      "«5»: command.targets | list of 0"));
}

TEST(ManifestErrors, TargetsAreWholeNumbers) {
  EXPECT_TRUE(has_faults(
      refusal_of(
          "zerocount: 1\nname: x\nseed: 1\ntrials: 1\ncommand: {targets: [1, «2.5», {uniform: «[1, 2]»}]}\n"),
      "«1»: command.targets.1 | not written as a whole number\n"
      "«2»: command.targets.2.uniform | not whole numbers"));
}

TEST(ManifestErrors, AllErrorsAreReportedInTheOrderOfTheFile) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("verdict: {dwell: «2»}\n"
                                                     "plant: {inertia: «no», «inertia»: 1}\n"
                                                     "dac: {bits: «0»}\n"
                                                     "«sead»: 1\n"
                                                     "sweep: {grid: {controller.ki: [«-1»]}}\n")),
                         "«1»: verdict.dwell | longer than the hold\n"
                         "«2»: plant.inertia | truth value\n"
                         "«3»: plant.inertia | duplicate\n"
                         "«4»: dac.bits | from 1 to 32\n"
                         "«5»: sead | seed\n"
                         "«6»: sweep.grid.controller.ki.0 | at least 0 and at most 1000000"));
}

// A key that is missing may be there under a wrong name, or where it cannot be read.
TEST(ManifestErrors, TheCauseIsReportedBeforeItsConsequences) {
  EXPECT_TRUE(has_faults(refusal_of("zerocount: 1\nname: x\nseed: 1\ntrials: 1\n«comand»: {targets: [1]}\n"),
                         "«»: comand | command\n1:1: command | missing"));
  const std::string linear =
      "zerocount: 1\nname: x\naxis: linear\nseed: 1\ntrials: 1\ncommand: {targets: [1]}\n"
      "plant: {inertia: 5, presliding_damping: 9, sliding_damping: 9}\n"
      "friction: {k1: 1.0e+5, k2: 2.0e+7, beta: 2.0e+6, lambda: 1.0e+8, breakaway: 12, "
      "stribeck_velocity: 1.0e-3}\n"
      "encoder: {resolution: 1.0e-9}\ndac: {bits: 20, resolution: 5.0e-5}\n";
  EXPECT_TRUE(has_faults(refusal_of(linear + "controller: {«kii»: 1}\n"),
                         "«»: controller.kii | ki\n1:1: controller.ki | missing"));
  EXPECT_TRUE(has_faults(refusal_of(linear + "sweep: {grid: {controller.ki: «5»}}\n"),
                         "«»: sweep.grid.controller.ki | single value | list of values"));
  EXPECT_TRUE(
      has_faults(refusal_of(linear + "sweep: {grid: {controller.ki: [5]}}\n", {"sweep.grid.controller.ki=5"}),
                 "--set sweep.grid.controller.ki=5: sweep.grid.controller.ki | list of values"));
  EXPECT_TRUE(has_faults(refusal_of(linear + "sweep: {«controller.ki»: [5, 6]}\n"),
                         "«»: sweep.controller.ki | the grid or in a case | grid: {controller.ki\n"
                         "1:1: controller.ki | missing"));
}

TEST(ManifestErrors, AnEncoderResolutionInTheWrongUnitIsNamed) {
  EXPECT_TRUE(has_faults(
      refusal_of("zerocount: 1\nname: x\naxis: linear\nseed: 1\ntrials: 1\n"
                 "command: {targets: [400], hold: 1, profile: {shape: trapezoidal}}\n"
                 "plant: {inertia: 5, presliding_damping: 9, sliding_damping: 9}\nfriction: {model: none}\n"
                 "encoder: {resolution: «5»}\ndac: {bits: 20, resolution: 5.0e-5}\ncontroller: {ki: 1}\n",
                 {"command.profile={shape: trapezoidal, velocity_limit: 1, acceleration_limit: 1}"}),
      "«»: encoder.resolution | out of range | 0.1"));
}

TEST(ManifestErrors, AManifestIsAMap) {
  EXPECT_TRUE(has_faults(refusal_of("- 1\n"), "1:1: manifest | a list"));
  EXPECT_TRUE(has_faults(refusal_of("hello world\n"), "1:1: manifest | single value 'hello world' | a map"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("plant: «inertia 5»\n")),
                         "«»: plant | single value 'inertia 5' | plant: {inertia: ...}"));
  EXPECT_TRUE(has_faults(refusal_of(""), "1:1: manifest | the manifest is empty"));
}

TEST(ManifestErrors, AHugeTextIsRefusedUnread) {
  EXPECT_TRUE(has_faults(refusal_of(std::string(100'000'000, '[')), "1:1: manifest | is too large"));
}

}  // namespace
}  // namespace zerocount::manifest
