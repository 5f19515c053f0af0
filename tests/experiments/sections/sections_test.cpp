// Sections inside one another, as far as the names of parameters go.
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sections {
namespace {

TEST(Sections, GoAsDeepAsTheNamesOfParameters) {
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

TEST(Sections, OfAnyDepthAreSweptByTheirDottedNames) {
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

TEST(Sections, AreMadeByOverrides) {
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
      has_faults(refusal_of(minimal_manifest("controller: {coarse: 3}")), "6:22: controller.coarse | '3'"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {coarse: [kp, 1]}")),
                         "6:22: controller.coarse | a list"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {coarse.kp: 1}")),
                         "6:14: controller.coarse.kp | nested maps"));
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("plant.inertia: 1")), "6:1: plant.inertia | nested maps"));
  EXPECT_EQ(refusal_of(minimal_manifest("friction: {k1: {kp: 1}}")).find("m.yaml:6:17: friction.k1.kp: "),
            0u);
}

TEST(Sections, UnknownKeysAreToldTheNearestOfTheirMap) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {coarse: {fine_witin: 1}}")),
                         "6:23: controller.coarse.fine_witin | fine_within"));
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("initial: {histroy: {}}")), "6:11: initial.histroy | history"));
}

TEST(Sections, KeysOfAnotherMapAreToldWhereTheyBelong) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("friction: {velocity_limit: 1}")),
                         "6:12: friction.velocity_limit | command.profile.velocity_limit"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("encoder: {history: {}}")),
                         "6:11: encoder.history | initial.history"));
}

// initial.mode has this very name; but a letter is sooner forgotten than a section confused.
TEST(Sections, KeysNearThoseOfTheirMapAreNotLookedForElsewhere) {
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("friction: {mode: coulomb}")), "6:12: friction.mode | model"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(), {"friction.mode=x"}),
                         "--set friction.mode=x: friction.mode | model"));
}

TEST(Sections, SweepsAndOverridesAreToldTheNearestDottedName) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("sweep: {grid: {controller.coarse.kdd: [1]}}")),
                         "6:16: sweep.grid.controller.coarse.kdd | controller.coarse.kd"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(), {"initial.history.revesals=1"}),
                         "--set initial.history.revesals=1: initial.history.revesals | reversals"));
}

TEST(Sections, WordsAreThoseOfTheTable) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("friction: {model: coulumb}")),
                         "6:19: friction.model | 'coulumb'"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("initial: {mode: {choice: [0, 1]}}")),
                         "6:17: initial.mode | '{choice: [0, 1]}'"));
}

}  // namespace
}  // namespace zerocount::sections
