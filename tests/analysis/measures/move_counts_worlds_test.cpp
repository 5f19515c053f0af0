// The moves of a design point by world: each world is counted as if it were a study of its own.
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/measures/move_counts.hpp"
#include "analysis/statistics/sums/state.hpp"
#include "core/failure/failure.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/each_seed.hpp"

namespace zerocount::measures {
namespace {

using Numbers = std::pair<std::vector<std::int64_t>, std::vector<double>>;

/// Every number of the counts.
Numbers numbers_of(const MoveCounts& counts) {
  statistics::State state;
  statistics::StateWriter writer(state);
  writer(counts);
  return {state.whole, state.real};
}

std::vector<Numbers> numbers_of(const std::vector<MoveCounts>& worlds) {
  std::vector<Numbers> numbers;
  for (const MoveCounts& world : worlds) numbers.push_back(numbers_of(world));
  return numbers;
}

/// Random trials in some worlds, on rigs or not. Without rigs the worlds may differ by a trial.
struct CountsByWorld {
  static constexpr unsigned seeds = 200;
  explicit CountsByWorld(unsigned seed) : draws(seed) {
    const std::int64_t trials = rigs > 0 ? rigs * draws.integer(1, 8) : draws.integer(worlds, 20 * worlds);
    for (std::int64_t trial = 0; trial < trials; ++trial) met.push_back(draws.integer(0, moves));
  }

  std::int64_t trials() const { return std::ssize(met); }

  /// The counts of the trials from `first` to before `end`.
  MoveCounts counted(std::int64_t first, std::int64_t end) const {
    MoveCounts counts;
    counts.worlds = worlds;
    for (std::int64_t trial = first; trial < end; ++trial)
      counts.add(trial, rigs, moves, met[static_cast<std::size_t>(trial)]);
    return counts;
  }
  MoveCounts counted() const { return counted(0, trials()); }

  /// [world] counted alone: trial i of all is its trial i div worlds.
  std::vector<MoveCounts> counted_alone() const {
    std::vector<MoveCounts> alone(static_cast<std::size_t>(worlds));
    for (std::int64_t trial = 0; trial < trials(); ++trial) {
      alone[static_cast<std::size_t>(trial % worlds)].add(trial / worlds, rigs / worlds, moves,
                                                          met[static_cast<std::size_t>(trial)]);
    }
    return alone;
  }

  testing::Draws draws;
  std::int64_t worlds{draws.integer(2, 7)};
  std::int64_t rigs{draws.chance(0.5) ? 0 : worlds * draws.integer(1, 5)};
  std::int64_t moves{draws.integer(1, 3)};  ///< of a trial
  std::vector<std::int64_t> met;            ///< [trial]
};

TEST_EACH_SEED(CountsByWorld, AreThoseOfEachWorldAlone) {
  const MoveCounts counts = counted();
  EXPECT_EQ(numbers_of(in_worlds(counts)), numbers_of(counted_alone()));
  EXPECT_TRUE(counts.is_valid(trials(), moves, rigs));
}

TEST_EACH_SEED(CountsByWorld, AddUpToThoseWithoutWorlds) {
  MoveCounts counts = counted();
  MoveCounts sum;
  for (const MoveCounts& world : in_worlds(counts)) {
    sum.moves += world.moves;
    sum.met += world.met;
    sum.of_trials += world.of_trials;
  }
  EXPECT_EQ(sum.moves, trials() * moves);
  EXPECT_EQ(sum.met, counts.met);
  sum.rigs = counts.rigs;
  counts.worlds = 0;
  counts.of_worlds.clear();
  EXPECT_EQ(numbers_of(sum), numbers_of(counts));
  EXPECT_TRUE(in_worlds(counts).empty());
}

TEST_EACH_SEED(CountsByWorld, OfPartsAddUpToThoseOfTheWhole) {
  const std::int64_t first_cut = draws.integer(0, trials());
  const std::int64_t second_cut = draws.integer(first_cut, trials());
  MoveCounts sum = counted(0, first_cut);
  sum += counted(first_cut, second_cut);
  sum += counted(second_cut, trials());
  EXPECT_EQ(numbers_of(sum), numbers_of(counted()));
  EXPECT_EQ(numbers_of(in_worlds(sum)), numbers_of(counted_alone()));
}

TEST_EACH_SEED(CountsByWorld, AreRestoredFromAnArchive) {
  const auto [whole, real] = numbers_of(counted());
  statistics::StateReader reader(whole, real);
  MoveCounts restored_counts;
  restored_counts.worlds = worlds;
  reader(restored_counts);
  EXPECT_NO_THROW(reader.require_end());
  EXPECT_EQ(numbers_of(restored_counts), numbers_of(counted()));
  EXPECT_EQ(numbers_of(in_worlds(restored_counts)), numbers_of(counted_alone()));

  statistics::StateReader other(whole, real);
  MoveCounts without_worlds;
  other(without_worlds);
  EXPECT_THROW(other.require_end(), Failure);
}

TEST_EACH_SEED(CountsByWorld, ThatDoNotAddUpAreImpossible) {
  const MoveCounts counts = counted();
  EXPECT_FALSE(counts.is_valid(trials() + 1, moves, rigs));
  if (rigs > 0) return;
  MoveCounts more_hits = counts;
  ++more_hits.of_worlds.back().hits;
  EXPECT_FALSE(more_hits.is_valid(trials(), moves, rigs));
  MoveCounts more_events = counts;
  ++more_events.of_worlds.front().events;
  EXPECT_FALSE(more_events.is_valid(trials(), moves, rigs));
  MoveCounts one_less = counts;
  one_less.of_worlds.pop_back();
  EXPECT_FALSE(one_less.is_valid(trials(), moves, rigs));
}

// Each condition is counted as a study of its own, of the draws: by rig, by world, and added from parts.
TEST(MoveCounts, TellConditionsApart) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    testing::Draws draws(seed);
    const std::int64_t conditions = draws.integer(1, 4);
    const std::int64_t worlds = draws.integer(0, 3);
    const std::int64_t rigs = draws.integer(0, 1) * 2 * std::max<std::int64_t>(worlds, 1);
    const std::int64_t of_each = std::max<std::int64_t>(rigs, 1) * draws.integer(1, 6);
    const auto empty = [&] {
      MoveCounts counts;
      counts.tell_apart(worlds, conditions);
      return counts;
    };
    MoveCounts all = empty(), first = empty(), rest = empty();
    std::vector<MoveCounts> alone(static_cast<std::size_t>(conditions));
    for (MoveCounts& one : alone) one.worlds = worlds;
    const std::int64_t turn = std::max<std::int64_t>(rigs, 1);
    const std::int64_t cut = draws.integer(0, of_each * conditions);
    for (std::int64_t trial = 0; trial < of_each * conditions; ++trial) {
      const std::int64_t met = draws.integer(0, 3);
      all.add(trial, rigs, 3, met);
      (trial < cut ? first : rest).add(trial, rigs, 3, met);
      alone[static_cast<std::size_t>(trial / turn % conditions)].add(
          trial % turn + turn * (trial / (turn * conditions)), rigs, 3, met);
    }
    EXPECT_EQ(numbers_of(in_conditions(all)), numbers_of(alone));
    EXPECT_TRUE(all.is_valid(of_each * conditions, 3, rigs));
    first += rest;
    EXPECT_EQ(numbers_of(first), numbers_of(all));
    const auto [whole, real] = numbers_of(all);
    statistics::StateReader reader(whole, real);
    MoveCounts restored = empty();
    reader(restored);
    EXPECT_EQ(numbers_of(restored), numbers_of(all));
    ++all.of_conditions.front().met;
    EXPECT_FALSE(all.is_valid(of_each * conditions, 3, rigs));
  }
}

}  // namespace
}  // namespace zerocount::measures
