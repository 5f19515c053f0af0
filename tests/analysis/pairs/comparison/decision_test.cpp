// Verdicts from numbers that are made up.
#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/pairs/comparison/point_judgements.hpp"
#include "analysis/pairs/two_samples/exact_tests.hpp"
#include "analysis/pairs/two_samples/sample.hpp"
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
  one.beyond = {p, 1.0 - p};
  return one;
}

comparison::Judgement decided(const comparison::Judgement& one) {
  comparison::PointComparison point;
  point.baseline_trials = point.current_trials = 1000;
  point.judgements = {one};
  comparison::decide(comparison::judgements_of({&point, 1}), {});
  return point.judgements.front();
}

TEST(Verdict, PassesIfTheBoundIsWithinTheMargin) {
  EXPECT_EQ(decided(measure(0.0, {-0.01, 0.01}, 0.5)).verdict, comparison::GateVerdict::passed);
  EXPECT_EQ(decided(measure(0.015, {0.011, 0.019}, 1e-9)).verdict,
            comparison::GateVerdict::passed);  // significant, but small
  EXPECT_EQ(decided(measure(-0.5, {-0.6, -0.4}, 1.0)).verdict, comparison::GateVerdict::passed);
}

TEST(Verdict, FailsIfTheChangeIsSignificantAndBeyondTheMargin) {
  EXPECT_EQ(decided(measure(0.05, {0.03, 0.07}, 1e-6)).verdict, comparison::GateVerdict::regression);
  EXPECT_EQ(decided(measure(0.05, {-0.01, 0.12}, 0.2)).verdict, comparison::GateVerdict::inconclusive);
  EXPECT_EQ(decided(measure(0.018, {0.01, 0.026}, 1e-6)).verdict, comparison::GateVerdict::inconclusive);
}

// The effect, its bounds and p against a change for the worse, and what is shown by them with a margin of 2
// %.
TEST(Verdict, NamesTheDirectionOfAChange) {
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
TEST(Verdict, IfEveryChangeFailsAnImprovementFailsToo) {
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
TEST(Verdict, IfEveryChangeFailsTheTestIsTwoSided) {
  comparison::Judgement worse = measure(0.05, {0.03, 0.07}, 0.03);
  EXPECT_EQ(decided(worse).change, comparison::ChangeVerdict::worse);
  worse.changed_fails = true;
  EXPECT_EQ(decided(worse).change, comparison::ChangeVerdict::undecided);
  EXPECT_DOUBLE_EQ(decided(worse).adjusted_p, 0.06);
  EXPECT_DOUBLE_EQ(decided(worse).adjusted_improvement_p, 1.0);
}

TEST(Verdict, OneSmallPValueAmongFiftyTestsIsInconclusive) {
  comparison::PointComparison point;
  point.judgements.assign(50, measure(0.0, {-0.01, 0.01}, 0.5));
  point.judgements[7] = measure(0.05, {0.025, 0.075}, 0.01);
  const std::int64_t tests = comparison::decide(comparison::judgements_of({&point, 1}), {});
  EXPECT_EQ(tests, 50);
  EXPECT_EQ(point.judgements[7].verdict, comparison::GateVerdict::inconclusive);
  EXPECT_EQ(decided(measure(0.05, {0.025, 0.075}, 0.01)).verdict,
            comparison::GateVerdict::regression);  // by itself it is
}

// A change may be certain, and its estimate beyond the margin, and still be smaller than the margin.
TEST(Verdict, AnEstimateBeyondTheMarginIsUndecidedUnlessItsBoundIsBeyondToo) {
  const comparison::Judgement one = decided(measure(0.021, {0.012, 0.03}, 1e-6));
  EXPECT_EQ(one.verdict, comparison::GateVerdict::inconclusive);
  EXPECT_EQ(one.note, "beyond the margin, but not significantly");
  comparison::Judgement better = measure(-0.021, {-0.03, -0.012}, 1.0 - 1e-6);
  better.changed_fails = true;
  EXPECT_EQ(decided(better).verdict, comparison::GateVerdict::inconclusive);
}

// The level at which a bound reaches the margin, found from the other side: bounds of that confidence do.
TEST(Verdict, AChangeWithinTheMarginIsTestedByItsBounds) {
  std::mt19937_64 random(83);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 60; ++i) {
    two_samples::Sample sample{.failures = i % 2 == 0, .paired = i % 4 < 2};
    for (int unit = 0; unit < 80; ++unit) {
      const double before = sample.failures ? uniform(random) < 0.1 : normal(random);
      const double after = sample.failures ? uniform(random) < 0.4 : normal(random) + 0.7;
      sample.baseline.push_back(before);
      sample.current.push_back(after);
      if (sample.paired) sample.differences.push_back(after - before);
    }
    const double margin = 0.5 * two_samples::change_of(sample, 0.9).effect;
    const double p = two_samples::change_of(sample, 0.9, margin).beyond.worse;
    ASSERT_GT(p, two_samples::p_of(sample).worse) << i;
    EXPECT_NEAR(two_samples::change_of(sample, 1.0 - p).bounds.low, margin, 1e-6) << i;
    EXPECT_EQ(two_samples::change_of(sample, 0.9, 0.0).beyond.worse, two_samples::p_of(sample).worse);
  }
}

TEST(Verdict, AMeasureWithoutValuesDoesNotAffectTheVerdict) {
  comparison::Judgement nothing;
  EXPECT_EQ(decided(nothing).verdict, comparison::GateVerdict::not_measured);
  const std::vector<comparison::GateVerdict> both{comparison::GateVerdict::not_measured,
                                                  comparison::GateVerdict::passed};
  EXPECT_EQ(comparison::worst_of(both), comparison::GateVerdict::passed);
  EXPECT_EQ(comparison::worst_of({}), comparison::GateVerdict::not_measured);
}

TEST(Verdict, AnOpenMeasureGivesTheReason) {
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
  all.values["arrival_time"].assign(count, 0.03);
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

TEST(Evidence, AFewTrialsThatAgreeAreInconclusive) {
  for (const bool paired : {false, true}) {
    for (const std::int64_t trials : {1, 5, 19, 50}) {
      EXPECT_EQ(verdict_on(agreeing(trials), agreeing(trials), paired), comparison::GateVerdict::inconclusive)
          << trials;
    }
    EXPECT_EQ(verdict_on(agreeing(500), agreeing(500), paired), comparison::GateVerdict::passed);
  }
}

TEST(Evidence, TrialsThatNoLongerArriveLowerTheArrivalRateAndNotTheArrivalTime) {
  comparison::PointTrials after = agreeing(500);
  std::fill(after.values["arrival_rate"].begin(), after.values["arrival_rate"].end(), false);
  std::fill(after.values["arrival_time"].begin(), after.values["arrival_time"].end(), std::nan(""));
  for (const bool paired : {false, true}) {
    const auto measures = comparison::compare_measures({}, "", {agreeing(500), after, paired});
    EXPECT_TRUE(std::isnan(measures[3].p));
    EXPECT_EQ(verdict_on(agreeing(500), after, paired), comparison::GateVerdict::regression);
  }
}

// A trial of several moves is one trial, whose moves that arrived in both are compared.
TEST(Evidence, MovesOfTheSameTrialsAreComparedInPairs) {
  comparison::PointTrials before = agreeing(100);
  before.moves = 2;
  before.values["arrival_time"].clear();
  comparison::PointTrials after = before;
  for (int trial = 0; trial < 100; ++trial) {
    before.values["arrival_time"].insert(before.values["arrival_time"].end(), {0.01, 0.5});
    after.values["arrival_time"].insert(after.values["arrival_time"].end(), {0.02, std::nan("")});
  }
  const auto measures = comparison::compare_measures({}, "", {before, after, true});
  EXPECT_NEAR(measures[3].effect, 0.01, 1e-15);
  EXPECT_EQ(measures[3].baseline_n, 100);
  EXPECT_NEAR(measures[3].baseline, 0.01, 1e-15);
}

// Tests and bounds against their closed forms.

constexpr double z95 = 1.6448536269514722;

TEST(ProportionTests, EqualSamplesHaveThePValueOne) {
  EXPECT_EQ(two_samples::mcnemar({500, 0, 0}), 1.0);
  EXPECT_EQ(two_samples::fisher({0, 300, 0, 200}), 1.0);
  EXPECT_EQ(two_samples::fisher({300, 300, 200, 200}), 1.0);
  EXPECT_EQ(two_samples::mcnemar({500, 0, 7}), 1.0);
}

TEST(ProportionTests, SevenChangesInOneDirectionHaveTheExactPValue) {
  EXPECT_NEAR(two_samples::mcnemar({500, 7, 0}), 1.0 / 128.0, 1e-15);
  EXPECT_NEAR(two_samples::fisher({0, 7, 7, 7}), 1.0 / 3432.0, 1e-15);  // 14 choose 7
}

// With no pair that differs, Tango's bound solves n·λ/√(nλ(1 − λ)) = z.
TEST(ProportionTests, TangoBoundsWithoutADifferingPairHaveTheirClosedForm) {
  for (const std::int64_t n : {1, 20, 200, 5000}) {
    const statistics::ConfidenceInterval bounds = two_samples::tango({n, 0, 0}, 0.95);
    const double expected = z95 * z95 / (static_cast<double>(n) + z95 * z95);
    EXPECT_NEAR(bounds.high, expected, 1e-12) << n;
    EXPECT_NEAR(bounds.low, -expected, 1e-12) << n;
  }
}

TEST(ProportionTests, ExchangingTheSamplesMirrorsTheBounds) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    const auto n = static_cast<std::int64_t>(1 + random() % 300);
    const auto b = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(n + 1));
    const auto c = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(n - b + 1));
    const statistics::ConfidenceInterval one = two_samples::tango({n, b, c}, 0.95);
    const statistics::ConfidenceInterval other = two_samples::tango({n, c, b}, 0.95);
    EXPECT_NEAR(one.high, -other.low, 1e-11);
    EXPECT_LE(one.low, static_cast<double>(b - c) / static_cast<double>(n) + 1e-12);
    EXPECT_GE(one.high, static_cast<double>(b - c) / static_cast<double>(n) - 1e-12);
  }
}

// The probability that the bound misses, summed over all tables, is near what it says.
TEST(ProportionTests, TangoBoundsCoverTheDifferenceWithTheirConfidence) {
  constexpr std::int64_t n = 60;
  for (const double proportion : {0.02, 0.05, 0.1}) {
    for (const double difference : {0.0, 0.05, 0.1}) {
      const double p10 = proportion + difference;
      double missed = 0.0;
      for (std::int64_t b = 0; b <= n; ++b) {
        for (std::int64_t c = 0; c <= n - b; ++c) {
          const auto same = static_cast<double>(n - b - c);
          const auto worse = static_cast<double>(b);
          const auto better = static_cast<double>(c);
          const double log_probability =
              std::lgamma(static_cast<double>(n) + 1.0) - std::lgamma(worse + 1.0) -
              std::lgamma(better + 1.0) - std::lgamma(same + 1.0) + worse * std::log(p10) +
              better * std::log(proportion) + same * std::log(1.0 - p10 - proportion);
          if (two_samples::tango({n, b, c}, 0.95).high < difference) missed += std::exp(log_probability);
        }
      }
      EXPECT_LE(missed, 0.06) << proportion << " " << difference;
      EXPECT_GE(missed, 0.005) << proportion << " " << difference;
    }
  }
}

TEST(RankTests, EqualSamplesHaveThePValueOne) {
  const std::vector<double> values{1.0, 2.0, 2.0, 3.0};
  EXPECT_EQ(two_samples::smirnov(values, values), 1.0);
  EXPECT_EQ(two_samples::smirnov(values, {}), 1.0);
  EXPECT_EQ(two_samples::signed_rank(std::vector<double>{0.0, 0.0}), 1.0);
}

TEST(RankTests, SamplesThatDoNotOverlapHaveTheSmallestPossiblePValue) {
  EXPECT_NEAR(two_samples::signed_rank(std::vector<double>{1.0, 1.0, 2.0, 3.0, 3.0}), 1.0 / 32.0, 1e-16);
  EXPECT_NEAR(two_samples::smirnov(std::vector<double>{1.0, 2.0, 3.0}, std::vector<double>{4.0, 5.0, 6.0}),
              1.0 / 20.0, 1e-16);
  EXPECT_EQ(two_samples::smirnov(std::vector<double>{4.0, 5.0, 6.0}, std::vector<double>{1.0, 2.0, 3.0}),
            1.0);
}

// Where a sample is too large for the exact law, its limit takes over without a step.
TEST(RankTests, LargeSampleFormulasContinueTheExactDistributions) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<double> differences;
  while (differences.size() < 201) differences.push_back(normal(random) + 0.12);
  const double limit = two_samples::signed_rank(differences);
  differences.pop_back();
  EXPECT_NEAR(std::log(two_samples::signed_rank(differences) / limit), 0.0, 0.25);

  std::vector<double> one;
  std::vector<double> two;
  while (one.size() < 2000) {
    one.push_back(normal(random));
    two.push_back(normal(random) + 0.05);
  }
  const double exact = two_samples::smirnov(one, two);
  one.push_back(0.0);
  EXPECT_NEAR(std::log(two_samples::smirnov(one, two) / exact), 0.0, 0.1);
}

TEST(MeanTests, EqualPairsBoundTheMeanByTheRuleOfThree) {
  for (const std::size_t n : {100u, 1000u, 10000u}) {
    const statistics::ConfidenceInterval bounds =
        two_samples::cautious_bounds(std::vector<double>(n, 0.0), 1.0, 0.95);
    EXPECT_NEAR(bounds.high * static_cast<double>(n), 1.0 + z95, 0.03) << n;
    EXPECT_EQ(bounds.low, -bounds.high);
  }
}

TEST(MeanTests, TheBoundsEncloseTheMean) {
  std::mt19937_64 random(7);
  std::exponential_distribution<double> law;
  for (int round = 0; round < 100; ++round) {
    std::vector<double> differences;
    while (differences.size() < 20 + static_cast<std::size_t>(round))
      differences.push_back(law(random) - 0.5);
    const two_samples::MeanDifference mean = two_samples::mean_difference(differences);
    const statistics::ConfidenceInterval bounds = two_samples::cautious_bounds(differences, 0.5, 0.95);
    EXPECT_LT(bounds.low, mean.value);
    EXPECT_GT(bounds.high, mean.value);
  }
}

TEST(MeanTests, WithoutSpreadTheMeanItselfDecides) {
  EXPECT_EQ(two_samples::p_of(two_samples::mean_difference(std::vector<double>(30, 0.1))), 0.0);
  EXPECT_EQ(two_samples::p_of(two_samples::mean_difference(std::vector<double>(30, 0.0))), 0.5);
  EXPECT_EQ(two_samples::p_of(two_samples::mean_difference(std::vector<double>(30, -0.1))), 1.0);
}

/// The procedure itself: the largest i with p_(i) ≤ α·i/(m·H_m), and all below it.
std::vector<bool> step_up(const std::vector<double>& p, double level) {
  std::vector<double> sorted = p;
  std::sort(sorted.begin(), sorted.end());
  const auto m = static_cast<double>(p.size());
  double harmonic = 0.0;
  for (double i = 1.0; i <= m; i += 1.0) harmonic += 1.0 / i;
  double largest = -1.0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (sorted[i] <= level * static_cast<double>(i + 1) / (m * harmonic)) largest = sorted[i];
  }
  std::vector<bool> rejected;
  for (const double one : p) rejected.push_back(one <= largest);
  return rejected;
}

TEST(FalseDiscovery, AdjustedPValuesRejectTheSameTestsAsTheStepUpProcedure) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform;
  for (int round = 0; round < 500; ++round) {
    std::vector<double> p(1 + random() % 40);
    for (double& one : p) one = std::pow(uniform(random), 1.0 + static_cast<double>(random() % 5));
    const std::vector<double> adjusted = comparison::benjamini_yekutieli(p);
    const double level = 0.01 + 0.2 * uniform(random);
    const std::vector<bool> rejected = step_up(p, level);
    for (std::size_t i = 0; i < p.size(); ++i) {
      EXPECT_EQ(adjusted[i] <= level, rejected[i]);
      EXPECT_GE(adjusted[i], p[i]);
      EXPECT_LE(adjusted[i], 1.0);
    }
  }
}

TEST(FalseDiscovery, OneTestNeedsNoAdjustment) {
  EXPECT_EQ(comparison::benjamini_yekutieli(std::vector<double>{0.03}), std::vector<double>{0.03});
  EXPECT_TRUE(comparison::benjamini_yekutieli({}).empty());
}

}  // namespace
}  // namespace zerocount::testing
