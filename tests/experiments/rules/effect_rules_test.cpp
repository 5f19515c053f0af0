// A key that would be ignored is refused.
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/rules/value_rules.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::rules {
namespace {

using zerocount::refusal_of;  // of a manifest; that of rules is of an edit

struct IdleCase {
  const char* command;
  const char* more;    // from the sixth line on
  const char* faults;  // see has_faults(); empty: understood
};

void PrintTo(const IdleCase& tested, std::ostream* out) {
  *out << tested.command << " " << tested.more;
}

class EffectRules : public testing::TestWithParam<IdleCase> {};

TEST_P(EffectRules, KeysWithoutEffectAreReported) {
  EXPECT_TRUE(
      has_faults(refusal_of(manifest_commanding(GetParam().command, GetParam().more)), GetParam().faults));
}

INSTANTIATE_TEST_SUITE_P(
    OpenLoop, EffectRules,
    testing::Values(IdleCase{"{torque: {levels: [0.1]}}", "controller: {kp: «1.0e-4»}",
                             "«»: controller.kp | no effect | command.targets"},
                    IdleCase{"{torque: {levels: [0.1]}}", "sweep: {grid: {controller.ki: [«0», 1]}}",
                             "«»: controller.ki | no effect | command.targets"},
                    IdleCase{"{torque: {levels: [0.1]}}", "controller: {coarse: {coarse_beyond: «10»}}",
                             "«»: controller.coarse.coarse_beyond | no effect | command.targets"},
                    IdleCase{"{torque: {levels: [0.1]}, profile: {shape: «s_curve»}}",
                             "initial: {integral: «0.1»}",
                             "«1»: command.profile.shape | no effect | command.targets\n"
                             "«2»: initial.integral | no effect | command.targets"},
                    IdleCase{"{torque: {levels: [0.1]}}", "verdict: {window: «0.1»}",
                             "«»: verdict.window | no effect | command.targets"},
                    IdleCase{"{torque: {levels: [0.1]}}", "verdict: {stop: «true»}",
                             "«»: verdict.stop | no effect | command.targets"},
                    IdleCase{"{torque: {levels: [0.1]}}", "controller: {sample_rate: 1000, delay: 2}", ""},
                    // An integral of nought asks for nothing.
                    IdleCase{"{torque: {levels: [0.1]}}", "initial: {integral: 0}", ""},
                    IdleCase{"{torque: {levels: [0.1], through: exact}}", "dac: {bits: «14»}",
                             "«»: dac.bits | no effect | command.torque.through"},
                    IdleCase{"{torque: {levels: [0.1], through: exact}}", "amplifier: {bandwidth: 100}", ""},
                    IdleCase{"{torque: {levels: [0.1]}}",
                             "dac: {bits: 14}\nsweep: {grid: {command.torque.through: [dac, exact]}}", ""}));

INSTANTIATE_TEST_SUITE_P(
    OtherForms, EffectRules,
    testing::Values(IdleCase{"{targets: [1]}", "sweep: {grid: {command.torque.rate: [«1», 2]}}",
                             "«»: command.torque.rate | no effect | command.torque"},
                    IdleCase{"{targets: [1]}", "sweep: {cases: {a: {command.sequence.overrun: «3»}}}",
                             "«»: command.sequence.overrun | no effect | command.sequence"}));

INSTANTIATE_TEST_SUITE_P(
    Profiles, EffectRules,
    testing::Values(IdleCase{"{targets: [1], profile: {velocity_limit: «1»}}", "",
                             "«»: command.profile.velocity_limit | no effect | command.profile.shape"},
                    IdleCase{"{targets: [1], profile: {shape: trapezoidal, jerk_limit: «1»}}", "",
                             "«»: command.profile.jerk_limit | no effect | command.profile.shape"},
                    IdleCase{"{targets: [1], profile: {acceleration_limit: 1, jerk_limit: «1»}}",
                             "sweep: {grid: {command.profile.shape: [step, trapezoidal]}}",
                             "«»: command.profile.jerk_limit | no effect | command.profile.shape"},
                    IdleCase{"{targets: [1], profile: {acceleration_limit: 1, jerk_limit: 10}}",
                             "sweep: {grid: {command.profile.shape: [step, s_curve]}}", ""}));

INSTANTIATE_TEST_SUITE_P(
    TwoPhases, EffectRules,
    testing::Values(
        IdleCase{"{targets: [1]}", "controller: {coarse: {kp: «1.0e-4», fine_rate: «2»}}",
                 "«1»: controller.coarse.kp | no effect | controller.coarse.coarse_beyond\n"
                 "«2»: controller.coarse.fine_rate | no effect | controller.coarse.coarse_beyond"},
        IdleCase{"{targets: [1]}", "controller: {coarse: {encoder: «coarse», coarse_beyond: 1.0e12}}",
                 "«»: controller.coarse.encoder | no effect | controller.coarse.coarse_beyond"},
        IdleCase{"{targets: [1]}",
                 "controller: {coarse: {kp: 1.0e-4}}\n"
                 "sweep: {cases: {one: {}, two: {controller.coarse.coarse_beyond: 1000}}}",
                 ""},
        IdleCase{"{targets: [1]}", "controller: {coarse: {coarse_beyond: 1.0e12}}", ""},
        // What could not be read may have had any effect.
        IdleCase{"{targets: [1]}", "controller: {coarse: {kp: 1, coarse_beyond: «far»}}",
                 "«»: controller.coarse.coarse_beyond | is not a number"}));

INSTANTIATE_TEST_SUITE_P(
    Blocks, EffectRules,
    testing::Values(IdleCase{"{targets: [1]}", "controller: {structure: cascade, ki: «1.0e-5»}",
                             "«»: controller.ki | no effect | controller.structure"},
                    IdleCase{"{targets: [1]}", "controller: {cascade: {kv: «10»}}",
                             "«»: controller.cascade.kv | no effect | controller.structure"},
                    IdleCase{"{targets: [1]}",
                             "controller: {ki: 1.0e-5, cascade: {kv: 10}}\n"
                             "sweep: {grid: {controller.structure: [pid, cascade]}}",
                             ""},
                    IdleCase{"{targets: [1]}", "controller: {deadband: {leave: «2»}}",
                             "«»: controller.deadband.leave | no effect | controller.deadband.enter"},
                    IdleCase{"{targets: [1]}", "controller: {observer: {inertia: «1.0e-3»}}",
                             "«»: controller.observer.inertia | no effect | controller.observer.bandwidth"},
                    IdleCase{"{targets: [1]}", "controller: {feedforward: {friction: «0.1»}}",
                             "«»: controller.feedforward.friction | no effect | command.profile.shape"},
                    IdleCase{"{targets: [1], profile: {shape: s_curve}}",
                             "controller: {feedforward: {friction: 0.1}}", ""},
                    IdleCase{
                        "{targets: [1]}", "controller: {coarse: {deadband: «1»}}",
                        "«»: controller.coarse.deadband.enter | no effect | controller.coarse.coarse_beyond"},
                    IdleCase{"{torque: {levels: [0.1]}}", "controller: {deadband: «1»}",
                             "«»: controller.deadband.enter | no effect | command.targets"}));

INSTANTIATE_TEST_SUITE_P(
    Encoders, EffectRules,
    testing::Values(
        IdleCase{"{targets: [1]}", "encoder: {fine_errors: {eccentricity_angle: «1»}}",
                 "«»: encoder.fine_errors.eccentricity_angle | no effect | encoder.fine_errors.eccentricity"},
        IdleCase{"{targets: [1]}", "encoder: {coarse_errors: {interpolation_period: «1», interpolation: 0}}",
                 "«»: encoder.coarse_errors.interpolation_period | no effect | "
                 "encoder.coarse_errors.interpolation"},
        // The amplitude of the other encoder does not help.
        IdleCase{
            "{targets: [1]}",
            "encoder: {fine_errors: {interpolation_period: «1»}, coarse_errors: {interpolation: 1}}",
            "«»: encoder.fine_errors.interpolation_period | no effect | encoder.fine_errors.interpolation"},
        IdleCase{"{targets: [1]}",
                 "encoder: {coarse_errors: {eccentricity_angle: 1}}\n"
                 "sweep: {grid: {encoder.coarse_errors.eccentricity: [0, 1.0e-4]}}",
                 ""}));

INSTANTIATE_TEST_SUITE_P(
    Start, EffectRules,
    testing::Values(
        IdleCase{"{targets: [1]}", "initial: {history: {reversals: «3»}}",
                 "«»: initial.history.reversals | no effect | initial.history.torque"},
        IdleCase{"{targets: [1]}", "initial: {history: {torque: «0.1»}}",
                 "«»: initial.history.torque | no effect | initial.history.reversals"},
        IdleCase{"{targets: [1]}",
                 "initial: {history: {torque: 0.1}}\n"
                 "sweep: {cases: {a: {initial.history.reversals: «4», initial.history.torque: 0}}}",
                 "«»: initial.history.reversals | no effect | initial.history.torque"},
        IdleCase{"{targets: [1]}",
                 "initial: {history: {torque: 0.1}}\nsweep: {grid: {initial.history.reversals: [0, 4]}}", ""},
        // Nought of nothing asks for nothing.
        IdleCase{"{targets: [1]}", "initial: {history: {reversals: 0, torque: 0}}", ""},
        IdleCase{"{targets: [1]}", "initial: {mode: slide, velocity: 1, preload: «0.1», hardening: 0}",
                 "«»: initial.preload | no effect | initial.mode"},
        IdleCase{"{targets: [1]}",
                 "initial: {velocity: 1, preload: 0.1}\nsweep: {grid: {initial.mode: [stick, slide]}}", ""}));

std::vector<std::string> warnings(const std::string& more) {
  return study_of(minimal_manifest(more)).warnings;
}

// A model is compared with others by changing one word; what it does not use may stay.
TEST(IdleKeys, AKeyUnusedByTheFrictionModelIsOnlyAWarning) {
  using Warnings = std::vector<std::string>;
  EXPECT_TRUE(has_faults(warnings("friction: {model: coulomb, k1: «100», breakaway: 0.2}\n"),
                         "«»: friction.k1 | (presliding, spring)"));
  EXPECT_TRUE(has_faults(warnings("friction: {model: spring, k1: 100, alpha: «{uniform: [0.1, 0.2]}»}\n"),
                         "«»: friction.alpha | (presliding)"));
  EXPECT_EQ(warnings("friction: {k1: 100, alpha: 0.5}\n"
                     "sweep: {grid: {friction.model: [coulomb, spring, presliding]}}\n"),
            Warnings{});
  EXPECT_TRUE(has_faults(
      warnings("friction: {k1: 100, alpha: «0.5»}\nsweep: {grid: {friction.model: [coulomb, spring]}}\n"),
      "«»: friction.alpha | (presliding)"));
}

// Each law says which parameters it has; a parameter without effect is told the models that have it.
TEST(IdleKeys, AModelUsesTheParametersOfItsLaw) {
  const std::string idle = ": it has no effect: friction.model is never one that uses it ";
  EXPECT_EQ(
      warnings("friction: {model: none, breakaway: «0.2»}\n"
               "plant: {presliding_damping: 0.1, sliding_damping: «0.1»}\n"
               "initial: {mode: «slide»}\n"),
      (std::vector<std::string>{
          "m.yaml:«2»: plant.sliding_damping" + idle + "(presliding, spring, coulomb, lugre, gms)",
          "m.yaml:«3»: initial.mode" + idle + "(presliding, spring, dahl, lugre, gms)",
          "m.yaml:«1»: friction.breakaway" + idle + "(presliding, spring, coulomb, dahl, lugre, gms)"}));
  EXPECT_EQ(warnings("friction: {model: dahl, sigma0: 500, sigma1: 0.1, stribeck_velocity: 0.1}\n"
                     "initial: {preload: 0.1}\n")
                .size(),
            3U);
  EXPECT_EQ(warnings("friction: {model: lugre, sigma0: 500, sigma1: 0.1, stribeck_velocity: 0.1}\n"),
            std::vector<std::string>{});
  EXPECT_EQ(warnings("friction: {model: gms, gms: {attraction: 10}}\ninitial: {preload: 0.1}\n"),
            std::vector<std::string>{});
}

TEST(IdleKeys, ALimitWithoutAStopIsAWarning) {
  using Warnings = std::vector<std::string>;
  const char* const idle = "«»: verdict.limit | no effect";
  EXPECT_TRUE(has_faults(warnings("verdict: {limit: «500»}\n"), idle));
  EXPECT_TRUE(has_faults(warnings("verdict: {limit: «500», stop: false}\n"), idle));
  EXPECT_EQ(warnings("verdict: {limit: 500, stop: true}\n"), Warnings{});
  EXPECT_EQ(warnings("verdict: {limit: 500}\nsweep: {grid: {verdict.stop: [false, true]}}\n"), Warnings{});
}

struct VanishedTerm {
  const char* more;     // from the sixth line on
  const char* warning;  // the only one; empty: none
};

void PrintTo(const VanishedTerm& tested, std::ostream* out) {
  *out << tested.more;
}

class VanishedTerms : public testing::TestWithParam<VanishedTerm> {};

// A manifest that switches a term off by its size may keep the rest of it, and is told.
TEST_P(VanishedTerms, KeysOfATermWithZeroSizeGiveAWarning) {
  EXPECT_TRUE(has_faults(warnings(GetParam().more), GetParam().warning));
}

INSTANTIATE_TEST_SUITE_P(
    OfThePosition, VanishedTerms,
    testing::Values(
        VanishedTerm{"initial: {position: «1»}", "«»: initial.position | no effect"},
        VanishedTerm{"initial: {position: «{uniform: [0, 1]}»}\nencoder: {fine_errors: {noise: 0.1}}",
                     "«»: initial.position | no effect"},
        VanishedTerm{"initial: {position: 0}", ""},
        VanishedTerm{"initial: {position: 1}\nencoder: {fine_errors: {eccentricity: 1.0e-5}}", ""},
        VanishedTerm{"initial: {position: 1}\nencoder: {coarse_errors: {interpolation: {uniform: [0, 1]}}}",
                     ""},
        VanishedTerm{"initial: {position: 1}\n"
                     "friction: {k2: {profile: {mean: 700, cv: 0.1, correlation_length: 1}}}",
                     ""}));

INSTANTIATE_TEST_SUITE_P(
    OfFriction, VanishedTerms,
    testing::Values(
        VanishedTerm{"friction: {alpha: 0, lambda: «5»}", "«»: friction.lambda | no effect"},
        VanishedTerm{"friction: {alpha: 0}\ninitial: {hardening: «1.0e-6»}",
                     "«»: initial.hardening | no effect"},
        VanishedTerm{"friction: {alpha: {uniform: [0, 1]}, lambda: 5, n: 3}\ninitial: {hardening: 1.0e-6}",
                     ""},
        VanishedTerm{"friction: {lambda: 5}\nsweep: {grid: {friction.alpha: [0, 1]}}", ""},
        // Each alone would act somewhere, but not at the same point.
        VanishedTerm{"friction: {n: «1»}\n"
                     "sweep: {cases: {a: {friction.alpha: 0}, b: {friction.model: spring}}}",
                     "«»: friction.n | no effect"},
        VanishedTerm{"friction: {beta: «1.0e+5», k2: 0}", "«»: friction.beta | no effect"},
        VanishedTerm{"friction: {beta: 1.0e+5}\nsweep: {grid: {friction.k2: [0, 750]}}", ""},
        VanishedTerm{"friction: {coulomb_ratio: 1, stribeck_velocity: «0.1»}",
                     "«»: friction.stribeck_velocity | no effect"},
        VanishedTerm{"friction: {coulomb_ratio: {choice: [1, 0.9]}, stribeck_velocity: 0.1}", ""}));

INSTANTIATE_TEST_SUITE_P(
    OfTheMode, VanishedTerms,
    testing::Values(VanishedTerm{"friction: {model: coulomb}\ninitial: {mode: «slide», velocity: 1}",
                                 "«»: initial.mode | (presliding, spring, dahl, lugre, gms)"},
                    VanishedTerm{"friction: {model: coulomb}\ninitial: {mode: stick, velocity: 1}", ""},
                    VanishedTerm{"initial: {mode: slide, velocity: 1}\n"
                                 "sweep: {grid: {friction.model: [coulomb, spring]}}",
                                 ""}));

// The rules name what there is.
TEST(IdleKeys, MessagesNameOnlyParametersAndSections) {
  for (const bool open_loop : {false, true}) {
    study::StudyPlan plan;
    plan.open_loop = open_loop;
    for (const EffectRule& rule : effect_rules(plan)) {
      for (const std::string_view name : rule.depends_on)
        EXPECT_TRUE(parameters::find_parameter(name)) << name;
      std::vector<std::string_view> named = rule.keys;
      named.insert(named.end(), rule.except.begin(), rule.except.end());
      for (const std::string_view key : named) {
        if (key == "controller.parameters") continue;  // those of a plugin
        const auto table = parameters::parameter_table();
        EXPECT_TRUE(std::any_of(table.begin(), table.end(), [&](const parameters::Parameter& parameter) {
          return keys::is_within(parameter.name, key);
        })) << key;
      }
    }
  }
}

// Values that do not fit one another are refused, wherever they can meet.

struct UnfitCase {
  const char* command;
  const char* more;    // from the sixth line on
  const char* faults;  // see has_faults(); empty: understood
};

void PrintTo(const UnfitCase& tested, std::ostream* out) {
  *out << tested.command << " " << tested.more;
}

class ValueRules : public testing::TestWithParam<UnfitCase> {};

TEST_P(ValueRules, ContradictoryValuesAreReported) {
  EXPECT_TRUE(
      has_faults(refusal_of(manifest_commanding(GetParam().command, GetParam().more)), GetParam().faults));
}

INSTANTIATE_TEST_SUITE_P(
    Start, ValueRules,
    testing::Values(UnfitCase{"{targets: [1]}", "initial: {history: {reversals: 3, torque: «0.3»}}",
                              "«»: initial.history.torque | breakaway of"},
                    UnfitCase{"{targets: [1]}",
                              "initial: {history: {reversals: 3, torque: «{uniform: [0, 0.35]}»}}\n"
                              "friction: {breakaway: {uniform: [0.3, 0.4]}}",
                              "«»: initial.history.torque | breakaway of"},
                    UnfitCase{"{targets: [1]}",
                              "initial: {history: {reversals: 3, torque: 0.25}}\n"
                              "sweep: {grid: {friction.breakaway: [0.3, «0.2»]}}",
                              "«»: initial.history.torque | breakaway of"},
                    UnfitCase{"{targets: [1]}", "initial: {history: {reversals: 3, torque: 0.29}}", ""},
                    UnfitCase{"{targets: [1]}", "initial: {mode: «slide»}", "«»: initial.velocity | never 0"},
                    UnfitCase{"{targets: [1]}", "initial: {mode: slide, velocity: «{uniform: [-1, 1]}»}",
                              "«»: initial.velocity | never 0"},
                    UnfitCase{"{targets: [1]}", "initial: {mode: slide, velocity: {choice: [-1, 1]}}", ""},
                    UnfitCase{"{targets: [1]}", "initial: {mode: slide, velocity: {uniform: [0.1, 1]}}", ""},
                    UnfitCase{"{targets: [1]}", "initial: {velocity: {uniform: [-1, 1]}}", ""},
                    UnfitCase{"{targets: [1]}",
                              "initial: {velocity: 0.1}\n"
                              "sweep: {cases: {a: {}, b: {initial.mode: slide, initial.velocity: «0»}}}",
                              "«»: initial.velocity | never 0"}));

INSTANTIATE_TEST_SUITE_P(
    TwoPhases, ValueRules,
    testing::Values(
        UnfitCase{"{targets: [1]}", "controller: {kd: «1.0e-4», coarse: {coarse_beyond: 1000}}",
                  "«»: controller.kd | controller.coarse.kd"},
        UnfitCase{"{targets: [1]}",
                  "controller: {coarse: {coarse_beyond: 1000}}\n"
                  "sweep: {grid: {controller.kd: [0, «1.0e-4»]}}",
                  "«»: controller.kd | controller.coarse.kd"},
        UnfitCase{
            "{targets: [1]}",
            "sweep: {cases: {one: {controller.kd: 1.0e-4}, two: {controller.coarse.coarse_beyond: 1000}}}",
            ""},
        UnfitCase{"{targets: [1]}", "controller: {kd: 1.0e-4, coarse: {coarse_beyond: 1000000000000}}", ""},
        UnfitCase{"{targets: [1]}", "controller: {coarse: {coarse_beyond: «99»}}",
                  "«»: controller.coarse.fine_within | at most controller.coarse.coarse_beyond"},
        UnfitCase{
            "{targets: [1]}",
            "controller: {coarse: {coarse_beyond: {uniform: [50, 90]}, fine_within: «{uniform: [10, 60]}»}}",
            "«»: controller.coarse.fine_within | at most controller.coarse.coarse_beyond"},
        UnfitCase{"{targets: [1]}", "controller: {coarse: {coarse_beyond: 60, fine_within: 60}}", ""}));

constexpr const char* loops_on_two_masses =
    "controller: {structure: cascade, cascade: {position: motor, velocity: «load»}}\n"
    "plant: {load: {inertia: 1.0e-3}}\n";

INSTANTIATE_TEST_SUITE_P(
    TwoEncoders, ValueRules,
    testing::Values(
        UnfitCase{"{targets: [1]}", loops_on_two_masses,
                  "«»: controller.cascade.velocity | read two masses | encoder.load"},
        UnfitCase{"{targets: [1]}",
                  "controller: {structure: cascade, cascade: {position: «load»}}\n"
                  "plant: {load: {inertia: 1.0e-3}}",
                  "«»: controller.cascade.velocity | read two masses | encoder.load"},
        UnfitCase{"{targets: [1]}",
                  "controller: {structure: cascade, cascade: {position: load, velocity: load}}\n"
                  "plant: {load: {inertia: 1.0e-3}}",
                  ""},
        UnfitCase{"{targets: [1]}",
                  "controller: {structure: cascade, cascade: {position: load}}\n"
                  "plant: {load: {inertia: 1.0e-3}}\nencoder: {load: {counts_per_revolution: 20000}}",
                  ""},
        UnfitCase{"{targets: [1]}",
                  "controller: {encoder: «coarse»}\nplant: {load: {inertia: 1.0e-3}}\n"
                  "encoder: {load: {counts_per_revolution: 20000}}",
                  "«»: controller.encoder | no coarse encoder beside encoder.load | fine"},
        // Counts are of the encoder that closes the loop: 0.16 rad, and a whole turn.
        UnfitCase{"{targets: [100000], hold: 1, profile: {shape: trapezoidal, velocity_limit: 1}}",
                  "plant: {load: {inertia: 1.0e-3, encoder: load}}\n"
                  "encoder: {fine: 4000, load: {counts_per_revolution: 4000000}}",
                  ""},
        UnfitCase{"{targets: [4000], hold: «1», profile: {shape: trapezoidal, velocity_limit: 1}}",
                  "plant: {load: {inertia: 1.0e-3, encoder: load}}\n"
                  "encoder: {fine: 4000000, load: {counts_per_revolution: 4000}}",
                  "«»: command.hold | can take"}));

INSTANTIATE_TEST_SUITE_P(
    TwoEncoders, EffectRules,
    testing::Values(IdleCase{"{targets: [1]}", "encoder: {load: {counts_per_revolution: «20000»}}",
                             "«»: encoder.load.counts_per_revolution | no point has a second mass"},
                    IdleCase{"{targets: [1]}", "initial: {load_encoder_phase: «0.2»}",
                             "«»: initial.load_encoder_phase | no point has an encoder on the second mass"},
                    IdleCase{"{targets: [1]}",
                             "plant: {load: {inertia: 1.0e-3}}\n"
                             "encoder: {coarse: «1000», load: {counts_per_revolution: 20000}}",
                             "«»: encoder.coarse | encoder.load reads the load | either"}));

INSTANTIATE_TEST_SUITE_P(
    Blocks, ValueRules,
    testing::Values(UnfitCase{"{targets: [1]}", "controller: {deadband: {enter: 2, leave: «1»}}",
                              "«»: controller.deadband.leave | deadband"},
                    UnfitCase{"{targets: [1]}", "controller: {deadband: {enter: 2, leave: 2}}", ""},
                    UnfitCase{"{targets: [1]}", "controller: {observer: {bandwidth: «1000»}}",
                              "«»: controller.observer.bandwidth | half the sample rate"},
                    UnfitCase{"{targets: [1]}", "controller: {observer: {bandwidth: 999}}", ""}));

INSTANTIATE_TEST_SUITE_P(EarlyDecision, ValueRules,
                         testing::Values(UnfitCase{"{sequence: {targets: [5, 10], overrun: 3}}",
                                                   "verdict: {stop: «true»}", "«»: verdict.stop | ISO 230-2"},
                                         UnfitCase{"{sequence: {targets: [5, 10], overrun: 3}}",
                                                   "sweep: {grid: {verdict.stop: [false, «true»]}}",
                                                   "«»: verdict.stop | ISO 230-2"},
                                         UnfitCase{"{sequence: {targets: [5, 10], overrun: 3}}",
                                                   "verdict: {stop: false}", ""},
                                         UnfitCase{"{targets: [5, 10]}", "verdict: {stop: true}", ""}));

TEST(EarlyDecision, GivesAWarningIfACoarsePhaseMayUndoIt) {
  const auto warnings = [](const std::string& more) { return study_of(minimal_manifest(more)).warnings; };
  const std::string coarse = "controller: {coarse: {coarse_beyond: 300}}\n";
  EXPECT_TRUE(has_faults(warnings(coarse + "verdict: {stop: «true»}\n"), "«»: verdict.stop | coarse phase"));
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
        UnfitCase{"{torque: {levels: [0.1]}, hold: «1.0e-4»}", "", "«»: command.hold | less than one sample"},
        // Nothing is judged, so neither dwell nor window must fit.
        UnfitCase{"{torque: {levels: [0.1]}, hold: 0.01}", "", ""},
        // A level is reached at the rate; beyond the breakaway the rotor may well slide.
        UnfitCase{"{torque: {levels: [0.4, -0.4]}}", "", ""},
        UnfitCase{"{torque: {levels: [0.1, «{normal: {mean: 0, sd: 1}}»]}}", "",
                  "«»: command.torque.levels.1 | unbounded"},
        UnfitCase{"{torque: {levels: [0.1], rate: «{lognormal: {median: 1, cv: 0.1}}»}}", "",
                  "«»: command.torque.rate | a ramp takes for ever"},
        // The torque stays at 0, where it is already: however small the rate, that takes no time.
        UnfitCase{"{torque: {levels: [0, 0], rate: {lognormal: {median: 1, cv: 0.1}}}, hold: 1}", "", ""},
        UnfitCase{"{torque: {levels: [0, 0], rate: {lognormal: {median: 1, cv: 0.1}}}, hold: «1.0e+9»}", "",
                  "«»: command.hold | 1000000000000 samples"},
        UnfitCase{"{torque: {levels: [0.1]}, hold: «{lognormal: {median: 1, cv: 0.1}}»}", "",
                  "«»: command.hold | less than one sample\n"
                  "«»: command.hold | unbounded"},
        UnfitCase{"{torque: {levels: [0.1], rate: «1.0e-10»}}", "",
                  "«»: command.hold | 1000000000000 samples"}));

INSTANTIATE_TEST_SUITE_P(
    Samples, ValueRules,
    testing::Values(
        UnfitCase{"{targets: [1], hold: «{truncated_normal: {mean: 1, sd: 0.1, low: 0.5, high: 1.0e+9}}»}",
                  "", "«»: command.hold | 1000000000000 samples"},
        UnfitCase{"{targets: [1]}",
                  "controller: {sample_rate: «{lognormal: {median: 2000, cv: 0.1}}»}\n"
                  "verdict: {dwell: «0.05», window: «0.05»}",
                  "«1»: controller.sample_rate | unbounded\n"
                  "«2»: verdict.dwell | less than one sample\n"
                  "«3»: verdict.window | less than one sample"}));

// Paper's machine: 2π/1 620 000 rad a count. From 0 to 1° = 4500 counts = 0.01745 rad: with 2 rad/s and 100
// rad/s² the velocity stays below its limit, and the travel takes 2√(0.01745/100) = 0.0264222 s.
INSTANTIATE_TEST_SUITE_P(
    Travel, ValueRules,
    testing::Values(
        UnfitCase{"{targets: [4500], hold: «0.0764», profile: {shape: trapezoidal}}", "",
                  "«»: command.hold | 0.0264222 s | at least 0.0764222 s"},
        UnfitCase{"{targets: [4500], hold: 0.0765, profile: {shape: trapezoidal}}", "", ""},
        UnfitCase{"{targets: [4500], hold: 0.06, profile: {shape: step}}", "", ""},
        // The way back is the longest: 9000 counts.
        UnfitCase{"{targets: [4500, -4500], hold: «0.08», profile: {shape: trapezoidal}}", "",
                  "«»: command.hold | 0.0373666 s | at least 0.0873666 s"},
        UnfitCase{"{targets: [{integers: [-10, 4500]}], hold: «0.0764», profile: {shape: trapezoidal}}", "",
                  "«»: command.hold | 0.0264222 s | at least 0.0764222 s"},
        // At 0.01 rad/s and ever higher accelerations: 1.7453 s.
        UnfitCase{"{targets: [4500], profile: {shape: s_curve, velocity_limit: {uniform: [0.01, 1]}}}",
                  "sweep: {grid: {command.profile.acceleration_limit: [«1.0e6», 1.0e7], "
                  "command.profile.jerk_limit: [1.0e12]}}",
                  "«»: command.hold | 1.74533 s | at least 1.79533 s"},
        UnfitCase{
            "{targets: [4500], profile: {shape: «trapezoidal», velocity_limit: {lognormal: {median: 2, cv: "
            "0.1}}}}",
            "", "«»: command.hold | takes for ever"},
        // From one end of the axis to the other; the overrun; and in a cycle from one side the way back.
        UnfitCase{
            "{sequence: {targets: [0, 4500], overrun: 10}, hold: «0.0764», profile: {shape: trapezoidal}}",
            "", "«»: command.hold | 0.0264222 s | at least 0.0764222 s"},
        UnfitCase{
            "{sequence: {targets: [0, 10], overrun: 4500}, hold: «0.0764», profile: {shape: trapezoidal}}",
            "", "«»: command.hold | 0.0264222 s | at least 0.0764222 s"},
        UnfitCase{
            "{sequence: {targets: [4510, 4520], overrun: 10, cycles: 1}, hold: «0.0764», profile: {shape: "
            "trapezoidal}}",
            "", "«»: command.hold | 0.0264222 s | at least 0.0764222 s"},
        UnfitCase{"{sequence: {targets: [0, 2240, 4490], overrun: 10, approach: positive}, hold: «0.0764», "
                  "profile: {shape: trapezoidal}}",
                  "", "«»: command.hold | 0.0264222 s | at least 0.0764222 s"},
        UnfitCase{"{sequence: {targets: [0, 2240, 4490], overrun: 10, approach: positive, cycles: 1}, hold: "
                  "0.0764, profile: {shape: trapezoidal}}",
                  "", ""},
        UnfitCase{"{sequence: {targets: [-4490, -2240, 0], overrun: 10, approach: negative}, hold: «0.0764», "
                  "profile: {shape: trapezoidal}}",
                  "", "«»: command.hold | 0.0264222 s | at least 0.0764222 s"}));

TEST(FittingValues, ATorqueBeyondTheConverterIsClippedWithAWarning) {
  const auto warnings = [](const std::string& torque, const std::string& more = "") {
    return study_of(manifest_commanding("{torque: " + torque + "}", more)).warnings;
  };
  using Warnings = std::vector<std::string>;
  // 12 bits at 2.4e-4 N m: −2048 … 2047 codes.
  EXPECT_TRUE(
      has_faults(warnings("{levels: [0.49, «0.4913», -0.4915]}"), "«»: command.torque.levels.1 | converter"));
  EXPECT_EQ(warnings("{levels: [{uniform: [-0.5, 0]}]}").size(), 1u);
  EXPECT_EQ(warnings("{levels: [0.49, 0.5], through: exact}"), Warnings{});
  EXPECT_TRUE(has_faults(warnings("{levels: [«0.3»]}", "amplifier: {limit: 0.2}\n"),
                         "«»: command.torque.levels.0 | converter's range from -0.2 to 0.2"));
  EXPECT_TRUE(has_faults(warnings("{levels: [«0.3»], through: exact}", "amplifier: {limit: 0.2}\n"),
                         "«»: command.torque.levels.0 | amplifier's range from -0.2 to 0.2"));
  EXPECT_TRUE(has_faults(warnings("{levels: [0.49]}", "sweep: {grid: {dac.bits: [12, «11»]}}\n"),
                         "«»: command.torque.levels.0 | converter"));
}

// With a second mass the integral holds what the contact cannot.
TEST(FittingValues, AHeldLoadMustBeCarriedByTheContactOrTheIntegral) {
  const auto refusal = [](const std::string& more) {
    return refusal_of(manifest_commanding("{targets: [0], hold: 1}", more + "initial: {holding: «true»}\n"));
  };
  const std::string load = "plant: {load: {inertia: 1.0e-3, gap: 1.0e-4}}\n";
  EXPECT_TRUE(
      has_faults(refusal("disturbance: {torque: 9}\n"), "«»: initial.holding | can reach the friction"));
  EXPECT_EQ(refusal(load + "disturbance: {torque: 9, load: {ripple: [{amplitude: 8, periods: 1}]}}\n"), "");
  EXPECT_TRUE(has_faults(refusal_of(manifest_commanding(
                             "{torque: {levels: [0.1]}}",
                             load + "disturbance: {torque: 0.1, load: {torque: 0.1, ripple: "
                                    "[{amplitude: 0.2, periods: 1}]}}\ninitial: {holding: «true»}\n")),
                         "«»: initial.holding | a disturbance of 0.4 N m can reach the friction of 0.3 N m"));
  EXPECT_EQ(refusal(load + "friction: {model: none}\ndisturbance: {load: {torque: 1}}\n"), "");
  EXPECT_TRUE(has_faults(refusal_of(manifest_commanding(
                             "{targets: [0], hold: 1}",
                             load + "disturbance: {torque: 0.01}\ninitial: {holding: «true», gap: 0.2}\n")),
                         "«»: initial.holding | lies where | initial.gap of 0"));
}

TEST(FittingValues, ASequenceCountsTheSamplesOfAllItsMoves) {
  EXPECT_TRUE(
      has_faults(refusal_of(manifest_commanding("{sequence: {targets: [1, 2], overrun: 1, cycles: 10000}}",
                                                "controller: {sample_rate: «2.0e7»}")),
                 "«»: command.hold | 1000000000000 samples"));
}

}  // namespace
}  // namespace zerocount::rules
