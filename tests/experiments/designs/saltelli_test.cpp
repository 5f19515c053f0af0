#include "experiments/designs/saltelli.hpp"

#include "core/failure/failure.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::designs {
namespace {

constexpr std::uint64_t second_sample = std::uint64_t{1} << 55;

// Five factors: a real value, a whole one, a choice, a target, and noise.
const std::string five_factors =
    "friction: {k1: {uniform: [100, 120]}, k2: {lognormal: {median: 700, cv: 0.1}}}\n"
    "controller: {delay: {choice: [0, 1, 2]}}\n"
    "encoder: {fine_errors: {noise: 0.1}}\n";

study::Study five_factor_study(const std::string& design, const std::string& trials) {
  return study_of(manifest_commanding("{targets: [{integers: [1, 1000]}]}", five_factors),
                  {"design=" + design, "trials=" + trials});
}

TEST(Saltelli, ARowIsAThenBThenAWithEachFactorFromB) {
  const std::vector<std::vector<std::uint64_t>> row_seven{
      {7, 7, 7},
      {second_sample + 7, second_sample + 7, second_sample + 7},
      {second_sample + 7, 7, 7},
      {7, second_sample + 7, 7},
      {7, 7, second_sample + 7},
  };
  for (std::uint64_t place = 0; place < 5; ++place) {
    for (std::size_t factor = 0; factor < 3; ++factor) {
      EXPECT_EQ(saltelli_source(7 * 5 + place, factor, 3), row_seven[place][factor]);
    }
  }
}

TEST(Saltelli, AIsTheMonteCarloTrialOfTheSameNumber) {
  const study::Study saltelli = five_factor_study("saltelli", "700");
  const study::Study monte_carlo = five_factor_study("monte_carlo", "700");
  for (std::int64_t row = 0; row < 100; ++row) {
    const study::StudyTrial of_row = study::study_trial(saltelli, 0, 7 * row);
    const study::StudyTrial alone = study::study_trial(monte_carlo, 0, row);
    EXPECT_EQ(of_row.inputs, alone.inputs);
    EXPECT_EQ(of_row.parameters.randomness.trial, alone.parameters.randomness.trial);
  }
}

TEST(Saltelli, EachOtherTrialOfARowChangesItsFactorAlone) {
  const study::Study study = five_factor_study("saltelli", "7000");
  ASSERT_EQ(study.factors, (std::vector<std::string>{"friction.k1", "friction.k2", "controller.delay",
                                                     "command.targets.0", "within_trial"}));
  // The factors' values in the trial, the noise's as the number that it is drawn from.
  const auto values = [&](std::int64_t index) {
    const study::StudyTrial trial = study::study_trial(study, 0, index);
    std::vector<double> all = trial.inputs;
    all.push_back(static_cast<double>(trial.parameters.randomness.trial));
    return all;
  };
  std::vector<int> differing(5, 0);
  for (std::int64_t row = 0; row < 1000; ++row) {
    const std::vector<double> a = values(7 * row);
    const std::vector<double> b = values(7 * row + 1);
    for (std::size_t factor = 0; factor < 5; ++factor) {
      std::vector<double> expected = a;
      expected[factor] = b[factor];
      EXPECT_EQ(values(7 * row + 2 + static_cast<std::int64_t>(factor)), expected);
      differing[factor] += a[factor] != b[factor];
    }
  }
  EXPECT_EQ(differing[0], 1000);
  EXPECT_EQ(differing[1], 1000);
  EXPECT_NEAR(differing[2], 667, 75);
  EXPECT_NEAR(differing[3], 999, 10);
  EXPECT_EQ(differing[4], 1000);
}

TEST(Saltelli, MoreTrialsLeaveTheFirstOnesAlone) {
  const study::Study few = five_factor_study("saltelli", "7");
  const study::Study many = five_factor_study("saltelli", "7000000");
  for (std::int64_t i = 0; i < 7; ++i) {
    EXPECT_EQ(study::study_trial(few, 0, i).inputs, study::study_trial(many, 0, i).inputs);
  }
}

TEST(Saltelli, AllPointsHaveTheSameRowsWhateverIsDrawnAtThem) {
  const study::Study study =
      study_of(minimal_manifest(
                   "friction: {k1: {uniform: [100, 120]}}\n"
                   "sweep: {cases: {a: {}, b: {friction.k1: 110, friction.k2: {uniform: [600, 800]}}}}\n"),
               {"design=saltelli", "trials=40"});
  ASSERT_EQ(study.factors, (std::vector<std::string>{"friction.k1", "friction.k2"}));
  const std::size_t k2 = column_of(study, "friction.k2");
  for (std::int64_t row = 0; row < 10; ++row) {
    const double of_a = study::study_trial(study, 1, 4 * row).inputs[k2];
    EXPECT_EQ(study::study_trial(study, 1, 4 * row + 2).inputs[k2], of_a) << "k1 changes";
    EXPECT_NE(study::study_trial(study, 1, 4 * row + 3).inputs[k2], of_a) << "k2 changes";
    EXPECT_EQ(study::study_trial(study, 0, 4 * row + 3).inputs[k2],
              study::study_trial(study, 0, 0).inputs[k2]);
  }
}

TEST(Saltelli, AProfileIsNoFactorAndThePlaceOnItIs) {
  const study::Study study =
      study_of(minimal_manifest("friction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: 0.2}}}\n"
                                "initial: {position: {uniform: [0, 6]}}\n"),
               {"design=saltelli", "trials=6"});
  EXPECT_EQ(study.factors, std::vector<std::string>{"initial.position"});
  EXPECT_NE(study::study_trial(study, 0, 0).inputs, study::study_trial(study, 0, 1).inputs);
}

TEST(Saltelli, RandomHistoriesAndMissedCountsAreDrawnWithinTrials) {
  const std::vector<std::string> noisy{
      "initial: {history: {reversals: 3, torque: 0.1}}\n", "encoder: {fine_errors: {missed: 0.01}}\n",
      "encoder: {coarse_errors: {noise: {uniform: [0, 1]}}}\n", "dac: {noise: 1.0e-5}\n"};
  for (const std::string& text : noisy) {
    const study::Study study = study_of(minimal_manifest(text), {"design=saltelli", "trials=12"});
    ASSERT_FALSE(study.factors.empty()) << text;
    EXPECT_EQ(study.factors.back(), study::within_trial_factor) << text;
  }
}

TEST(Saltelli, OtherDesignsListNoFactors) {
  EXPECT_TRUE(five_factor_study("monte_carlo", "7").factors.empty());
}

std::string refusal(const std::string& text, const std::vector<std::string>& overrides) {
  try {
    study_of(text, overrides);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_input);
    return failure.what();
  }
  return "accepted";
}

TEST(Saltelli, TrialsThatAreNoWholeRowsAreToldTheNearestNumbers) {
  const std::string text = minimal_manifest("friction: {k1: {uniform: [100, 120]}}\ndesign: saltelli\n");
  EXPECT_TRUE(has_faults(refusal(text, {}), "4:9: trials | 9 or 12"));
  EXPECT_TRUE(says(refusal(text, {"trials=2"}), "expected a multiple of 3, such as 3"));
  EXPECT_EQ(refusal(text, {"trials=12"}), "accepted");
}

TEST(Saltelli, ADesignWithoutAnythingDrawnIsRefused) {
  EXPECT_TRUE(
      has_faults(refusal(minimal_manifest("design: saltelli\n"), {}), "6:9: design | nothing is drawn"));
}

}  // namespace
}  // namespace zerocount::designs
