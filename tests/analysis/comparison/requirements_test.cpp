// Absolute requirements, judged by the bounds of one file.
#include "analysis/comparison/gate_rules.hpp"
#include "analysis/comparison/point_judgements.hpp"
#include "core/failure/failure.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

comparison::PointTrials with_successes(std::int64_t successes, std::int64_t trials) {
  comparison::PointTrials all;
  all.trials = trials;
  all.moves = 1;
  for (std::int64_t i = 0; i < trials; ++i) {
    all.values["success_rate"].push_back(i < successes);
    all.values["arrival_rate"].push_back(i < successes);
    all.values["stable_rate"].push_back(i < successes);
    all.values["settling_time"].push_back(i < successes ? 0.001 * static_cast<double>(i + 1) : std::nan(""));
    all.values["jerk_count"].push_back(static_cast<double>(i % 2));
  }
  return all;
}

comparison::Judgement judged(const std::string& text, const comparison::PointTrials& trials,
                             double failing = 0.95) {
  const comparison::GateRules rules = comparison::parse_gate_rules("require: '" + text + "'\n", "m.yaml", {});
  return comparison::judge_requirement(rules.requirements.front(), trials, 0.95, failing);
}

// 598 successes of 598 show 99.5 % with 95 % confidence, 597 of 597 do not: 0.995^598 < 0.05 < 0.995^597.
TEST(Requirement, IsShownByTheLowerBound) {
  EXPECT_EQ(judged("success_rate ≥ 0.995", with_successes(598, 598)).verdict,
            comparison::GateVerdict::passed);
  const comparison::Judgement open = judged("success_rate >= 0.995", with_successes(597, 597));
  EXPECT_EQ(open.verdict, comparison::GateVerdict::inconclusive);
  EXPECT_EQ(open.current, 1.0);
}

TEST(Requirement, IsContradictedByTheUpperBound) {
  EXPECT_EQ(judged("success_rate ≥ 0.995", with_successes(960, 1000)).verdict,
            comparison::GateVerdict::regression);
  EXPECT_EQ(judged("success_rate ≥ 0.995", with_successes(993, 1000)).verdict,
            comparison::GateVerdict::inconclusive);
  EXPECT_EQ(judged("success_rate ≤ 0.01", with_successes(0, 400)).verdict, comparison::GateVerdict::passed);
  EXPECT_EQ(judged("success_rate ≤ 0.01", with_successes(30, 400)).verdict,
            comparison::GateVerdict::regression);
}

TEST(Requirement, ManyOfThemMustBeContradictedMoreStrictly) {
  const comparison::PointTrials trials = with_successes(988, 1000);
  EXPECT_EQ(judged("success_rate ≥ 0.995", trials, 0.95).verdict, comparison::GateVerdict::regression);
  EXPECT_EQ(judged("success_rate ≥ 0.995", trials, comparison::failing_confidence(0.95, 100)).verdict,
            comparison::GateVerdict::inconclusive);
  EXPECT_NEAR(comparison::failing_confidence(0.95, 100), 0.9995, 1e-15);
}

// A trial that does not arrive settles later than any limit.
TEST(Requirement, AQuantileCountsTrialsThatNeverSettle) {
  EXPECT_EQ(judged("settling_time.p95 ≤ 0.5", with_successes(500, 500)).verdict,
            comparison::GateVerdict::passed);
  const comparison::Judgement late = judged("settling_time.p95 ≤ 0.5", with_successes(400, 500));
  EXPECT_EQ(late.verdict, comparison::GateVerdict::regression);
  EXPECT_EQ(late.current, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(judged("settling_time.median ≤ 0.3", with_successes(400, 500)).current, 0.250, 1e-12);
}

TEST(Requirement, TheMeanOfTheJerksHasBoundsOfItsOwn) {
  EXPECT_EQ(judged("jerk_count ≤ 0.7", with_successes(500, 500)).verdict, comparison::GateVerdict::passed);
  EXPECT_EQ(judged("jerk_count ≤ 0.4", with_successes(500, 500)).verdict,
            comparison::GateVerdict::regression);
  EXPECT_EQ(judged("jerk_count ≤ 0.51", with_successes(500, 500)).verdict,
            comparison::GateVerdict::inconclusive);
}

// At the limit itself a requirement is met: it must not fail more often than stated, nor pass.
TEST(Requirement, AtItsLimitItRarelyFailsAndRarelyPasses) {
  std::mt19937_64 random(17);
  std::binomial_distribution<std::int64_t> law(500, 0.97);
  int passed = 0;
  int failed = 0;
  constexpr int rounds = 1000;
  for (int i = 0; i < rounds; ++i) {
    const comparison::GateVerdict verdict =
        judged("success_rate ≥ 0.97", with_successes(law(random), 500)).verdict;
    passed += verdict == comparison::GateVerdict::passed;
    failed += verdict == comparison::GateVerdict::regression;
  }
  EXPECT_LE(passed, 0.05 * rounds);
  EXPECT_LE(failed, 0.05 * rounds);
}

}  // namespace
}  // namespace zerocount::testing
