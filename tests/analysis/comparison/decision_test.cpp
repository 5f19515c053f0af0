// Verdicts from numbers that are made up.
#include "analysis/comparison/comparison.hpp"
#include "analysis/comparison/point_judgements.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

comparison::Judgement measure(double effect, statistics::ConfidenceInterval bounds, double p) {
  comparison::Judgement one;
  one.measure = "success_rate";
  one.effect = effect;
  one.bounds = bounds;
  one.margin = 0.02;
  one.p = p;
  one.improvement_p = 1.0 - p;
  return one;
}

comparison::Judgement decided(const comparison::Judgement& one) {
  comparison::PointComparison point;
  point.baseline_trials = point.current_trials = 1000;
  point.judgements = {one};
  comparison::decide(comparison::judgements_of({&point, 1}), {});
  return point.judgements.front();
}

TEST(Verdict, PassesWhereTheBoundIsWithinTheMargin) {
  EXPECT_EQ(decided(measure(0.0, {-0.01, 0.01}, 0.5)).verdict, comparison::GateVerdict::passed);
  EXPECT_EQ(decided(measure(0.015, {0.011, 0.019}, 1e-9)).verdict,
            comparison::GateVerdict::passed);  // significant, but small
  EXPECT_EQ(decided(measure(-0.5, {-0.6, -0.4}, 1.0)).verdict, comparison::GateVerdict::passed);
}

TEST(Verdict, FailsWhereTheChangeIsSignificantAndBeyondTheMargin) {
  EXPECT_EQ(decided(measure(0.05, {0.03, 0.07}, 1e-6)).verdict, comparison::GateVerdict::regression);
  EXPECT_EQ(decided(measure(0.05, {-0.01, 0.12}, 0.2)).verdict, comparison::GateVerdict::inconclusive);
  EXPECT_EQ(decided(measure(0.018, {0.01, 0.026}, 1e-6)).verdict, comparison::GateVerdict::inconclusive);
}

// The effect, its bounds and p against a change for the worse, and what is shown by them with a margin of 2
// %.
TEST(Verdict, SaysInWhichDirectionAMeasureChanged) {
  using comparison::ChangeVerdict;
  EXPECT_EQ(decided(measure(0.05, {0.03, 0.07}, 1e-6)).change, ChangeVerdict::worse);
  EXPECT_EQ(decided(measure(-0.05, {-0.07, -0.03}, 1.0 - 1e-6)).change, ChangeVerdict::better);
  EXPECT_EQ(decided(measure(0.0, {-0.01, 0.01}, 0.5)).change, ChangeVerdict::equivalent);
  EXPECT_EQ(decided(measure(0.015, {0.011, 0.019}, 1e-9)).change, ChangeVerdict::equivalent);
  EXPECT_EQ(decided(measure(-0.015, {-0.03, 0.0}, 0.8)).change, ChangeVerdict::not_worse);
  EXPECT_EQ(decided(measure(-0.03, {-0.08, 0.01}, 0.8)).change, ChangeVerdict::not_worse);
  EXPECT_EQ(decided(measure(0.0, {-0.03, 0.03}, 0.5)).change, ChangeVerdict::undecided);
  EXPECT_EQ(decided(measure(0.015, {-0.01, 0.04}, 0.2)).change, ChangeVerdict::undecided);
}

// With a margin of 2 %; where every change fails, only equivalence passes.
TEST(Verdict, WhereEveryChangeFailsAnImprovementFailsToo) {
  comparison::Judgement better = measure(-0.05, {-0.07, -0.03}, 1.0 - 1e-6);
  EXPECT_EQ(decided(better).verdict, comparison::GateVerdict::passed);
  better.changed_fails = true;
  EXPECT_EQ(decided(better).verdict, comparison::GateVerdict::changed);
  EXPECT_EQ(decided(better).change, comparison::ChangeVerdict::better);
  comparison::Judgement worse = measure(0.05, {0.03, 0.07}, 1e-6);
  worse.changed_fails = true;
  EXPECT_EQ(decided(worse).verdict, comparison::GateVerdict::regression);
  comparison::Judgement open = measure(-0.015, {-0.03, 0.0}, 0.8);
  EXPECT_EQ(decided(open).verdict, comparison::GateVerdict::passed);
  open.changed_fails = true;
  EXPECT_EQ(decided(open).verdict, comparison::GateVerdict::inconclusive);
  comparison::Judgement same = measure(0.0, {-0.01, 0.01}, 0.5);
  same.changed_fails = true;
  EXPECT_EQ(decided(same).verdict, comparison::GateVerdict::passed);
}

// Both directions together have the stated rate: each has half of it.
TEST(Verdict, WhereEveryChangeFailsTheTestIsTwoSided) {
  comparison::Judgement worse = measure(0.05, {0.03, 0.07}, 0.03);
  EXPECT_EQ(decided(worse).change, comparison::ChangeVerdict::worse);
  worse.changed_fails = true;
  EXPECT_EQ(decided(worse).change, comparison::ChangeVerdict::undecided);
  EXPECT_DOUBLE_EQ(decided(worse).adjusted_p, 0.06);
  EXPECT_DOUBLE_EQ(decided(worse).adjusted_improvement_p, 1.0);
}

TEST(Verdict, OneSmallValueAmongManyTestsIsNoDiscovery) {
  comparison::PointComparison point;
  point.judgements.assign(50, measure(0.0, {-0.01, 0.01}, 0.5));
  point.judgements[7] = measure(0.03, {0.002, 0.06}, 0.01);
  const std::int64_t tests = comparison::decide(comparison::judgements_of({&point, 1}), {});
  EXPECT_EQ(tests, 50);
  EXPECT_EQ(point.judgements[7].verdict, comparison::GateVerdict::inconclusive);
  EXPECT_EQ(decided(measure(0.03, {0.002, 0.06}, 0.01)).verdict,
            comparison::GateVerdict::regression);  // by itself it is
}

TEST(Verdict, WhatWasNotMeasuredCountsNeitherWay) {
  comparison::Judgement nothing;
  EXPECT_EQ(decided(nothing).verdict, comparison::GateVerdict::not_measured);
  const std::vector<comparison::GateVerdict> both{comparison::GateVerdict::not_measured,
                                                  comparison::GateVerdict::passed};
  EXPECT_EQ(comparison::worst_of(both), comparison::GateVerdict::passed);
  EXPECT_EQ(comparison::worst_of({}), comparison::GateVerdict::not_measured);
}

TEST(Verdict, AnOpenMeasureSaysWhy) {
  EXPECT_EQ(decided(measure(0.02, {0.01, 0.03}, 1e-3)).note, "not shown to be within the margin");
  EXPECT_EQ(decided(measure(0.03, {0.0, 0.06}, 0.1)).note, "beyond the margin, but not significantly");
  EXPECT_EQ(decided(measure(0.0, {-0.01, 0.01}, 0.5)).note, "");
}

comparison::PointTrials agreeing(std::int64_t trials) {
  comparison::PointTrials all;
  all.trials = trials;
  all.moves = 1;
  const auto count = static_cast<std::size_t>(trials);
  all.values["success_rate"].assign(count, true);
  all.values["arrival_rate"].assign(count, true);
  all.values["stable_rate"].assign(count, true);
  all.values["settling_time"].assign(count, 0.03);
  all.values["jerk_count"].assign(count, 0.0);
  return all;
}

comparison::GateVerdict verdict_on(const comparison::PointTrials& before,
                                   const comparison::PointTrials& after, bool paired) {
  comparison::PointComparison point;
  point.baseline_trials = before.trials;
  point.current_trials = after.trials;
  point.judgements = comparison::compare_measures({}, "", {before, after, paired});
  comparison::decide(comparison::judgements_of({&point, 1}), {});
  std::vector<comparison::GateVerdict> verdicts;
  for (const comparison::Judgement& one : point.judgements) verdicts.push_back(one.verdict);
  return comparison::worst_of(verdicts);
}

TEST(Evidence, AFewTrialsThatAgreeShowNothing) {
  for (const bool paired : {false, true}) {
    for (const std::int64_t trials : {1, 5, 19, 50}) {
      EXPECT_EQ(verdict_on(agreeing(trials), agreeing(trials), paired), comparison::GateVerdict::inconclusive)
          << trials;
    }
    EXPECT_EQ(verdict_on(agreeing(500), agreeing(500), paired), comparison::GateVerdict::passed);
  }
}

TEST(Evidence, TrialsThatNoLongerArriveFailByTheirArrivalAndNotByTheirTimes) {
  comparison::PointTrials after = agreeing(500);
  std::fill(after.values["arrival_rate"].begin(), after.values["arrival_rate"].end(), false);
  std::fill(after.values["settling_time"].begin(), after.values["settling_time"].end(), std::nan(""));
  for (const bool paired : {false, true}) {
    const auto measures = comparison::compare_measures({}, "", {agreeing(500), after, paired});
    EXPECT_TRUE(std::isnan(measures[3].p));
    EXPECT_EQ(verdict_on(agreeing(500), after, paired), comparison::GateVerdict::regression);
  }
}

// A trial of several moves is one trial, whose moves that arrived in both are compared.
TEST(Evidence, MovesAreComparedWithTheirPartners) {
  comparison::PointTrials before = agreeing(100);
  before.moves = 2;
  before.values["settling_time"].clear();
  comparison::PointTrials after = before;
  for (int trial = 0; trial < 100; ++trial) {
    before.values["settling_time"].insert(before.values["settling_time"].end(), {0.01, 0.5});
    after.values["settling_time"].insert(after.values["settling_time"].end(), {0.02, std::nan("")});
  }
  const auto measures = comparison::compare_measures({}, "", {before, after, true});
  EXPECT_NEAR(measures[3].effect, 0.01, 1e-15);
  EXPECT_EQ(measures[3].baseline_n, 100);
  EXPECT_NEAR(measures[3].baseline, 0.01, 1e-15);
}

}  // namespace
}  // namespace zerocount::testing
