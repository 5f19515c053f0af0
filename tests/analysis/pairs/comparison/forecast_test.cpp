// The number of trials that would decide a comparison: does it decide as often as promised?
#include "analysis/pairs/comparison/forecast.hpp"

#include <oneapi/tbb/task_arena.h>

#include "tests/analysis/pairs/comparison/synthetic_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using comparison::GateRules;
using comparison::GateVerdict;

/// Two made-up studies to be compared, which can be simulated with any number of trials: the first n trials
/// are the same, however many are asked for.
struct StudyPair {
  std::vector<SyntheticPoint> before;
  std::vector<SyntheticPoint> after;
  bool paired{false};
  std::uint64_t seed{0};
};

struct PairTrials {
  TrialChances before;
  TrialChances after;
};

PairTrials trials_of(const StudyPair& pair, std::int64_t count) {
  std::mt19937_64 random(pair.seed);
  std::mt19937_64 other(pair.seed + 1'000'000);
  const TrialChances before = draw_chances(random, count);
  return {before, pair.paired ? redraw_some(other, before, 0.2) : draw_chances(other, count)};
}

/// Data of a design point from which it is forecast how many more trials a comparison needs.
struct SampledPoint {
  std::int64_t trials{0};
  std::vector<two_samples::Sample> samples{};
  std::vector<comparison::TestedMeasure> found{};
};

comparison::ForecastSamples samples_of(const std::vector<SampledPoint>& points, bool one_sample = false) {
  const two_samples::Sample& first = points.front().samples.front();
  comparison::ForecastSamples samples({std::ssize(first.baseline), std::ssize(first.current)}, one_sample);
  for (const SampledPoint& point : points) {
    samples.add_point(point.trials, point.trials);
    for (std::size_t k = 0; k < point.found.size(); ++k) samples.add(point.found[k], point.samples[k]);
  }
  return samples;
}

/// The verdict of a comparison of two studies, and the data from which it is forecast how many more trials it
/// needs.
struct Compared {
  GateVerdict verdict{GateVerdict::inconclusive};
  std::vector<SampledPoint> points;
};

Compared compare(const StudyPair& pair, const PairTrials& trials, const GateRules& rules) {
  Compared result;
  std::vector<comparison::PointComparison> compared;
  for (std::size_t i = 0; i < pair.before.size(); ++i) {
    const comparison::PointTrials before = synthetic_trials(pair.before[i], trials.before);
    const comparison::PointTrials after = synthetic_trials(pair.after[i], trials.after);
    comparison::PointComparison& point = compared.emplace_back();
    point.judgements = comparison::compare_measures(rules, "", {before, after, pair.paired});
    const auto samples = comparison::measure_samples(rules, point.judgements, {before, after, pair.paired});
    SampledPoint& sampled = result.points.emplace_back();
    sampled.trials = before.trials;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      if (std::isnan(point.judgements[k].p)) continue;
      sampled.samples.push_back(samples[k]);
      sampled.found.emplace_back(point.judgements[k]);
    }
  }
  comparison::decide(comparison::judgements_of(compared), rules);
  std::vector<GateVerdict> verdicts;
  for (const auto& point : compared) {
    for (const auto& measure : point.judgements) verdicts.push_back(measure.verdict);
  }
  result.verdict = comparison::worst_of(verdicts);
  return result;
}

enum class Change { none, some, all };

/// A random pair of studies with 1 to 5 points. None, some or all of the points have changed.
StudyPair random_pair(std::mt19937_64& random, Change change, bool paired) {
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  StudyPair pair;
  pair.paired = paired;
  pair.seed = random();
  const auto points = static_cast<int>(1.0 + 5.0 * uniform(random));
  for (int i = 0; i < points; ++i) {
    const SyntheticPoint before{uniform(random) < 0.2 ? 1.0 : 0.5 + 0.5 * uniform(random),
                                0.01 + 0.04 * uniform(random), uniform(random)};
    SyntheticPoint after = before;
    if (change == Change::all || (change == Change::some && uniform(random) < 0.3)) {
      after.success = std::min(1.0, std::max(0.05, after.success + 0.03 * normal(random)));
      after.settling *= std::exp(0.1 * normal(random));
      after.jerks *= std::exp(0.2 * normal(random));
    }
    pair.before.push_back(before);
    pair.after.push_back(after);
  }
  return pair;
}

/// Counts of study pairs whose comparison is undecided: for how many the forecast stated a number of trials
/// that should decide, and how often this number did decide.
struct Kept {
  int stated{0};   ///< number of undecided pairs for which a number of trials was stated
  int open{0};     ///< number of undecided pairs
  int decided{0};  ///< number of pairs that the stated number of trials decides, the first trials included
  int afresh{0};   ///< number of pairs that the stated number of trials decides if all trials are new
};

Kept try_pairs(Change change, bool paired, bool changed_fails, int wanted, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  GateRules rules;
  rules.changed_fails = changed_fails;
  Kept kept;
  while (kept.stated < wanted) {
    StudyPair pair = random_pair(random, change, paired);
    const Compared few = compare(pair, trials_of(pair, 200), rules);
    if (few.verdict != GateVerdict::inconclusive) continue;
    ++kept.open;
    const comparison::Forecast forecast = comparison::forecast_decision(samples_of(few.points), {});
    if (!forecast.trials) continue;
    ++kept.stated;
    const auto needed = static_cast<std::int64_t>(*forecast.trials);
    kept.decided += compare(pair, trials_of(pair, needed), rules).verdict != GateVerdict::inconclusive;
    pair.seed = random();
    kept.afresh += compare(pair, trials_of(pair, needed), rules).verdict != GateVerdict::inconclusive;
  }
  return kept;
}

/// Checks that the number of trials that the forecast states decides the comparison often enough.
/// @param wanted number of study pairs of each kind
void expect_stated_number_to_decide(int wanted) {
  Kept all;
  std::uint64_t seed = 1;
  for (const Change change : {Change::none, Change::some, Change::all}) {
    for (const bool paired : {false, true}) {
      for (const bool changed_fails : {false, true}) {
        const Kept kept = try_pairs(change, paired, changed_fails, wanted, seed++);
        std::printf("change %d, paired %d, changed fails %d: %d of %d decided, afresh %d, %d open\n",
                    static_cast<int>(change), paired, changed_fails, kept.decided, kept.stated, kept.afresh,
                    kept.open);
        std::fflush(stdout);
        all.stated += kept.stated;
        all.decided += kept.decided;
        all.afresh += kept.afresh;
      }
    }
  }
  std::printf("of %d stated, %d decided, afresh %d\n", all.stated, all.decided, all.afresh);
  const double stated = all.stated;
  EXPECT_GE(all.decided, 0.65 * stated);
  EXPECT_LT(all.decided, stated);
}

TEST(Forecast, TheStatedNumberOfTrialsDecidesAsOftenAsPromised) {
  expect_stated_number_to_decide(1);
}

// ZEROCOUNT_FORECAST_PAIRS: how many pairs of each kind.
TEST(Forecast, DISABLED_TheStatedNumberOfTrialsDecidesManyAsOftenAsPromised) {
  const char* const wanted = std::getenv("ZEROCOUNT_FORECAST_PAIRS");
  expect_stated_number_to_decide(wanted == nullptr ? 4 : std::atoi(wanted));
}

/// A pair of studies with two design points whose comparison is undecided.
Compared an_open_pair() {
  const StudyPair pair{{{0.9, 0.03, 0.5}, {0.7, 0.02, 0.2}}, {{0.9, 0.03, 0.5}, {0.7, 0.02, 0.2}}, false, 11};
  Compared compared = compare(pair, trials_of(pair, 300), {});
  EXPECT_EQ(compared.verdict, GateVerdict::inconclusive);
  return compared;
}

TEST(Forecast, DoesNotDependOnTheNumberOfThreads) {
  const Compared open = an_open_pair();
  const comparison::Forecast all = comparison::forecast_decision(samples_of(open.points), {});
  comparison::Forecast one;
  oneapi::tbb::task_arena(1).execute(
      [&] { one = comparison::forecast_decision(samples_of(open.points), {}); });
  ASSERT_FALSE(all.judgements.empty());
  EXPECT_EQ(one.trials, all.trials);
  EXPECT_EQ(one.max_trials, all.max_trials);
  for (std::size_t i = 0; i < all.judgements.size(); ++i) {
    EXPECT_EQ(one.judgements[i].trials, all.judgements[i].trials);
    EXPECT_EQ(one.judgements[i].margin, all.judgements[i].margin);
  }
}

// All measures together need at least as many trials as any of them where nothing fails.
TEST(Forecast, TheWholeComparisonNeedsMoreTrialsThanAnyOfItsMeasures) {
  const Compared open = an_open_pair();
  const comparison::Forecast forecast =
      comparison::forecast_equivalence(samples_of(open.points, true), {.max_factor = 1000.0});
  ASSERT_TRUE(forecast.trials.has_value());
  for (const comparison::JudgementForecast& one : forecast.judgements) {
    ASSERT_TRUE(one.trials.has_value());
    EXPECT_LE(*one.trials, *forecast.trials);
  }
}

// A rate p, both bounds within ± M with power 1 − β: n = 2p(1 − p)·(z_c + z_{1−β/2})²/M² of each study.
TEST(Forecast, ForOneRateAgreesWithTheClosedForm) {
  const StudyPair pair{{{0.8, 0.03, 0.5}}, {{0.8, 0.03, 0.5}}, false, 5};
  GateRules rules;
  rules.measures = {"success_rate"};
  rules.margins["success_rate"] = {.absolute = 0.03};
  rules.changed_fails = true;
  const Compared pilot = compare(pair, trials_of(pair, 4000), rules);
  const comparison::Forecast forecast = comparison::forecast_equivalence(
      samples_of(pilot.points, true), {.probability = 0.9, .simulations = 2000, .min_factor = 0.1});
  const double z = 1.6448536 + 1.6448536;
  ASSERT_TRUE(forecast.trials.has_value());
  EXPECT_NEAR(*forecast.trials, 2.0 * 0.8 * 0.2 * z * z / (0.03 * 0.03), 0.07 * *forecast.trials);
}

TEST(Forecast, NamesTheMarginThatMaxTrialsCouldDecide) {
  const Compared open = an_open_pair();
  const comparison::Forecast forecast =
      comparison::forecast_decision(samples_of(open.points), {.max_factor = 1.5});
  EXPECT_FALSE(forecast.trials.has_value());
  EXPECT_EQ(forecast.max_trials, 450.0);
  int open_measures = 0;
  for (std::size_t i = 0; i < forecast.judgements.size(); ++i) {
    if (forecast.judgements[i].trials) continue;
    ++open_measures;
    EXPECT_GT(forecast.judgements[i].margin, open.points[i / 5].found[i % 5].margin);
  }
  EXPECT_GT(open_measures, 0);
}

TEST(Forecast, EffectsThatAreSmallTogetherAreProbablyNil) {
  const std::vector<double> small =
      comparison::zero_difference_probabilities({0.3, -0.5, 1.0, 0.1, -0.8, 0.2, 1.5, -0.1});
  for (const double nil : small) EXPECT_GT(nil, 0.8);
  const std::vector<double> mixed = comparison::zero_difference_probabilities({0.3, 9.0, -7.0, 0.1, 5.0});
  EXPECT_LT(mixed[1], 1e-6);
  EXPECT_GT(mixed[3], 0.5);
}

// The work of a comparison of many points grows no faster than the number of its judgements.
TEST(Forecast, ManyJudgementsHaveFewerSimulations) {
  const comparison::ForecastOptions usual;
  comparison::ForecastOptions few, many;
  comparison::limit_work(few, 2000);
  EXPECT_EQ(few.simulations, usual.simulations);
  EXPECT_EQ(few.factor_step, usual.factor_step);
  comparison::limit_work(many, 50'000);
  EXPECT_EQ(many.simulations, usual.simulations / 8);
  EXPECT_GT(many.factor_step, usual.factor_step);
}

}  // namespace
}  // namespace zerocount::testing
