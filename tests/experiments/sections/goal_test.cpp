// `goal` and `verdict.bands` in a manifest: what is read, and what is refused.
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::sections {
namespace {

std::vector<std::int64_t> bands_of(const study::Study& study) {
  const std::span<const std::int64_t> bands = study.features.bands.values();
  return {bands.begin(), bands.end()};
}

TEST(Bands, AreZeroAndOneCountByDefault) {
  EXPECT_EQ(bands_of(study_of(minimal_manifest())), (std::vector<std::int64_t>{0, 1}));
}

TEST(Bands, ReachTheTrials) {
  const study::Study study = study_of(minimal_manifest("verdict: {bands: [0, 3, 10]}"));
  EXPECT_EQ(bands_of(study), (std::vector<std::int64_t>{0, 3, 10}));
  const trial::ErrorBands bands = study::study_trial(study, 0, 0).parameters.verdict.bands;
  EXPECT_EQ(bands.count, 3U);
  EXPECT_EQ(bands.limits[2], 10);
}

TEST(Goal, HasADefaultForBandAndConfidence) {
  const study::Study study = study_of(minimal_manifest("goal: {within: 0.1, moves: 0.9}"));
  ASSERT_EQ(study.goals.size(), 1U);
  EXPECT_EQ(study.goals[0].band, 0);
  EXPECT_EQ(study.goals[0].within.time, 0.1);
  EXPECT_FALSE(study.goals[0].within.after_profile);
  EXPECT_EQ(study.goals[0].moves, 0.9);
  EXPECT_FALSE(study.goals[0].machines);
  EXPECT_EQ(study.goals[0].confidence, 0.95);
  EXPECT_TRUE(study_of(minimal_manifest()).goals.empty());
}

TEST(Goal, TimeCountsFromTheEndOfTheProfile) {
  const study::Study study = study_of(minimal_manifest("goal: {after_profile: 0.1, moves: 0.9}"));
  EXPECT_DOUBLE_EQ(study.goals[0].within.from_start(0.25), 0.35);
}

TEST(Goal, IsAboutTheMassThatClosesTheLoopUnlessGiven) {
  using enum motion::EncoderPlace;
  for (const bool at_load : {false, true}) {
    for (const char* const of : {"", ", of: motor", ", of: load"}) {
      const study::Study study = study_of(
          minimal_manifest(fmt::format("goal: {{tolerance: 1.0e-6, within: 0.1, moves: 0.9{}}}\n"
                                       "plant: {{load: {{inertia: 1, stiffness: 1.0e+4, encoder: {}}}}}",
                                       of, at_load ? "load" : "motor")));
      const study::Goal& goal = study.goals[0];
      const bool of_load = std::string_view(of).empty() ? at_load : std::string_view(of).ends_with("load");
      EXPECT_EQ(goal.of, of_load ? load : motor);
      EXPECT_EQ(goal.of_other_mass, of_load != at_load);
      EXPECT_EQ(study.features.load_error, !at_load)
          << "the load's proportion stands beside that of the motor";
      EXPECT_EQ(study.features.motor_error, at_load && !of_load);
      EXPECT_EQ(goal.beside_load, !of_load);
    }
  }
  EXPECT_FALSE(study_of(minimal_manifest("goal: {tolerance: 1.0e-6, within: 0.1, moves: 0.9}")).goals[0].of);
}

TEST(Goal, AddsItsBandToTheSortedBands) {
  const std::string goal = "goal: {band: 2, within: 0.1, moves: 0.9}\n";
  EXPECT_EQ(bands_of(study_of(minimal_manifest(goal))), (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(bands_of(study_of(minimal_manifest(goal + "verdict: {bands: [1, 5]}"))),
            (std::vector<std::int64_t>{1, 2, 5}));
  EXPECT_EQ(bands_of(study_of(minimal_manifest(goal + "verdict: {bands: [2]}"))),
            (std::vector<std::int64_t>{2}));
}

TEST(Goals, HaveNamesMovesAndLimits) {
  const study::Study study =
      study_of(minimal_manifest("goals:\n"
                                "  large: {on: [0], tolerance: 2.0e-6, within: 0.1, moves: 0.9, limits: "
                                "{overshoot: 20, \"band_exits[3]\": 1}}\n"
                                "  small: {band: 3, within: 0.05, moves: 0.8}\n"));
  ASSERT_EQ(study.goals.size(), 2U);
  EXPECT_EQ(study.goals[0].name, "large");
  EXPECT_EQ(study.goals[0].on, (std::vector<std::int64_t>{0}));
  EXPECT_EQ(study.goals[0].tolerance, 2.0e-6);
  ASSERT_EQ(study.goals[0].limits.size(), 2U);
  EXPECT_EQ(study.goals[0].limits[1].measure, "band_exits[3]");  // the band of the other goal
  EXPECT_EQ(study.goals[1].name, "small");
  EXPECT_EQ(bands_of(study), (std::vector<std::int64_t>{0, 1, 3}));
  EXPECT_EQ(study.features.tolerances.count, 1U);
  EXPECT_TRUE(study.features.position_error);
}

TEST(Goals, MayHaveDifferentTolerances) {
  const study::Study study =
      study_of(minimal_manifest("goal: {tolerance: 2.0e-6, within: 0.1, moves: 0.9, limits: "
                                "{\"tolerance_settling_time[1.0e-5]\": 0.05, "
                                "\"tolerance_settling_time[0.000001]\": 0.2}}"));
  EXPECT_TRUE(std::ranges::equal(study.features.tolerances.values(), std::vector{1e-6, 2e-6, 1e-5}));
  ASSERT_EQ(study.goals[0].limits.size(), 2U);
  EXPECT_EQ(study.goals[0].limits[0].measure, "tolerance_settling_time[1e-05]");  // as in files
  EXPECT_EQ(study.goals[0].limits[1].measure, "tolerance_settling_time[1e-06]");
}

TEST(Goals, MeasureThePositionOnlyIfRequired) {
  const auto measures_position = [](const char* goal) {
    const study::Study study = study_of(minimal_manifest(goal));
    return study::study_trial(study, 0, 0).parameters.verdict.position_error;
  };
  EXPECT_FALSE(measures_position("goal: {within: 0.1, moves: 0.9, limits: {overshoot: 3}}"));
  EXPECT_TRUE(measures_position("goal: {within: 0.1, moves: 0.9, limits: {true_overshoot: 3}}"));
  EXPECT_TRUE(measures_position("goal: {tolerance: 1.0e-6, within: 0.1, moves: 0.9}"));
  EXPECT_TRUE(measures_position(
      "goal: {within: 0.1, moves: 0.9, limits: {\"tolerance_settling_time[1.0e-6]\": 0.1}}"));
}

struct GoalRefusal {
  const char* lines;
  const char* faults;
};

/// Manifest text of a goal that has limits for more tolerances than a study may have.
const char* nine_tolerances() {
  static const std::string goal = [] {
    std::string limits;
    for (int i = 1; i <= 9; ++i)
      limits +=
          fmt::format("{}\"tolerance_settling_time[{}]\": {}", i == 1 ? "" : ", ", i, i < 9 ? "1" : "«1»");
    return "goal: {within: 0.1, moves: 0.9, limits: {" + limits + "}}";
  }();
  return goal.c_str();
}

class RefusedGoal : public testing::TestWithParam<GoalRefusal> {};

TEST_P(RefusedGoal, MessageGivesTheReason) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(GetParam().lines)), GetParam().faults));
}

INSTANTIATE_TEST_SUITE_P(
    , RefusedGoal,
    testing::Values(
        GoalRefusal{"goal: «3»", "«»: goal | '3'"},
        GoalRefusal{"goal: «{within: 0.1}»", "«»: goal.moves | missing"},
        GoalRefusal{"goal: «{moves: 0.9}»", "«»: goal.within | missing"},
        GoalRefusal{"goal: {within: 0.1, after_profile: «0.1», moves: 0.9}", "«»: goal.after_profile | too"},
        GoalRefusal{"goal: {after_profile: «9», moves: 0.9}",
                    "«»: goal.after_profile | longer than the hold"},
        GoalRefusal{
            "goal: «{after_profile: 0.1, moves: 0.9}»\nsweep: {grid: {command.profile.shape: [step, «sine»]}}",
            "«1»: goal | no end\n«2»: command.hold | two periods"},
        GoalRefusal{"goal: {after_profile: «0», moves: 0.9}", "«»: goal.after_profile | '0'"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, of: «load»}", "«»: goal.of | one mass"},
        GoalRefusal{
            "goal: {within: 0.1, moves: 0.9, of: «load»}\nplant: {load: {inertia: 1, stiffness: 1.0e+4}}",
            "«»: goal.of | a band"},
        GoalRefusal{"goal: {within: 0.1, moves: «1»}", "«»: goal.moves | '1'"},
        GoalRefusal{"goal: {within: «9», moves: 0.9}", "«»: goal.within | longer than the hold"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, machines: «0.9»}",
                    "«»: goal.machines | without machines"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, band: «-1»}", "«»: goal.band | '-1'"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, «bond»: 1}", "«»: goal.bond | unknown key"},
        GoalRefusal{"verdict: {bands: [1, «1»]}", "«»: verdict.bands.1 | not above 1"},
        GoalRefusal{"verdict: {bands: [«0.5»]}", "«»: verdict.bands.0 | '0.5'"},
        GoalRefusal{"verdict: {bands: «[]»}", "«»: verdict.bands | the list is empty"},
        GoalRefusal{"verdict: {bands: «[0, 1, 2, 3, 4, 5, 6, 7, 8]»}", "«»: verdict.bands | a list of 9"},
        GoalRefusal{"verdict: {bands: [0, 1, 2, 3, 4, 5, 6, 7]}\ngoal: «{band: 9, within: 0.1, moves: 0.9}»",
                    "«»: goal | one too many"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9}\ngoals: «{a: {within: 0.1, moves: 0.9}}»",
                    "«»: goals | `goal`"},
        GoalRefusal{"goals: «{}»", "«»: goals | no goal"},
        GoalRefusal{"goals: {a: {within: 0.1, moves: «2»}}", "«»: goals.a.moves | '2'"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, tolerance: «0»}", "«»: goal.tolerance | '0'"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, tolerance: 1.0e-6, band: «1»}",
                    "«»: goal.band | tolerance"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, on: [«7»]}", "«»: goal.on.0 | '7'"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, on: [0, «0»]}", "«»: goal.on.1 | twice"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, on: «[]»}", "«»: goal.on | empty"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, limits: {overshot: «1»}}",
                    "«»: goal.limits.overshot | no measure"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, limits: {\"tolerance_settling_time[0]\": «1»}}",
                    "«»: goal.limits.tolerance_settling_time[0] | above 0"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, limits: {tolerance_settling_time: «1»}}",
                    "«»: goal.limits.tolerance_settling_time | no measure"},
        GoalRefusal{nine_tolerances(), "«»: goal.limits.tolerance_settling_time[9] | one too many"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, limits: {rest_error_rms: «1»}}",
                    "«»: goal.limits.rest_error_rms | not measured"},
        GoalRefusal{"goal: {within: 0.1, moves: 0.9, limits: {overshoot: «-1»}}",
                    "«»: goal.limits.overshoot | '-1'"},
        GoalRefusal{"sweep: {grid: {«verdict.bands»: [[0], [1]]}}", "«»: sweep.grid.verdict.bands | swept"}));

// `stop` in a manifest: what is read, and what is refused.

TEST(Stop, MakesTrialsTheBlockSize) {
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

TEST(Stop, HasADefaultConfidenceAndNoMinimum) {
  const study::Study study =
      study_of(minimal_manifest("stop: {success_rate_halfwidth: 0.02, max_trials: 500}"));
  ASSERT_TRUE(study.stop);
  EXPECT_EQ(study.stop->confidence, 0.95);
  EXPECT_EQ(study.stop->min_trials, 1);
  EXPECT_FALSE(study_of(minimal_manifest()).stop);
}

TEST(Stop, DoesNotChangeTheDraws) {
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

TEST_P(RefusedStop, MessageGivesTheReason) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(GetParam().line)), GetParam().faults));
}

INSTANTIATE_TEST_SUITE_P(
    , RefusedStop,
    testing::Values(StopRefusal{"stop: «3»", "«»: stop | '3'"},
                    StopRefusal{"stop: «{max_trials: 500}»", "«»: stop.success_rate_halfwidth | missing"},
                    StopRefusal{"stop: «{success_rate_halfwidth: 0.02}»", "«»: stop.max_trials | missing"},
                    StopRefusal{"stop: {success_rate_halfwidth: 0.02, «max_trails»: 500, max_trials: 500}",
                                "«»: stop.max_trails | max_trials"},
                    StopRefusal{"stop: {success_rate_halfwidth: «0.5», max_trials: 500}",
                                "«»: stop.success_rate_halfwidth | greater than 0 and less than 0.5"},
                    StopRefusal{"stop: {success_rate_halfwidth: 0.1, max_trials: «5»}",
                                "«»: stop.max_trials | at least 10"},
                    StopRefusal{"stop: {success_rate_halfwidth: 0.1, max_trials: 50, min_trials: «60»}",
                                "«»: stop.min_trials | at most 50"},
                    StopRefusal{"design: sobol\nstop: «{success_rate_halfwidth: 0.1, max_trials: 50}»",
                                "«»: stop | monte_carlo"}));

}  // namespace
}  // namespace zerocount::sections
