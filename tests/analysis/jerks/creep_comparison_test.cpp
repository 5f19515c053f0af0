#include "analysis/jerks/creep_comparison.hpp"

#include "experiments/manifest/load_study.hpp"
#include "tests/support/test.hpp"

namespace zerocount::jerks {
namespace {

constexpr double sample_time = 1.0 / 2000.0;

study::Study fig8(const std::vector<std::string>& overrides = {}) {
  return manifest::load_study(std::string(ZEROCOUNT_MANIFESTS) + "/paper-fig8.yaml", overrides);
}

TEST(CreepComparison, CreepAtConstantTorqueForetellsTheJerksOfFigure8) {
  const CreepComparison comparison = compare_with_creep(fig8(), 0, 12);
  EXPECT_EQ(comparison.not_applicable, "");
  EXPECT_EQ(comparison.trials, 12);
  EXPECT_EQ(comparison.unsteady, 0);
  const CreepAgreement agreement = agreement_of(comparison, sample_time);
  EXPECT_GT(agreement.ended, 50);
  EXPECT_EQ(agreement.predicted, agreement.ended);
  EXPECT_EQ(agreement.lasting, 12);  // the last wait of each trial
  EXPECT_EQ(agreement.lasting_predicted, 12);
  EXPECT_LT(agreement.median_deviation, sample_time);  // a jerk shows at the sample after the crossing
}

TEST(CreepComparison, WaitsFollowEachOther) {
  const CreepComparison comparison = compare_with_creep(fig8(), 0, 5);
  std::int64_t trial = -1;
  double last = 0.0;
  for (const CreepWait& wait : comparison.waits) {
    if (wait.trial != trial) {
      EXPECT_TRUE(wait.first);
      last = 0.0;
      trial = wait.trial;
    }
    EXPECT_GT(wait.since, last);
    EXPECT_GE(wait.end, wait.since);
    EXPECT_TRUE(std::isnan(wait.onset) || wait.onset == wait.end);
    last = wait.end;
  }
  EXPECT_EQ(trial, 4);
}

TEST(CreepComparison, APredictionThatIsATenthOffIsNotForetold) {
  CreepComparison comparison = compare_with_creep(fig8(), 0, 12);
  for (CreepWait& wait : comparison.waits) wait.predicted = wait.since + 1.1 * (wait.predicted - wait.since);
  const CreepAgreement agreement = agreement_of(comparison, sample_time);
  EXPECT_LT(agreement.predicted, agreement.ended / 2);
}

TEST(CreepComparison, HoldsAgainAfterEachMove) {
  const CreepComparison comparison =
      compare_with_creep(fig8({"command.targets=[30, 12, -25]", "command.hold=1.5"}), 0, 6);
  const CreepAgreement agreement = agreement_of(comparison, sample_time);
  bool later_move = false, down = false;
  for (const CreepWait& wait : comparison.waits) {
    later_move = later_move || (wait.move > 0 && !std::isnan(wait.onset));
    down = down || (wait.move == 2 && !std::isnan(wait.onset));
  }
  EXPECT_TRUE(later_move);
  EXPECT_TRUE(down);
  EXPECT_EQ(agreement.predicted, agreement.ended);
  EXPECT_EQ(agreement.lasting_predicted, agreement.lasting);
}

TEST(CreepComparison, SaysWhyItDoesNotApply) {
  EXPECT_EQ(compare_with_creep(fig8({"friction.model=spring"}), 0, 3).not_applicable,
            "the friction does not creep");
  EXPECT_EQ(compare_with_creep(fig8({"dac.noise=1e-5"}), 0, 3).not_applicable, "the converter has noise");
  EXPECT_EQ(compare_with_creep(fig8({"encoder.fine_errors.noise=0.1"}), 0, 3).not_applicable,
            "the encoder has errors");
  EXPECT_EQ(compare_with_creep(fig8(), 0, 0).trials, 0);
}

}  // namespace
}  // namespace zerocount::jerks
