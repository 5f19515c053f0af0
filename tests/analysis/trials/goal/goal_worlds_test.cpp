// The verdict by a goal in a study with worlds: the goal has to be met in every one.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/trials/goal/goal_verdict.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/each_seed.hpp"

namespace zerocount::goal {
namespace {

/// Counts of trials with one move each in several worlds (possible sets of the values that all machines
/// share). met[world] of the trials in a world meet the goal.
/// @param trials number of trials in each world
measures::CellCounts counts_in_worlds(const std::vector<std::int64_t>& met, std::int64_t trials) {
  const std::int64_t worlds = std::ssize(met);
  measures::CellCounts counts({.worlds = worlds});
  for (std::int64_t i = 0; i < trials * worlds; ++i)
    counts.add(i, 1, i / worlds < met[static_cast<std::size_t>(i % worlds)] ? 1 : 0);
  return counts;
}

void expect_equal_bounds(const BoundedProportion& one, const BoundedProportion& other) {
  EXPECT_EQ(one.low, other.low);
  EXPECT_EQ(one.high, other.high);
  if (!std::isnan(one.value) || !std::isnan(other.value)) {
    EXPECT_EQ(one.value, other.value);
  }
}

TEST(GoalInWorlds, IsMetIfEveryWorldMeetsItAndMissedIfOneMissesIt) {
  const study::Goal goal{.within = 0.05, .moves = 0.95, .confidence = 0.9};
  const auto status = [&](const std::vector<std::int64_t>& met) {
    return judge_goal(goal, counts_in_worlds(met, 1000), 1).status;
  };
  EXPECT_EQ(status({1000, 1000, 1000}), Status::met);
  EXPECT_EQ(status({990, 980, 990}), Status::met);
  EXPECT_EQ(status({990, 950, 990}), Status::undecided);
  EXPECT_EQ(status({990, 900, 990}), Status::missed);
  EXPECT_EQ(status({990, 900, 950}), Status::missed);
}

// Clopper and Pearson's bounds of the worst world: the lower one without correction, the upper one with the
// confidence that each of three must have.
TEST(GoalInWorlds, BoundsAreThoseOfTheWorstWorld) {
  const study::Goal goal{.within = 0.05, .moves = 0.95, .confidence = 0.9};
  const double each = 1.0 - 0.1 / 3.0;
  const Verdict verdict = judge_goal(goal, counts_in_worlds({990, 940, 970}, 1000), 1);
  EXPECT_EQ(verdict.moves.value, 0.94);
  EXPECT_NEAR(verdict.moves.low, statistics::proportion_at_least(940, 1000, 0.9), 1e-9);
  EXPECT_NEAR(verdict.moves.high, statistics::proportion_at_most(940, 1000, each), 1e-9);
  EXPECT_EQ(worst_worlds_first(goal, verdict), (std::vector<std::size_t>{1, 2, 0}));
}

/// A random study whose worlds (possible sets of the values that all machines share) have different
/// proportions of good moves, with or without machines, and a goal near these proportions.
struct RatesInWorlds {
  static constexpr unsigned seeds = 200;
  explicit RatesInWorlds(unsigned seed) : draws(seed) {
    if (machines > 0 && draws.chance(0.5)) goal.machines = draws.uniform(0.5, 0.9);
    std::vector<double> rates;
    for (std::int64_t world = 0; world < worlds; ++world) rates.push_back(draws.uniform(0.7, 1.0));
    for (std::int64_t i = 0; i < trials * worlds; ++i) {
      const auto world = static_cast<std::size_t>(i % worlds);
      std::int64_t met = 0;
      for (std::int64_t move = 0; move < moves; ++move) met += draws.chance(rates[world]) ? 1 : 0;
      counts.add(i, moves, met);
      alone[world].add(i / worlds, moves, met);
    }
  }

  testing::Draws draws;
  std::int64_t worlds{draws.integer(2, 6)};
  /// Number of machines in each world; 0: no trials share a machine.
  std::int64_t machines{draws.chance(0.5) ? 0 : draws.integer(5, 30)};
  std::int64_t trials{machines > 0 ? machines* draws.integer(2, 20) : draws.integer(50, 400)};
  std::int64_t moves{draws.integer(1, 2)};  ///< number of moves per trial
  std::size_t points{static_cast<std::size_t>(draws.integer(1, 4))};
  study::Goal goal{.within = 0.05,
                   .moves = draws.uniform(0.7, 0.95),
                   .machines = {},
                   .confidence = draws.uniform(0.8, 0.99)};
  measures::CellCounts counts{{.machines = machines * worlds, .worlds = worlds}};
  std::vector<measures::CellCounts> alone{std::vector(
      static_cast<std::size_t>(worlds), measures::CellCounts({.machines = machines}))};  ///< [world]
};

TEST_EACH_SEED(RatesInWorlds, TheWorstWorldDecidesWithACorrectionForItsChoice) {
  const Verdict verdict = judge_goal(goal, counts, points);
  ASSERT_EQ(verdict.worlds.size(), alone.size());
  BoundedProportion lowest_moves{1.0, 1.0, 1.0};
  BoundedProportion lowest_machines{1.0, 1.0, 1.0};
  const auto lower = [](BoundedProportion& lowest, const BoundedProportion& one) {
    lowest.value = std::min(lowest.value, one.value);
    lowest.low = std::min(lowest.low, one.low);
    lowest.high = std::min(lowest.high, one.high);
  };
  std::int64_t machines_meeting = 0;
  std::int64_t machines_without_miss = 0;
  std::vector<std::size_t> met_in;
  std::vector<std::size_t> missed_in;
  for (std::size_t world = 0; world < alone.size(); ++world) {
    const Verdict one = judge_goal(goal, alone[world], points, alone.size());
    EXPECT_EQ(verdict.worlds[world].status, one.status);
    expect_equal_bounds(verdict.worlds[world].moves, one.moves);
    expect_equal_bounds(verdict.worlds[world].machines, one.machines);
    lower(lowest_moves, one.moves);
    lower(lowest_machines, one.machines);
    machines_meeting += one.machines_meeting;
    machines_without_miss += one.machines_without_miss;
    if (one.status == Status::met) met_in.push_back(world);
    if (one.status == Status::missed) missed_in.push_back(world);
  }
  expect_equal_bounds(verdict.moves, lowest_moves);
  if (goal.machines) expect_equal_bounds(verdict.machines, lowest_machines);
  EXPECT_EQ(verdict.machines_meeting, machines_meeting);
  EXPECT_EQ(verdict.machines_without_miss, machines_without_miss);
  EXPECT_EQ(worlds_that(Status::met, verdict), met_in);
  EXPECT_EQ(worlds_that(Status::missed, verdict), missed_in);
  EXPECT_EQ(verdict.status == Status::met, met_in.size() == alone.size());
  EXPECT_EQ(verdict.status == Status::missed, !missed_in.empty());
}

TEST_EACH_SEED(RatesInWorlds, WorldsAreSortedFromTheWorst) {
  const Verdict verdict = judge_goal(goal, counts, points);
  const std::vector<std::size_t> order = worst_worlds_first(goal, verdict);
  ASSERT_EQ(order.size(), verdict.worlds.size());
  const auto rate = [&](std::size_t world) {
    return goal.machines ? verdict.worlds[world].machines.value : verdict.worlds[world].moves.value;
  };
  for (std::size_t i = 1; i < order.size(); ++i) EXPECT_LE(rate(order[i - 1]), rate(order[i]));
  std::vector<std::size_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t world = 0; world < sorted.size(); ++world) EXPECT_EQ(sorted[world], world);
}

/// Counts of the verdicts on 2000 simulated studies with 200 trials in each world. The trials of a world
/// succeed with the probability of this world.
struct JudgedStudies {
  static constexpr int studies = 2000;

  JudgedStudies(const study::Goal& goal, const std::vector<double>& rates, std::uint64_t seed) {
    testing::Draws draws(seed);
    for (int study = 0; study < studies; ++study) {
      std::vector<std::int64_t> met(rates.size(), 0);
      for (std::size_t world = 0; world < rates.size(); ++world) {
        for (int trial = 0; trial < 200; ++trial) met[world] += draws.chance(rates[world]) ? 1 : 0;
      }
      const measures::CellCounts counts = counts_in_worlds(met, 200);
      const Verdict verdict = judge_goal(goal, counts, 1);
      if (verdict.status == Status::met) ++claimed_met;
      if (verdict.status == Status::missed) ++claimed_missed;
      const std::vector<measures::MoveCounts> alone = counts.by_world();
      if (std::ranges::any_of(alone, [&](const measures::MoveCounts& world) {
            return judge_goal(goal, world, 1).status == Status::missed;
          }))
        ++missed_by_one_bound;
    }
  }

  /// Upper limit of the number of wrong claims in all studies if each study makes one with this probability:
  /// mean plus three standard deviations.
  static double largest_number(double probability) {
    return studies * probability + 3.0 * std::sqrt(studies * probability * (1.0 - probability));
  }

  int claimed_met{0};
  int claimed_missed{0};
  int missed_by_one_bound{0};  ///< number of studies with a world that alone misses the goal at confidence γ
};

TEST(GoalInWorlds, IsRarelyClaimedToBeMetIfOneWorldIsAtTheGoal) {
  const study::Goal goal{.within = 0.05, .moves = 0.95};
  const JudgedStudies judged(goal, {0.97, 0.98, 0.99, 0.999, 0.95, 0.99, 0.98, 0.999, 0.99, 0.97}, 5);
  EXPECT_LE(judged.claimed_met, JudgedStudies::largest_number(0.05));
}

// Some world is often seen below a goal that it meets, if there are many.
TEST(GoalInWorlds, IsRarelyClaimedToBeMissedIfAllWorldsAreAtTheGoal) {
  const study::Goal goal{.within = 0.05, .moves = 0.95};
  const JudgedStudies judged(goal, std::vector<double>(10, 0.95), 6);
  EXPECT_LE(judged.claimed_missed, JudgedStudies::largest_number(0.05));
  EXPECT_GE(judged.missed_by_one_bound, 0.2 * JudgedStudies::studies);
}

/// A study of 50 or 100 trials in each world whose verdict is undecided.
struct UndecidedStudy {
  std::vector<std::int64_t> met;  ///< [world] number of trials that meet the goal
  std::int64_t trials;            ///< number of trials in each world
  double goal;
  Status expected;  ///< verdict of a larger study with the same proportions
};

// The world that is easiest to be found below the goal decides; where none is below, every world has to be
// found above.
TEST(GoalNeedsInWorlds, DecideIfTheTrueRatesEqualTheObservedOnes) {
  for (const UndecidedStudy& observed : {UndecidedStudy{{97, 98, 96}, 100, 0.94, Status::met},
                                         UndecidedStudy{{99, 99}, 100, 0.98, Status::met},
                                         UndecidedStudy{{99, 91, 99}, 100, 0.95, Status::missed},
                                         UndecidedStudy{{49, 46, 45}, 50, 0.95, Status::missed},
                                         UndecidedStudy{{95, 99, 93}, 100, 0.95, Status::missed}}) {
    const study::Goal goal{.within = 0.05, .moves = observed.goal};
    const measures::CellCounts counts = counts_in_worlds(observed.met, observed.trials);
    ASSERT_EQ(judge_goal(goal, counts, 1).status, Status::undecided);
    const Needs needs = needs_of(goal, counts, 1);
    EXPECT_EQ(needs.machines, 0);
    ASSERT_GT(needs.trials, counts.sum().moves);
    ASSERT_EQ(needs.trials % counts.shape().worlds, 0);
    const auto status_of = [&](std::int64_t trials) {
      const double factor = static_cast<double>(trials) / static_cast<double>(observed.trials);
      std::vector<std::int64_t> met;
      for (const std::int64_t one : observed.met)
        met.push_back(std::llround(static_cast<double>(one) * factor));
      return judge_goal(goal, counts_in_worlds(met, trials), 1).status;
    };
    EXPECT_EQ(status_of(needs.trials / counts.shape().worlds), observed.expected);
  }
}

/// Counts of a study from the moves of the machines of all worlds.
/// @param worlds [world][machine] moves of one machine
measures::CellCounts counts_on_machines(const std::vector<std::vector<statistics::MachineMoves>>& worlds) {
  const std::size_t machines = worlds.front().size() * worlds.size();
  measures::CellCounts counts({static_cast<std::int64_t>(machines), std::ssize(worlds), 0});
  for (std::size_t machine = 0; machine < machines; ++machine)
    counts.add_machine(machine, 0, worlds[machine % worlds.size()][machine / worlds.size()]);
  return counts;
}

/// The moves of the machines of a larger study: `machines` machines with `trials` trials each, whose
/// proportions of good moves are those of the observed machines.
std::vector<statistics::MachineMoves> machines_with_rates_of(
    const std::vector<statistics::MachineMoves>& observed, std::int64_t machines, std::int64_t trials) {
  std::vector<statistics::MachineMoves> larger;
  for (std::int64_t machine = 0; machine < machines; ++machine) {
    const double place = (static_cast<double>(machine) + 0.5) / static_cast<double>(machines);
    const statistics::MachineMoves& like =
        observed[static_cast<std::size_t>(place * static_cast<double>(observed.size()))];
    larger.push_back(
        {trials, trials,
         std::llround(static_cast<double>(like.met * trials) / static_cast<double>(like.trials))});
  }
  return larger;
}

// The machines of one world need more trials each, to be told from machines below the goal; the other world
// needs more machines, because some are below it.
TEST(GoalNeedsInWorlds, AreThoseOfTheWorldThatNeedsMost) {
  const study::Goal goal{.within = 0.05, .moves = 0.85, .machines = 0.8};
  const std::vector<statistics::MachineMoves> close(20, {10, 10, 9});
  std::vector<statistics::MachineMoves> mixed(20, {10, 10, 10});
  mixed[0] = mixed[1] = {10, 10, 5};
  for (const auto& worlds :
       {std::vector{close, close}, std::vector{mixed, mixed}, std::vector{close, mixed}}) {
    const measures::CellCounts counts = counts_on_machines(worlds);
    ASSERT_EQ(judge_goal(goal, counts, 1).status, Status::undecided);
    const Needs needs = needs_of(goal, counts, 1);
    ASSERT_GT(needs.machines, 40);
    EXPECT_EQ(needs.machines % 2, 0);
    ASSERT_EQ(needs.trials % needs.machines, 0)
        << needs.trials << " trials on " << needs.machines << " machines";
    const std::int64_t of_a_machine = needs.trials / needs.machines;
    EXPECT_EQ(
        judge_goal(goal,
                   counts_on_machines({machines_with_rates_of(worlds[0], needs.machines / 2, of_a_machine),
                                       machines_with_rates_of(worlds[1], needs.machines / 2, of_a_machine)}),
                   1)
            .status,
        Status::met);
  }
}

}  // namespace
}  // namespace zerocount::goal
