// Bets on a change: what keeps false alarms within their bound, and how soon a change is seen.
#include "analysis/machine/monitor/change_test.hpp"

#include "analysis/basis/parallel/parallel.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "tests/analysis/machine/monitor/move_sequences.hpp"
#include "tests/support/refusal.hpp"

namespace zerocount::testing {
namespace {

using monitor::ChangeMartingale;
using monitor::Dependence;
using monitor::Direction;

/// The largest capital of the test martingale (its evidence for a change) within each of `sequences` random
/// sequences of moves.
std::vector<double> largest_capitals(const Sequence& sequence, std::uint32_t sequences) {
  std::vector<double> largest(sequences);
  parallel::for_each_index(sequences, [&](std::size_t i) {
    largest[i] = largest_capital(sequence, static_cast<std::uint32_t>(i));
  });
  return largest;
}

/// Number of sequences whose capital (evidence for a change) ever reaches 1/alarm, that is, which raise an
/// alarm.
std::int64_t alarms(const std::vector<double>& largest, double alarm) {
  return std::ranges::count_if(largest, [&](double capital) { return capital >= 1.0 / alarm; });
}

/// Upper limit of the number of alarms, exceeded with the probability 0.001 if each sequence has an alarm
/// with the probability `alarm`.
double limit_of(std::uint32_t sequences, double alarm) {
  const double mean = sequences * alarm;
  return mean + 3.1 * std::sqrt(mean) + 1.0;
}

// For every past the mean of the capital over the next p-value is the capital. The mean is by the midpoint
// rule in p; the normal scores have integrable peaks at the ends.
TEST(ChangeMartingale, IsAMartingaleForUniformPValues) {
  for (const std::int64_t baseline : {1, 20, 1000}) {
    random::NumberSource numbers = numbers_of("martingale", static_cast<std::uint32_t>(baseline));
    ChangeMartingale martingale(baseline);
    EXPECT_NEAR(martingale.capital(), 1.0, 1e-12);
    for (int t = 0; t < 60; ++t) {
      if (t % 20 == 0) {
        constexpr int nodes = 40'000;
        double mean = 0.0;
        for (int i = 0; i < nodes; ++i) {
          ChangeMartingale next = martingale;
          next.update((i + 0.5) / nodes);
          mean += next.capital() / nodes;
        }
        EXPECT_NEAR(mean, martingale.capital(), 2e-3 * martingale.capital()) << baseline << ' ' << t;
      }
      martingale.update(0.7 * numbers.uniform());
    }
  }
}

TEST(ChangeMartingale, SeldomGivesAFalseAlarm) {
  for (const Moves kind : {Moves::lognormal, Moves::tied, Moves::binary})
    for (const std::int64_t baseline : {20, 200}) {
      const std::vector<double> largest =
          largest_capitals({.kind = kind, .baseline = baseline, .moves = 1000}, 200);
      EXPECT_LE(alarms(largest, 0.05), limit_of(200, 0.05)) << name_of(kind) << ' ' << baseline;
    }
}

TEST(ChangeMartingale, DISABLED_KeepsItsBoundIn1000SequencesOf10000Moves) {
  for (const Moves kind : {Moves::lognormal, Moves::tied, Moves::binary})
    for (const std::int64_t baseline : {20, 200, 2000}) {
      const std::vector<double> largest = largest_capitals({.kind = kind, .baseline = baseline}, 1000);
      for (const double alarm : {0.05, 0.01, 0.001})
        EXPECT_LE(alarms(largest, alarm), limit_of(1000, alarm))
            << name_of(kind) << ' ' << baseline << ' ' << alarm;
    }
}

// The p-values among the baseline alone do not have this: with 20 moves it is wrong for ever.
TEST(ChangeMartingale, KeepsItsBoundWithASmallBaseline) {
  EXPECT_LE(alarms(largest_capitals({.baseline = 2, .moves = 2000}, 200), 0.05), limit_of(200, 0.05));
}

TEST(ChangeMartingale, FindsAChangeAndItsTime) {
  for (const double factor : {0.8, 1.25}) {
    std::vector<double> errors;
    for (std::uint32_t i = 0; i < 40; ++i) {
      random::NumberSource numbers = numbers_of("since", i);
      std::vector<double> baseline;
      for (int k = 0; k < 200; ++k) baseline.push_back(move_value(Moves::lognormal, numbers));
      monitor::ChangeTest test({baseline}, {1, 2});
      std::vector<double> p;
      while (test.martingale().capital() < 1000.0 && std::ssize(p) < 2000)
        p.push_back(test.update(move_value(Moves::lognormal, numbers, std::ssize(p) >= 500 ? factor : 1.0)));
      ASSERT_LT(std::ssize(p), 700);
      ASSERT_GT(std::ssize(p), 500);
      EXPECT_EQ(test.martingale().direction(), factor > 1.0 ? Direction::higher : Direction::lower);
      errors.push_back(std::abs(static_cast<double>(test.martingale().since(p)) - 501.0));
    }
    std::ranges::sort(errors);
    EXPECT_LE(errors[errors.size() / 2], 10.0);
  }
}

// A value belongs to the change where the likelihood ratio of N(κ, 1) and N(0, 1) at its normal score z is
// above 1, exp(κz − κ²/2): from z = κ/2 on. Here κ falls from 1.02 to 1.00 over the first 20 values.
TEST(ChangeMartingale, DatesAChangeByTheLikelihoodRatioOfNormalScores) {
  for (const auto& [score, since] : {std::pair(0.46, 21), {0.56, 1}}) {
    std::vector<double> p(20, numerics::normal_probability(-score));
    for (double quantile = 0.9975; quantile > 0.0; quantile -= 0.005)
      p.push_back(numerics::normal_probability(-1.0 - numerics::normal_quantile(quantile)));
    ChangeMartingale martingale(1000);
    for (const double one : p) martingale.update(one);
    EXPECT_EQ(martingale.since(p), since) << score;
  }
}

TEST(ChangeMartingale, StaysFiniteIfTheChangeIsCertain) {
  ChangeMartingale martingale(100'000);
  for (int t = 0; t < 50'000; ++t) martingale.update(1e-6);
  EXPECT_TRUE(std::isfinite(martingale.capital()));
  EXPECT_GT(martingale.capital(), 1e100);
}

// Ranks in a growing multiset.

TEST(RankedBag, CountsLargerAndEqualValuesLikeALinearSearch) {
  random::NumberSource numbers = numbers_of("bag", 0);
  std::vector<double> all;
  for (int i = 0; i < 30; ++i) all.push_back(std::rint(20.0 * numbers.uniform()));
  monitor::RankedBag bag(all);
  for (int i = 0; i < 500; ++i) {
    const double value = i % 50 == 0 ? HUGE_VAL : std::rint(20.0 * numbers.uniform());
    const monitor::RankedBag::Place place = bag.place_of(value);
    EXPECT_EQ(place.above, std::ranges::count_if(all, [&](double one) { return one > value; }));
    EXPECT_EQ(place.equal, std::ranges::count(all, value));
    bag.insert(value);
    all.push_back(value);
    EXPECT_EQ(bag.size(), std::ssize(all));
  }
}

// Whether the order of a baseline's values tells that they are not exchangeable; groups that are.

Dependence dependence_of(const std::vector<double>& values, std::uint32_t number = 0) {
  return monitor::dependence_of(values, std::vector<std::size_t>(values.size(), 0), {7, number});
}

/// Number of sequences of days without a change that are flagged: their p-value of dependence within a day is
/// at most 0.05.
int flagged(double correlation, std::int64_t days, int sequences) {
  int found = 0;
  for (int i = 0; i < sequences; ++i) {
    random::NumberSource numbers = numbers_of("dependence", static_cast<std::uint32_t>(i));
    const Days of{.correlation = correlation};
    found += dependence_of(times_of_days(of, days, 1.0, numbers), static_cast<std::uint32_t>(i)).p <= 0.05;
  }
  return found;
}

// p is exact: of exchangeable values one in a hundred has p ≤ 0.01, and half have p ≤ 0.5.
TEST(Dependence, PValueIsUniformForExchangeableValues) {
  int half = 0;
  int hundredth = 0;
  constexpr int sequences = 300;
  for (int i = 0; i < sequences; ++i) {
    random::NumberSource numbers = numbers_of("exchangeable", static_cast<std::uint32_t>(i));
    std::vector<double> values = numbers.normals(60);
    if (i % 3 == 0)
      for (double& value : values) value = std::rint(value);
    const double p = dependence_of(values, static_cast<std::uint32_t>(i)).p;
    half += p <= 0.5 ? 1 : 0;
    hundredth += p <= 0.01 ? 1 : 0;
  }
  EXPECT_NEAR(half, 150, 35);
  EXPECT_LE(hundredth, 9);
}

// Days that differ by so little that neighbouring moves hardly correlate.
TEST(Dependence, FindsSmallDifferencesBetweenDays) {
  EXPECT_LE(flagged(0.0, 6, 40), 6);
  EXPECT_GE(flagged(0.1, 6, 40), 24);
  EXPECT_GE(flagged(0.05, 20, 40), 28);
}

TEST(Dependence, FindsAlternatingValues) {
  random::NumberSource numbers = numbers_of("alternating", 0);
  for (const int period : {2, 3, 4}) {
    std::vector<double> values;
    for (int i = 0; i < 120; ++i) values.push_back(static_cast<double>(i % period) + 0.5 * numbers.normal());
    const Dependence found = dependence_of(values);
    EXPECT_LE(found.p, 0.01) << period;
    EXPECT_TRUE(found.alternates) << period;
  }
}

TEST(Dependence, LooksWithinClasses) {
  random::NumberSource numbers = numbers_of("classes", 0);
  std::vector<double> values;
  std::vector<std::size_t> classes;
  for (int i = 0; i < 200; ++i) {
    classes.push_back(static_cast<std::size_t>(i) % 2);
    values.push_back(static_cast<double>(i % 2) * 100.0 + numbers.normal());
  }
  EXPECT_LE(dependence_of(values).p, 0.01);
  EXPECT_GT(monitor::dependence_of(values, classes, {7, 0}).p, 0.01);
  EXPECT_GT(monitor::part_between(values, classes), 0.74) << "the ranks of two classes apart: 3/4";
}

TEST(Groups, RaiseNoMoreFalseAlarmsThanRequested) {
  constexpr std::uint32_t sequences = 60;
  const Days days{.baseline = 6, .days = 60, .correlation = 0.1};
  int by_day = 0;
  int by_move = 0;
  for (std::uint32_t i = 0; i < sequences; ++i) {
    by_day += monitor_of_days(days, {.alarm = 0.05, .group = "day"}, i).measures()[0].alarm_at ? 1 : 0;
    by_move += monitor_of_days(days, {.alarm = 0.05}, i).measures()[0].alarm_at ? 1 : 0;
  }
  EXPECT_LE(by_day, 8) << "3 are allowed on average";
  EXPECT_GE(by_move, 40) << "moves of a day are not exchangeable with those of another";
}

TEST(Groups, FindAChangeOfMostMoves) {
  const Days days{.baseline = 20, .days = 60, .correlation = 0.1, .factor = 1.25};
  int seen = 0;
  for (std::uint32_t i = 0; i < 10; ++i) {
    const monitor::MachineMonitor machine = monitor_of_days(days, {.group = "day"}, i);
    const auto& state = machine.measures()[0];
    if (!state.alarm_at) continue;
    ++seen;
    EXPECT_EQ(*state.direction, monitor::Direction::higher);
    EXPECT_EQ(*state.alarm_at % 50, 0) << "the last move of a day";
    EXPECT_EQ(*state.since % 50, 1);
  }
  EXPECT_GE(seen, 9);
}

// The last day may go on, and the first may be the baseline's last one.
TEST(Groups, AreCompleteBeforeTheyAreJudged) {
  const auto values = [](const std::string& before, const std::string& after) {
    const monitor::MoveLog log = log_of(after, "moves.csv", "day");
    monitor::MachineMonitor machine(monitor::baseline_of(log_of(before, "baseline.csv", "day")), log,
                                    {.group = "day"});
    machine.update(log);
    return std::pair(machine.values(), machine.continued());
  };
  const std::string before = "day,arrival_time\nMon,1\nMon,2\nTue,3\n";
  EXPECT_EQ(values(before, "day,arrival_time\nWed,1\nWed,2\n"), std::pair(0L, 0L));
  EXPECT_EQ(values(before, "day,arrival_time\nWed,1\nWed,2\nThu,1\n"), std::pair(1L, 0L));
  EXPECT_EQ(values(before, "day,arrival_time\nTue,1\nTue,2\nWed,1\nThu,1\n"), std::pair(1L, 2L));
  EXPECT_EQ(values(before, "day,arrival_time\nMon,1\nTue,1\nMon,1\n"), std::pair(2L, 0L)) << "of other weeks";
}

TEST(Groups, NeedTheirColumn) {
  const auto message = [](const std::string& text, ExitCode code) {
    return refusal_by([&] { log_of(text, "moves.csv", "day"); }, code);
  };
  EXPECT_EQ(message("shift,arrival_time\n1,2\n", ExitCode::bad_input),
            "moves.csv:1: has no column 'day' (--group); expected one of shift, arrival_time");
  EXPECT_EQ(message("day,arrival_time\n1,2\n,2\n", ExitCode::bad_data),
            "moves.csv:3: day is empty; expected the group of the move");
}

}  // namespace
}  // namespace zerocount::testing
