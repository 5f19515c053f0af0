#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "experiments/manifest/load_study.hpp"

namespace zerocount::study {
namespace {

StudyFeatures features_with(const std::string& more, int seed = 5) {
  return manifest::parse_study(fmt::format("zerocount: 1\nname: features\nseed: {}\ntrials: 3\n"
                                           "command: {{targets: [10], hold: 0.2}}\n{}\n",
                                           seed, more),
                               "test")
      .features;
}

bool has_encoder_errors(const std::string& more, int seed = 5) {
  return features_with(more, seed).encoder_errors;
}

bool has_final_error(const std::string& more, int seed = 5) {
  return features_with(more, seed).final_error;
}

TEST(StudyFeatures, OfThePapersLoopAreNone) {
  const StudyFeatures none = features_with("");
  EXPECT_FALSE(none.open_loop || none.travel || none.phases || none.encoder_errors || none.final_error ||
               none.stopping || none.dependent_trials);
}

TEST(StudyFeatures, EncoderErrorsAreThoseOfEitherEncoder) {
  for (const std::string encoder : {"fine_errors", "coarse_errors"}) {
    for (const std::string error : {"eccentricity", "interpolation", "noise", "missed"}) {
      EXPECT_TRUE(has_encoder_errors(fmt::format("encoder: {{{}: {{{}: 1.0e-3}}}}", encoder, error)));
      EXPECT_FALSE(has_encoder_errors(fmt::format("encoder: {{{}: {{{}: 0}}}}", encoder, error)));
    }
  }
}

TEST(StudyFeatures, MovesMayEndBesideTheirTargetsWithoutIntegralOrPreSliding) {
  EXPECT_TRUE(has_final_error("controller: {ki: 0}"));
  EXPECT_TRUE(has_final_error("friction: {model: coulomb}"));
  EXPECT_FALSE(has_final_error("friction: {model: spring}"));
  EXPECT_FALSE(has_final_error("friction: {model: none}"));
}

TEST(StudyFeatures, OfAStudyAreThoseOfAnyPoint) {
  EXPECT_TRUE(has_final_error("sweep: {grid: {controller.ki: [3.85e-5, 0]}}"));
  EXPECT_TRUE(has_final_error("sweep: {grid: {friction.model: [presliding, spring, coulomb]}}"));
  EXPECT_TRUE(has_encoder_errors("sweep: {cases: {a: {}, b: {encoder.coarse_errors.noise: 0.1}}}"));
}

TEST(StudyFeatures, StoppingIsThatOfAnyPoint) {
  EXPECT_TRUE(features_with("verdict: {stop: true}").stopping);
  EXPECT_FALSE(features_with("verdict: {stop: false}").stopping);
  EXPECT_TRUE(features_with("sweep: {grid: {verdict.stop: [false, true]}}").stopping);
}

TEST(StudyFeatures, TrialsOfASaltelliDesignAreDependent) {
  const std::string drawn = "friction: {k1: {uniform: [100, 120]}}\n";
  EXPECT_TRUE(features_with(drawn + "design: saltelli").dependent_trials);
  EXPECT_FALSE(features_with(drawn + "design: sobol").dependent_trials);
}

// One seed draws an error in the first trial, another does not: the columns are the same.
TEST(StudyFeatures, DoNotDependOnWhatIsDrawn) {
  for (int seed = 1; seed <= 20; ++seed) {
    EXPECT_TRUE(has_encoder_errors("encoder: {fine_errors: {noise: {choice: [0, 0.3]}}}", seed)) << seed;
    EXPECT_FALSE(has_encoder_errors("encoder: {fine_errors: {noise: {choice: [0, 0]}}}", seed)) << seed;
    EXPECT_TRUE(has_final_error("controller: {ki: {choice: [3.85e-5, 0]}}", seed)) << seed;
    EXPECT_FALSE(has_final_error("controller: {ki: {choice: [3.85e-5, 9.45e-5]}}", seed)) << seed;
  }
}

TEST(StudyFeatures, LongMovesMayEndBesideTheirTargets) {
  EXPECT_TRUE(has_final_error("controller: {coarse: {coarse_beyond: 1000}}"));
  EXPECT_TRUE(has_final_error("sweep: {grid: {command.profile.shape: [trapezoidal]}}"));
}

}  // namespace
}  // namespace zerocount::study
