#include "analysis/trials/jerks/laplace_trend.hpp"

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/trials/jerks/creep_comparison.hpp"
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "tests/support/goodness_of_fit.hpp"
#include "tests/support/test.hpp"

namespace zerocount::jerks {
namespace {

using Intervals = std::vector<std::int64_t>;
using Random = std::mt19937_64;

TEST(LaplaceTrend, HasTheMeanAndVarianceOverAllPermutations) {
  for (Intervals intervals : {Intervals{3, 9}, {1, 2, 2, 7}, {5, 1, 8, 30, 2, 2}}) {
    std::sort(intervals.begin(), intervals.end());
    double sum = 0.0, squares = 0.0;
    int orders = 0;
    do {
      const double excess = trend_term(intervals).excess;
      sum += excess;
      squares += excess * excess;
      ++orders;
    } while (std::next_permutation(intervals.begin(), intervals.end()));
    EXPECT_NEAR(sum, 0.0, 1e-9);
    EXPECT_NEAR(squares / orders, trend_term(intervals).variance, 1e-9);
  }
}

TEST(LaplaceTrend, FewIntervalsHaveExactProbabilities) {
  // Of the 24 orders of four different intervals only one is increasing.
  EXPECT_DOUBLE_EQ(trend_probability(Intervals{1, 2, 4, 8}, 0).slowing, 1.0 / 24.0);
  EXPECT_DOUBLE_EQ(trend_probability(Intervals{1, 2, 4, 8}, 0).quickening, 1.0);
  EXPECT_DOUBLE_EQ(trend_probability(Intervals{8, 4, 2, 1}, 0).quickening, 1.0 / 24.0);
  EXPECT_DOUBLE_EQ(trend_probability(Intervals{1, 1, 2}, 0).slowing, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(trend_probability(Intervals{5, 5, 5, 5}, 0).slowing, 1.0);
  EXPECT_EQ(trend_probability(Intervals{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, 3).slowing, 1.0 / 1000.0);
}

TEST(LaplaceTrend, WithoutIntervalsIsUndefined) {
  EXPECT_TRUE(std::isnan(trend_score(trend_term({}))));
  EXPECT_TRUE(std::isnan(trend_score(trend_term(Intervals{4}))));
  EXPECT_TRUE(std::isnan(trend_score(trend_term(Intervals{4, 4, 4}))));
  TrendSum sum(0.95);
  sum.add({});
  EXPECT_EQ(sum.summary().moves, 0);
  EXPECT_TRUE(std::isnan(sum.summary().summed));
  EXPECT_THROW(TrendSum(1.0), Failure);
}

/// A distribution of the intervals between events, in samples. A move has 1000 samples.
struct Renewal {
  const char* name;
  std::function<double(Random&)> interval;
};

const std::vector<Renewal>& renewals() {
  static const std::vector<Renewal> all{
      {"exponential", [](Random& r) { return std::exponential_distribution<double>(1.0 / 120.0)(r); }},
      {"regular", [](Random& r) { return std::normal_distribution<double>(130.0, 10.0)(r); }},
      {"gamma", [](Random& r) { return std::gamma_distribution<double>(4.0, 30.0)(r); }},
      {"bursty",
       [](Random& r) {
         return std::exponential_distribution<double>(r() % 4 == 0 ? 1.0 / 400.0 : 1.0 / 10.0)(r);
       }},
      {"heavy-tailed", [](Random& r) { return std::lognormal_distribution<double>(3.0, 1.5)(r); }}};
  return all;
}

/// The intervals (samples) between the events in a window of 1000 samples; the incomplete ones at the ends
/// are left out.
Intervals in_window(const std::function<double(Random&)>& interval, Random& random) {
  Intervals intervals;
  std::int64_t time = 0;
  while (true) {
    const auto next = std::max<std::int64_t>(1, std::llround(interval(random)));
    if ((time += next) >= 1000) return intervals;
    intervals.push_back(next);
  }
}

void expect_uniform_probabilities(int studies) {
  Random random(102);
  constexpr std::size_t bins = 10;
  for (const Renewal& renewal : renewals()) {
    int slowing_alarms = 0, quickening_alarms = 0;
    std::int64_t tested = 0, slowing = 0, quickening = 0;
    std::vector<double> found(bins, 0.0);
    for (int study = 0; study < studies; ++study) {
      TrendSum sum(0.95);
      for (int move = 0; move < 5; ++move) sum.add(in_window(renewal.interval, random));
      const TrendSummary summary = sum.summary();
      ASSERT_EQ(summary.permutations, trend_permutations);
      slowing_alarms += summary.p_slowing <= 0.05;
      quickening_alarms += summary.p_slowing >= 0.95;
      ++found[std::min(bins - 1, static_cast<std::size_t>(summary.p_slowing * bins))];
      tested += summary.tested;
      slowing += summary.slowing;
      quickening += summary.quickening;
    }
    const double three_sigma = 3.0 * std::sqrt(0.05 * 0.95 * studies);
    EXPECT_NEAR(slowing_alarms, 0.05 * studies, three_sigma) << renewal.name;
    EXPECT_NEAR(quickening_alarms, 0.05 * studies, three_sigma) << renewal.name;
    EXPECT_GT(testing::chi_square_probability(found, std::vector<double>(bins, studies / 10.0)), 1e-3)
        << renewal.name;
    // A single move has few orders, so that its test is conservative.
    const auto n = static_cast<double>(tested);
    EXPECT_LE(static_cast<double>(slowing), 0.05 * n + 3.0 * std::sqrt(0.05 * 0.95 * n)) << renewal.name;
    EXPECT_LE(static_cast<double>(quickening), 0.05 * n + 3.0 * std::sqrt(0.05 * 0.95 * n)) << renewal.name;
    std::cout << renewal.name << ": false alarms " << 100.0 * slowing_alarms / studies << " % slowing, "
              << 100.0 * quickening_alarms / studies << " % quickening; single moves "
              << 100.0 * static_cast<double>(slowing) / n << " %\n";
  }
}

TEST(LaplaceTrend, RenewalProcessesWithoutATrendHaveUniformProbabilities) {
  expect_uniform_probabilities(60);
}

TEST(LaplaceTrend, DISABLED_ManyRenewalProcessesWithoutATrendHaveUniformProbabilities) {
  expect_uniform_probabilities(200);
}

/// Intervals between Poisson events whose expected number until the sample t is Λ(t), from Λ = `first` on.
/// @param inverse inverse function of Λ
Intervals poisson_events(const std::function<double(double)>& inverse, double first, Random& random) {
  Intervals intervals;
  double expected = first;
  std::int64_t last = -1;
  while (true) {
    const double time = inverse(expected += std::exponential_distribution<double>(1.0)(random));
    if (time >= 1000.0) return intervals;
    const auto sample = static_cast<std::int64_t>(time);
    if (last >= 0 && sample > last) intervals.push_back(sample - last);
    last = std::max(last, sample);
  }
}

TEST(LaplaceTrend, FindsARateThatFalls) {
  // Rates ∝ 1/t (creep, Omori) and ∝ t^(−1/2) (power law), about ten events a move.
  const std::vector<std::function<double(double)>> laws{
      [](double expected) { return 10.0 * std::exp(expected / 2.5); },
      [](double expected) { return expected * expected * 10.0; }};
  Random random(103);
  for (const auto& law : laws) {
    TrendSum falling(0.95), rising(0.95);
    for (int move = 0; move < 40; ++move) {
      Intervals intervals = poisson_events(law, 0.0, random);
      falling.add(intervals);
      std::reverse(intervals.begin(), intervals.end());
      rising.add(intervals);
    }
    EXPECT_LT(falling.summary().summed, -5.0);
    EXPECT_DOUBLE_EQ(falling.summary().p_slowing, 1.0 / (trend_permutations + 1));
    EXPECT_GT(falling.summary().slowing, 4 * falling.summary().quickening);
    EXPECT_GT(rising.summary().summed, 5.0);
    EXPECT_GT(rising.summary().p_slowing, 0.999);
  }
}

TEST(LaplaceTrend, DoesNotDependOnTheNumberOfThreads) {
  Random random(104);
  TrendSum sum(0.95);
  for (int move = 0; move < 20; ++move) sum.add(in_window(renewals()[0].interval, random));
  const double all = sum.summary().p_slowing;
  const parallel::ThreadLimit one(1);
  EXPECT_EQ(sum.summary().p_slowing, all);
}

TEST(LaplaceTrend, ManyIntervalsUseTheNormalApproximation) {
  Random random(105);
  TrendSum sum(0.95);
  for (int move = 0; move < 3000; ++move) sum.add(in_window(renewals()[0].interval, random));
  const TrendSummary summary = sum.summary();
  EXPECT_EQ(summary.permutations, 0);
  EXPECT_NEAR(summary.p_slowing, 0.5 * std::erfc(-summary.summed / std::sqrt(2.0)), 1e-12);
}

constexpr double sample_time = 1.0 / 2000.0;

study::Study fig8(const std::vector<std::string>& overrides = {}) {
  return manifest::load_study(std::string(ZEROCOUNT_MANIFESTS) + "/paper-fig8.yaml", overrides);
}

TEST(CreepComparison, CreepAtConstantTorquePredictsTheJerksOfFigure8) {
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

TEST(CreepComparison, PredictedWaitsStartAtThePreviousJerk) {
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

TEST(CreepComparison, JerksTenPercentOffThePredictionDoNotAgree) {
  CreepComparison comparison = compare_with_creep(fig8(), 0, 12);
  for (CreepWait& wait : comparison.waits) wait.predicted = wait.since + 1.1 * (wait.predicted - wait.since);
  const CreepAgreement agreement = agreement_of(comparison, sample_time);
  EXPECT_LT(agreement.predicted, agreement.ended / 2);
}

TEST(CreepComparison, StartsAgainAfterEachMove) {
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

TEST(CreepComparison, GivesTheReasonIfItDoesNotApply) {
  EXPECT_EQ(compare_with_creep(fig8({"friction.model=spring"}), 0, 3).not_applicable,
            "the friction does not creep");
  EXPECT_EQ(compare_with_creep(fig8({"dac.noise=1e-5"}), 0, 3).not_applicable, "the converter has noise");
  EXPECT_EQ(compare_with_creep(fig8({"encoder.fine_errors.noise=0.1"}), 0, 3).not_applicable,
            "the encoder has errors");
  EXPECT_EQ(compare_with_creep(fig8(), 0, 0).trials, 0);
}

}  // namespace
}  // namespace zerocount::jerks
