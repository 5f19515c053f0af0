#include "analysis/study_features.hpp"

#include <gtest/gtest.h>

namespace zerocount {
namespace {

TrialParameters parameters_with(void (*change)(TrialParameters&)) {
  TrialParameters parameters;
  change(parameters);
  return parameters;
}

TEST(StudyFeatures, OfThePapersLoopAreNone) {
  const StudyFeatures none = trial_features({});
  EXPECT_FALSE(none.open_loop || none.travel || none.phases || none.encoder_errors || none.final_error);
}

TEST(StudyFeatures, AreWhatTheParametersUse) {
  EXPECT_TRUE(trial_features(parameters_with([](auto& p) { p.command.torque.levels = {0.1}; })).open_loop);
  EXPECT_TRUE(trial_features(parameters_with([](auto& p) {
                p.command.profile.shape = ReferenceShape::trapezoidal;
              })).travel);
  EXPECT_TRUE(
      trial_features(parameters_with([](auto& p) { p.encoder.fine_errors.noise = 0.1; })).encoder_errors);
  EXPECT_TRUE(
      trial_features(parameters_with([](auto& p) { p.encoder.coarse_errors.missed = 1e-3; })).encoder_errors);
  EXPECT_TRUE(trial_features(parameters_with([](auto& p) {
                p.encoder.coarse_errors.eccentricity = 1e-6;
              })).encoder_errors);
  EXPECT_TRUE(trial_features(parameters_with([](auto& p) {
                p.encoder.fine_errors.interpolation = 0.2;
              })).encoder_errors);
}

TEST(StudyFeatures, MovesMayEndBesideTheirTargetsWithoutIntegralPreSlidingOrOnTheWay) {
  EXPECT_TRUE(trial_features(parameters_with([](auto& p) { p.controller.ki = 0.0; })).final_error);
  EXPECT_TRUE(trial_features(parameters_with([](auto& p) {
                p.friction.model = FrictionModel::coulomb;
              })).final_error);
  EXPECT_FALSE(
      trial_features(parameters_with([](auto& p) { p.friction.model = FrictionModel::spring; })).final_error);
  EXPECT_TRUE(trial_features(parameters_with([](auto& p) {
                p.command.profile.shape = ReferenceShape::s_curve;
              })).final_error);
}

TEST(StudyFeatures, OfAStudyAreThoseOfAnyPoint) {
  Study study = parse_study(
      "zerocount: 1\nname: two\nseed: 5\ntrials: 3\ncommand: {targets: [10], hold: 0.2}\n"
      "sweep: {grid: {controller.ki: [3.85e-5, 0]}}\n",
      "test");
  EXPECT_TRUE(study_features(study).final_error);
  EXPECT_FALSE(study_features(study).phases);
  study.trace_extras = {true, true, false};
  EXPECT_TRUE(study_features(study).travel);
  EXPECT_TRUE(study_features(study).phases);
  study.open_loop = true;
  EXPECT_TRUE(study_features(study).open_loop);
}

}  // namespace
}  // namespace zerocount
