// `stop` in a manifest: what is read, and what is refused.
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sections {
namespace {

TEST(Stop, MakesTrialsTheSizeOfABlock) {
  const study::Study study = study_of(minimal_manifest(
      "stop: {success_rate_halfwidth: 0.02, confidence: 0.9, min_trials: 20, max_trials: 500}"));
  const std::int64_t stated = study_of(minimal_manifest()).trials;
  ASSERT_TRUE(study.stop);
  EXPECT_EQ(study.stop->block, stated);
  EXPECT_EQ(study.stop->success_rate_halfwidth, 0.02);
  EXPECT_EQ(study.stop->confidence, 0.9);
  EXPECT_EQ(study.stop->min_trials, 20);
  EXPECT_EQ(study.trials, 500);
}

TEST(Stop, HasADefaultForTheConfidenceAndNoLeastNumber) {
  const study::Study study =
      study_of(minimal_manifest("stop: {success_rate_halfwidth: 0.02, max_trials: 500}"));
  ASSERT_TRUE(study.stop);
  EXPECT_EQ(study.stop->confidence, 0.95);
  EXPECT_EQ(study.stop->min_trials, 1);
  EXPECT_FALSE(study_of(minimal_manifest()).stop);
}

TEST(Stop, LeavesTheDrawsOfATrialAsTheyAre) {
  const std::string random = "friction: {k1: {uniform: [90, 130]}}\n";
  const study::Study plain = study_of(minimal_manifest(random));
  const study::Study stopping =
      study_of(minimal_manifest(random + "stop: {success_rate_halfwidth: 0.02, max_trials: 500}"));
  EXPECT_EQ(study::study_trial(plain, 0, 3).inputs, study::study_trial(stopping, 0, 3).inputs);
}

TEST(Stop, CanBeChangedByOverrides) {
  const study::Study study = study_of(
      minimal_manifest("stop: {success_rate_halfwidth: 0.02, max_trials: 500}"), {"stop.max_trials=40"});
  EXPECT_EQ(study.trials, 40);
}

struct StopRefusal {
  const char* line;
  const char* faults;
};

class RefusedStop : public testing::TestWithParam<StopRefusal> {};

TEST_P(RefusedStop, SaysWhy) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(GetParam().line)), GetParam().faults));
}

INSTANTIATE_TEST_SUITE_P(
    , RefusedStop,
    testing::Values(StopRefusal{"stop: 3", "6:7: stop | '3'"},
                    StopRefusal{"stop: {max_trials: 500}", "6:7: stop.success_rate_halfwidth | missing"},
                    StopRefusal{"stop: {success_rate_halfwidth: 0.02}", "6:7: stop.max_trials | missing"},
                    StopRefusal{"stop: {success_rate_halfwidth: 0.02, max_trails: 500, max_trials: 500}",
                                "6:38: stop.max_trails | max_trials"},
                    StopRefusal{"stop: {success_rate_halfwidth: 0.5, max_trials: 500}",
                                "6:32: stop.success_rate_halfwidth | greater than 0 and less than 0.5"},
                    StopRefusal{"stop: {success_rate_halfwidth: 0.1, max_trials: 5}",
                                "6:49: stop.max_trials | at least 10"},
                    StopRefusal{"stop: {success_rate_halfwidth: 0.1, max_trials: 50, min_trials: 60}",
                                "6:65: stop.min_trials | at most 50"},
                    StopRefusal{"design: sobol\nstop: {success_rate_halfwidth: 0.1, max_trials: 50}",
                                "7:7: stop | monte_carlo"}));

}  // namespace
}  // namespace zerocount::sections
