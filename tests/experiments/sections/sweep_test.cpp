#include "experiments/sections/sections.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::sections {
namespace {

using Labels = std::vector<std::string>;
using Numbers = std::vector<double>;

study::Study swept(const std::string& sweep, const std::string& more = "") {
  return study_of(minimal_manifest(more + "sweep: " + sweep + "\n"));
}

std::string failure_of(const std::string& sweep) {
  return refusal_of(minimal_manifest("sweep: " + sweep + "\n"));
}

TEST(Sweep, AStudyWithoutASweepHasOnePoint) {
  const study::Study study = study_of(minimal_manifest());
  EXPECT_EQ(study.points.labels, Labels{"all"});
  EXPECT_TRUE(study.points.axes.empty());
  EXPECT_EQ(swept("{}").points.labels, Labels{"all"});
  EXPECT_EQ(swept("{grid: {}, cases: {}}").points.labels, Labels{"all"});
}

TEST(Sweep, GridIsTheProductWithTheLastKeyFastest) {
  const study::Study study =
      swept("{grid: {controller.kp: [0, 1.0e-4], controller.ki: [1.0e-5, 2.0e-5, 3.0e-5]}}");
  EXPECT_EQ(study.points.labels.size(), 6u);
  EXPECT_EQ(study.points.labels[1], "controller.kp=0, controller.ki=2e-05");
  EXPECT_EQ(study.points.labels[3], "controller.kp=0.0001, controller.ki=1e-05");
  ASSERT_EQ(study.points.axes.size(), 2u);
  EXPECT_EQ(study.points.axes[0].name, "controller.kp");
  EXPECT_EQ(study.points.axes[0].unit, "N m/count");
  EXPECT_EQ(study.points.axes[0].numbers, (Numbers{0, 0, 0, 1e-4, 1e-4, 1e-4}));
  EXPECT_EQ(study.points.axes[1].numbers, (Numbers{1e-5, 2e-5, 3e-5, 1e-5, 2e-5, 3e-5}));
  EXPECT_EQ(study::study_trial(study, 4, 0).parameters.controller.kp, 1e-4);
  EXPECT_EQ(study::study_trial(study, 4, 0).parameters.controller.ki, 2e-5);
}

TEST(Sweep, CasesAreNamed) {
  const study::Study study = swept("{cases: {plain: {}, fast: {controller.ki: 9.0e-5, dac.bits: 16}}}");
  EXPECT_EQ(study.points.labels, (Labels{"plain", "fast"}));
  ASSERT_EQ(study.points.axes.size(), 3u);
  EXPECT_EQ(study.points.axes[0].name, "case");
  EXPECT_EQ(study.points.axes[0].texts, (Labels{"plain", "fast"}));
  EXPECT_EQ(study.points.axes[1].numbers, (Numbers{3.85e-5, 9e-5}));  // the default where the case is silent
  EXPECT_EQ(study.points.axes[2].numbers, (Numbers{12, 16}));
  EXPECT_EQ(study::study_trial(study, 1, 0).parameters.dac.bits, 16);
  EXPECT_EQ(study::study_trial(study, 0, 0).parameters.dac.bits, 12);
}

// `--point 1` is the point with this number, whatever the cases are called.
TEST(Sweep, ACaseCannotHaveTheNameOfANumberOfAPoint) {
  for (const std::string name : {"'0'", "'1'", "\"12\"", "'-3'"}) {
    EXPECT_NE(
        failure_of("{cases: {" + name + ": {controller.ki: 1.0e-5}}}")
            .find("the name of a case is a whole number, which stands for the number of a design point"),
        std::string::npos)
        << name;
  }
  for (const std::string name : {"a1", "1a", "'1.5'", "'1 2'"})
    EXPECT_EQ(swept("{cases: {" + name + ": {controller.ki: 1.0e-5}}}").points.labels.size(), 1U) << name;
}

TEST(Sweep, CasesAndGridMultiplyWithTheCasesSlowest) {
  const study::Study study =
      swept("{grid: {controller.kp: [0, 1.0e-4]}, cases: {a: {dac.bits: 10}, b: {dac.bits: 14}}}");
  EXPECT_EQ(study.points.labels, (Labels{"a, controller.kp=0", "a, controller.kp=0.0001",
                                         "b, controller.kp=0", "b, controller.kp=0.0001"}));
  EXPECT_EQ(study::study_trial(study, 3, 0).parameters.dac.bits, 14);
  EXPECT_EQ(study::study_trial(study, 3, 0).parameters.controller.kp, 1e-4);
}

TEST(Sweep, TheGridWinsOverTheCasesWithAWarning) {
  const study::Study study =
      swept("{grid: {«controller.ki»: [1.0e-5, 2.0e-5]}, cases: {a: {controller.ki: 5.0e-5}}}");
  EXPECT_EQ(study::study_trial(study, 1, 0).parameters.controller.ki, 2e-5);
  ASSERT_EQ(study.points.axes.size(), 2u);
  EXPECT_EQ(study.points.axes[1].numbers, (Numbers{1e-5, 2e-5}));
  EXPECT_TRUE(has_faults(study.warnings, "«»: sweep.grid.controller.ki | replace"));
}

TEST(Sweep, LinspaceAndLogspaceIncludeTheirEnds) {
  const study::Study linear = swept("{grid: {controller.ki: {linspace: [1.0e-5, 3.0e-4, 30]}}}");
  ASSERT_EQ(linear.points.axes[0].numbers.size(), 30u);
  for (int i = 0; i < 30; ++i)
    EXPECT_NEAR(linear.points.axes[0].numbers[static_cast<std::size_t>(i)], 1e-5 * (i + 1), 1e-18);
  EXPECT_EQ(linear.points.axes[0].numbers.back(), 3.0e-4);
  EXPECT_EQ(linear.points.labels[1], "controller.ki=2e-05");
  const study::Study logarithmic = swept("{grid: {friction.alpha: {logspace: [0.01, 100, 5]}}}");
  EXPECT_EQ(logarithmic.points.axes[0].numbers, (Numbers{0.01, 0.1, 1, 10, 100}));
}

TEST(Sweep, WholeNumbersMayBeSpacedIfTheyStayWhole) {
  EXPECT_EQ(swept("{grid: {command.targets.0: {linspace: [1, 10, 10]}}}").points.axes[0].numbers.size(), 10u);
  EXPECT_TRUE(has_faults(failure_of("{grid: {command.targets.0: {linspace: «[1, 2, 3]»}}}"),
                         "«»: sweep.grid.command.targets.0.linspace | is not allowed"));
}

TEST(Sweep, SpacedValuesOfAnotherFormAreRefused) {
  const auto of_exponent = [](const std::string& values) {
    return failure_of("{grid: {friction.n: " + values + "}}");
  };
  EXPECT_TRUE(
      has_faults(of_exponent("{linspace: «[1, 2]»}"), "«»: sweep.grid.friction.n.linspace | list of 2"));
  EXPECT_TRUE(has_faults(of_exponent("{logspace: «[2, 2, 3]»}"),
                         "«»: sweep.grid.friction.n.logspace | different values"));
  EXPECT_TRUE(has_faults(of_exponent("«{spaced: [1, 2, 3]}»"), "«»: sweep.grid.friction.n | a map"));
  EXPECT_TRUE(has_faults(failure_of("{grid: {command.targets: «{linspace: [1, 2, 3]}»}}"),
                         "«»: sweep.grid.command.targets | a map"));
}

TEST(Sweep, ValuesOutOfRangeAreReportedAtTheSweep) {
  EXPECT_TRUE(has_faults(failure_of("{grid: {friction.n: {linspace: «[0, 2, 5]»}}}"),
                         "«»: sweep.grid.friction.n.linspace | is not allowed"));
}

TEST(Sweep, WordsListsAndDistributionsMayBeSwept) {
  const study::Study words = swept("{grid: {controller.anti_windup: [clamp, none]}}");
  EXPECT_EQ(words.points.axes[0].kind, study::SweepAxis::Kind::text);
  EXPECT_EQ(words.points.axes[0].texts, (Labels{"clamp", "none"}));
  EXPECT_EQ(study::study_trial(words, 1, 0).parameters.controller.anti_windup, loop::AntiWindup::none);

  const study::Study lists = swept("{grid: {command.targets: [[1], [{integers: [2, 9]}]]}}");
  EXPECT_EQ(lists.points.labels[1], "command.targets=[{integers: [2, 9]}]");
  EXPECT_EQ(lists.points.axes[0].name, "command.targets.0");
  EXPECT_EQ(lists.points.axes[0].numbers[0], 1);
  EXPECT_TRUE(std::isnan(lists.points.axes[0].numbers[1]));

  const study::Study cases =
      swept("{cases: {a: {friction.k1: {uniform: [100, 120]}}, b: {friction.k1: 90}}}");
  EXPECT_TRUE(std::isnan(cases.points.axes[1].numbers[0]));
  EXPECT_EQ(cases.points.axes[1].numbers[1], 90);
  EXPECT_GE(study::study_trial(cases, 0, 0).parameters.friction.uniform.k1, 100);
  EXPECT_EQ(study::study_trial(cases, 1, 0).parameters.friction.uniform.k1, 90);
}

TEST(Sweep, TruthValuesMayBeSweptLikeWords) {
  const study::Study study = swept("{grid: {verdict.stop: [false, true]}}");
  EXPECT_EQ(study.points.labels, (Labels{"verdict.stop=false", "verdict.stop=true"}));
  EXPECT_EQ(study.points.axes[0].kind, study::SweepAxis::Kind::text);
  EXPECT_EQ(study.points.axes[0].texts, (Labels{"false", "true"}));
  EXPECT_FALSE(study::study_trial(study, 0, 0).parameters.verdict.stop);
  EXPECT_TRUE(study::study_trial(study, 1, 0).parameters.verdict.stop);
  EXPECT_TRUE(has_faults(failure_of("{grid: {verdict.stop: {linspace: «[0, 1, 2]»}}}"),
                         "«»: sweep.grid.verdict.stop.linspace | is not allowed"));
  EXPECT_TRUE(
      has_faults(failure_of("{grid: {verdict.stop: [«0»]}}"), "«»: sweep.grid.verdict.stop.0 | truth value"));
}

TEST(Sweep, AnIndexChoosesAMove) {
  const study::Study study = swept("{grid: {command.targets.0: [7, 8]}}");
  EXPECT_EQ(study::study_trial(study, 1, 0).parameters.command.targets, std::vector<std::int64_t>{8});
  EXPECT_TRUE(has_faults(failure_of("{grid: {«command.targets.1»: [7]}}"),
                         "«»: sweep.grid.command.targets.1 | an index from 0 to 0"));
}

TEST(Sweep, AllPointsHaveTheSameNumberOfMoves) {
  EXPECT_TRUE(has_faults(failure_of("{cases: {a: {command.targets: «[1, 2]»}}}"),
                         "«»: sweep.cases.a.command.targets | list of 2 targets"));
}

TEST(Sweep, MistakesAreReportedWhereTheyStand) {
  EXPECT_TRUE(
      has_faults(failure_of("{grid: {«controler.ki»: [1]}}"), "«»: sweep.grid.controler.ki | controller.ki"));
  EXPECT_TRUE(has_faults(failure_of("{grid: {controller.ki: «[]»}}"),
                         "«»: sweep.grid.controller.ki | the list is empty"));
  EXPECT_TRUE(has_faults(failure_of("{grid: {controller.ki: «1»}}"), "«»: sweep.grid.controller.ki | '1'"));
  EXPECT_TRUE(has_faults(failure_of("{grid: {controller.ki: [0, 1, «0.0»]}}"),
                         "«»: sweep.grid.controller.ki.2 | duplicate"));
  EXPECT_TRUE(has_faults(failure_of("{grid: {controller.ki: {linspace: «[1, 1, 3]»}}}"),
                         "«»: sweep.grid.controller.ki.linspace | different values"));
  EXPECT_TRUE(has_faults(failure_of("{grid: {controller.ki: {logspace: [«0», 1, 3]}}}"),
                         "«»: sweep.grid.controller.ki.logspace.0 | greater than 0"));
  EXPECT_TRUE(has_faults(failure_of("{grid: {controller.ki: {linspace: [0, 1, «1»]}}}"),
                         "«»: sweep.grid.controller.ki.linspace.2 | from 2 to 1000000"));
  EXPECT_TRUE(has_faults(failure_of("{grid: {command.targets: [[1], [2]], «command.targets.0»: [3]}}"),
                         "«»: sweep.grid.command.targets.0 | is swept twice"));
  EXPECT_TRUE(has_faults(failure_of("{cases: {a: {command.targets: [1], «command.targets.0»: 2}}}"),
                         "«»: sweep.cases.a.command.targets.0 | is given twice"));
  EXPECT_TRUE(has_faults(failure_of("{cases: «[a]»}"), "«»: sweep.cases | a list"));
}

TEST(Sweep, CrossChecksNameTheSweptValue) {
  EXPECT_TRUE(has_faults(failure_of("{grid: {command.hold: [1, «0.01»]}}"),
                         "«»: verdict.dwell | longer than the hold\n"
                         "«»: verdict.window | longer than the hold"));
}

TEST(Sweep, TooManyPointsAreRefusedImmediately) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(has_faults(
      failure_of("«{grid: {controller.ki: {linspace: [0, 1, 1000]}, controller.kp: {linspace: [0, 1, 1000]}, "
                 "controller.kd: {linspace: [0, 1, 1000]}}}»"),
      "«»: sweep | too many design points"));
  EXPECT_TRUE(
      says(failure_of("{grid: {controller.ki: {linspace: [0, 1, 1000000000]}}}"), "from 2 to 1000000"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
}

TEST(Sweep, AMillionPointsAreUnderstood) {
  const study::Study study =
      swept("{grid: {controller.ki: {linspace: [0, 1, 1000]}, controller.kp: {linspace: [0, 1, 1000]}}}");
  EXPECT_EQ(study::point_count(study), 1'000'000);
  EXPECT_EQ(study::study_trial(study, 999'999, 9).parameters.controller.ki, 1.0);
  EXPECT_EQ(study::study_trial(study, 999'000, 9).parameters.controller.kp, 0.0);
}

TEST(Sweep, TrialsTimesPointsAreLimited) {
  EXPECT_THROW(
      study_of(minimal_manifest("sweep: {grid: {controller.ki: [0, 1]}}"), {"trials=9007199254740992"}),
      Failure);
  EXPECT_NO_THROW(study_of(minimal_manifest(), {"trials=9007199254740992"}));
}

TEST(Sweep, ObservationsOfACaseHoldAtAllItsPoints) {
  const study::Study study =
      swept("{grid: {controller.kp: [0, 1]}, cases: {a: {dac.bits: 10}, b: {dac.bits: 14}}}",
            "observed: {a: calm, \"a, controller.kp=1\": wild}\n");
  EXPECT_EQ(study.observed, (std::map<std::string, std::string>{{"a, controller.kp=0", "calm"},
                                                                {"a, controller.kp=1", "wild"}}));
}

// Sections inside one another, as far as the names of parameters go.

TEST(Sections, NestAsDeepAsParameterNames) {
  const study::Study study = study_of(extended_manifest());
  const trial::TrialParameters p = study::study_trial(study, 0, 0).parameters;
  EXPECT_EQ(p.encoder.fine_errors.eccentricity, 1e-5);
  EXPECT_EQ(p.encoder.fine_errors.noise, 0.1);
  EXPECT_EQ(p.encoder.coarse_errors.interpolation, 0.05);
  EXPECT_EQ(p.encoder.coarse_errors.interpolation_period, 2);
  EXPECT_EQ(p.dac.gain_error, 0.01);
  EXPECT_EQ(p.dac.nonlinearity, 0.5);
  EXPECT_EQ(p.dac.noise, 1e-5);
  EXPECT_GT(p.amplifier.bandwidth, 200);
  EXPECT_EQ(p.controller.coarse.kp, 1e-4);
  EXPECT_EQ(p.controller.coarse.encoder, loop::EncoderChoice::coarse);
  EXPECT_GE(p.controller.coarse.fine_within, 10);
  EXPECT_EQ(p.controller.coarse.coarse_beyond, 500);
  EXPECT_EQ(p.controller.coarse.fine_dwell, loop::CoarsePhaseParameters{}.fine_dwell);
  EXPECT_EQ(p.command.profile.velocity_limit, 0.5);
  EXPECT_GE(p.command.profile.jerk_limit, 1000);
  EXPECT_EQ(std::abs(p.initial.velocity), 0.01);
  EXPECT_NE(p.initial.integral, 0);
  EXPECT_EQ(p.initial.history.torque, 0.2);
}

TEST(Sections, NestedKeysAreSweptByTheirDottedNames) {
  const study::Study study = study_of(extended_manifest());
  ASSERT_EQ(study::point_count(study), 16);
  EXPECT_EQ(study.points.labels[11],
            "sliding, controller.coarse.kd=0, friction.model=spring, command.profile.shape=s_curve");
  const trial::TrialParameters p = study::study_trial(study, 11, 0).parameters;
  EXPECT_EQ(p.initial.mode, trial::InitialMode::slide);
  EXPECT_EQ(p.controller.coarse.kd, 0);
  EXPECT_EQ(p.friction.model, friction::FrictionModel::spring);
  EXPECT_EQ(p.command.profile.shape, loop::ReferenceShape::s_curve);
  EXPECT_EQ(study::study_trial(study, 12, 0).parameters.friction.model, friction::FrictionModel::presliding);
  EXPECT_EQ(study::study_trial(study, 12, 0).parameters.command.profile.shape, loop::ReferenceShape::step);
  EXPECT_EQ(study.points.axes.back().name, "command.profile.shape");
  EXPECT_EQ(study.points.axes.back().kind, study::SweepAxis::Kind::text);
  EXPECT_EQ(study.points.axes.back().texts[11], "s_curve");
}

TEST(Sections, AreCreatedByOverrides) {
  const study::Study study =
      study_of(minimal_manifest(), {"controller.coarse.coarse_beyond=1000", "controller.coarse.kd=2.0e-3",
                                    "dac.bits=14", "encoder.fine_errors.noise={uniform: [0, 1]}",
                                    "sweep.grid.controller.coarse.fine_within=[1, 2]"});
  EXPECT_EQ(study::study_trial(study, 0, 0).parameters.controller.coarse.kd, 2e-3);
  EXPECT_EQ(study::study_trial(study, 0, 0).parameters.dac.bits, 14);
  EXPECT_EQ(study::study_trial(study, 1, 0).parameters.controller.coarse.fine_within, 2);
  EXPECT_EQ(study.columns.inputs[0].name, "encoder.fine_errors.noise");
}

TEST(Sections, AreMapsInsideMaps) {
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("controller: {coarse: «3»}")), "«»: controller.coarse | '3'"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {coarse: «[kp, 1]»}")),
                         "«»: controller.coarse | a list"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {«coarse.kp»: 1}")),
                         "«»: controller.coarse.kp | nested maps"));
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("«plant.inertia»: 1")), "«»: plant.inertia | nested maps"));
  EXPECT_EQ(refusal_of(minimal_manifest("friction: {k1: {«kp»: 1}}")).find("m.yaml:«»: friction.k1.kp: "),
            0u);
}

TEST(Sections, UnknownKeysAreRefusedWithTheNearestKeyOfTheirSection) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {coarse: {«fine_witin»: 1}}")),
                         "«»: controller.coarse.fine_witin | fine_within"));
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("initial: {«histroy»: {}}")), "«»: initial.histroy | history"));
}

TEST(Sections, KeysOfAnotherSectionAreRefusedWithTheirPlace) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("friction: {«velocity_limit»: 1}")),
                         "«»: friction.velocity_limit | command.profile.velocity_limit"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("encoder: {«history»: {}}")),
                         "«»: encoder.history | initial.history"));
}

// initial.mode has this very name; but a letter is sooner forgotten than a section confused.
TEST(Sections, AMisspeltKeyIsSoughtInItsOwnSectionFirst) {
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("friction: {«mode»: coulomb}")), "«»: friction.mode | model"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(), {"friction.mode=x"}),
                         "--set friction.mode=x: friction.mode | model"));
}

TEST(Sections, WrongNamesInSweepsAndOverridesAreRefusedWithTheNearest) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("sweep: {grid: {«controller.coarse.kdd»: [1]}}")),
                         "«»: sweep.grid.controller.coarse.kdd | controller.coarse.kd"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(), {"initial.history.revesals=1"}),
                         "--set initial.history.revesals=1: initial.history.revesals | reversals"));
}

TEST(Sections, UnknownEnumerationWordsAreRefused) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("friction: {model: «coulumb»}")),
                         "«»: friction.model | 'coulumb'"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("initial: {mode: «{choice: [0, 1]}»}")),
                         "«»: initial.mode | '{choice: [0, 1]}'"));
}

// `correlation` in a manifest: what is read, and what is refused.

TEST(Correlations, AreReadFromTheList) {
  const study::Study study =
      study_of(minimal_manifest("friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n"
                                "correlation: [[friction.k2, friction.k1, 0.25]]\n"));
  ASSERT_EQ(study.correlations.size(), 1U);
  EXPECT_EQ(study::correlations_text(study.correlations), "friction.k2 and friction.k1 (0.25)");
}

TEST(Correlations, CanBeSwitchedOff) {
  const std::string drawn = "friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n";
  const study::Study off = study_of(
      minimal_manifest(drawn + "correlation: [[friction.k2, friction.k1, 0.25]]\n"), {"correlation=[]"});
  const study::Study without = study_of(minimal_manifest(drawn));
  EXPECT_TRUE(off.correlations.empty());
  EXPECT_EQ(study::study_trial(off, 0, 3).inputs, study::study_trial(without, 0, 3).inputs);
}

struct CorrelationRefusal {
  const char* lines;
  const char* message;
};

class RefusedCorrelations : public testing::TestWithParam<CorrelationRefusal> {};

TEST_P(RefusedCorrelations, MessageGivesTheReason) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(GetParam().lines)), GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    , RefusedCorrelations,
    testing::Values(
        CorrelationRefusal{"correlation: «0.5»", "«»: correlation | '0.5'"},
        CorrelationRefusal{"friction: {k1: {uniform: [90, 130]}}\ncorrelation: [«[friction.k1, 0.5]»]",
                           "«»: correlation.0 | list of 2"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}}\ncorrelation: [[friction.k1, «friction.k2», 0.5]]",
            "«»: correlation.0.1 | nearest known"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}}\ncorrelation: [«[friction.k1, friction.k1, 0.5]»]",
            "«»: correlation.0 | itself"},
        CorrelationRefusal{"friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n"
                           "correlation: [[friction.k1, friction.k2, «1»]]",
                           "«»: correlation.0.2 | greater than -1 and less than 1"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n"
            "correlation: [[friction.k1, friction.k2, 0.5], «[friction.k2, friction.k1, 0.1]»]",
            "«»: correlation.1 | duplicate"},
        CorrelationRefusal{"friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900], per: study}}\n"
                           "correlation: [[friction.k1, «friction.k2», 0.5]]",
                           "«»: correlation.0.1 | cannot be correlated"},
        CorrelationRefusal{"friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900], per: contact}}\n"
                           "correlation: [[friction.k1, «friction.k2», 0.5]]",
                           "«»: correlation.0.1 | cannot be correlated"},
        CorrelationRefusal{
            "machines: 2\nfriction: {k1: {uniform: [90, 130]}}\ninitial: {position: {uniform: [0, 6]}}\n"
            "correlation: «[[friction.k1, initial.position, 0.5]]»",
            "«»: correlation | per"},
        CorrelationRefusal{
            "friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}, beta: {uniform: [1.0e5, "
            "2.0e5]}}\n"
            "correlation: «[[friction.k1, friction.k2, 0.9], [friction.k2, friction.beta, 0.9]]»",
            "«»: correlation | positive definite"}));

TEST(Correlations, AreRefusedWithTheDesignSaltelli) {
  EXPECT_TRUE(has_faults(
      refusal_of(minimal_manifest("friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}}\n"
                                  "correlation: «[[friction.k1, friction.k2, 0.5]]»\n"),
                 {"design=saltelli", "trials=40"}),
      "«»: correlation | another design"));
}

TEST(Correlations, AnUnreadableValueIsNotReportedAsACorrelationError) {
  EXPECT_FALSE(says(refusal_of(minimal_manifest("friction: {k1: {uniform: [130, 90]}, k2: {uniform: [600, "
                                                "900]}}\ncorrelation: [[friction.k1, friction.k2, 0.5]]\n")),
                    "correlation"));
}

}  // namespace
}  // namespace zerocount::sections
