// The moves of a design point in cells: those of a world, a condition or both are counted as in a study of
// their own.
#include "analysis/trials/measures/move_counts.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/basis/statistics/sums/state.hpp"
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/each_seed.hpp"

namespace zerocount::measures {
namespace {

statistics::State state_of(const CellCounts& counts) {
  statistics::State state;
  statistics::StateWriter writer(state);
  writer(counts);
  return state;
}

/// Random trials with or without machines, worlds and conditions, whose moves that meet a goal are counted.
struct CountsInCells {
  static constexpr unsigned seeds = 300;
  explicit CountsInCells(unsigned seed) : draws(seed) {
    for (std::int64_t trial = 0; trial < trials; ++trial) met.push_back(draws.integer(0, moves));
  }

  /// The counts of the trials from index `first` to before `end`.
  CellCounts counted(std::int64_t first, std::int64_t end) const {
    CellCounts counts(shape);
    for (std::int64_t trial = first; trial < end; ++trial)
      counts.add(trial, moves, met[static_cast<std::size_t>(trial)]);
    return counts;
  }
  CellCounts counted() const { return counted(0, trials); }

  CellCounts restored(const statistics::State& state, const Shape& as) const {
    statistics::StateReader reader(state.whole, state.real);
    CellCounts counts(as);
    reader(counts);
    reader.require_end();
    return counts;
  }

  /// The counts of the trials in these cells alone (a cell is a combination of machine, world and condition),
  /// made one trial after the other.
  MoveCounts alone(const Cells& cells) const {
    MoveCounts sum;
    std::vector<statistics::MachineMoves> machines(static_cast<std::size_t>(shape.machines));
    std::vector<bool> asked(machines.size(), false);
    for (std::int64_t trial = 0; trial < trials; ++trial) {
      // All machines, one after the other, under one condition after the other.
      const std::int64_t machine_count = std::max<std::int64_t>(shape.machines, 1);
      const std::int64_t conditions = std::max<std::int64_t>(shape.settings, 1);
      const std::int64_t draw =
          trial % machine_count + machine_count * (trial / (machine_count * conditions));
      if (cells.setting && !std::cmp_equal(trial / machine_count % conditions, *cells.setting)) continue;
      if (cells.world && !std::cmp_equal(draw % shape.worlds, *cells.world)) continue;
      const std::int64_t hits = met[static_cast<std::size_t>(trial)];
      sum.moves += moves;
      sum.met += hits;
      if (shape.machines == 0) {
        sum.of_trials.add(hits, moves);
      } else {
        asked[static_cast<std::size_t>(trial % machine_count)] = true;
        machines[static_cast<std::size_t>(trial % machine_count)] += {1, moves, hits};
      }
    }
    for (std::size_t machine = 0; machine < machines.size(); ++machine)
      if (asked[machine]) sum.machines.push_back(machines[machine]);
    return sum;
  }

  testing::Draws draws;
  std::int64_t worlds{draws.chance(0.4) ? 0 : draws.integer(2, 5)};
  std::int64_t conditions{draws.chance(0.4) ? 0 : draws.integer(2, 4)};
  std::int64_t machines{draws.chance(0.5) ? 0 : std::max<std::int64_t>(worlds, 1) * draws.integer(1, 4)};
  Shape shape{machines, worlds, conditions};
  std::int64_t trials{std::max<std::int64_t>(machines, 1) * std::max<std::int64_t>(conditions, 1) *
                      draws.integer(std::max<std::int64_t>(worlds, 1), 30)};
  std::int64_t moves{draws.integer(1, 3)};  ///< number of moves per trial
  std::vector<std::int64_t> met;            ///< [trial] number of moves that meet the goal
};

TEST(CellCounts, HasNoSettingsIfTheStudyHasNeitherConditionsNorAges) {
  const auto settings_of = [](const std::string& more) {
    return shape_of(
               manifest::parse_study(
                   "zerocount: 1\nname: s\nseed: 1\ntrials: 6\ncommand: {targets: [10], hold: 0.1}\n" + more,
                   "m.yaml", {}))
        .settings;
  };
  EXPECT_EQ(settings_of(""), 0);
  EXPECT_EQ(settings_of("conditions: {it: {plant.inertia: 5.0e-4}}\n"), 1);
  EXPECT_EQ(settings_of("machines: 3\nages: {at: [0, 1000], unit: h}\n"), 2);
}

TEST_EACH_SEED(CountsInCells, EqualTheCountsOfTheTrialsOfEachCell) {
  const CellCounts counts = counted();
  EXPECT_EQ(counts.sum(), alone({}));
  ASSERT_EQ(std::ssize(counts.by_world()), worlds);
  ASSERT_EQ(std::ssize(counts.by_setting()), conditions);
  for (std::size_t world = 0; std::cmp_less(world, worlds); ++world)
    EXPECT_EQ(counts.by_world()[world], alone({.world = world}));
  for (std::size_t condition = 0; condition < counts.settings(); ++condition) {
    EXPECT_EQ(counts.sum({.setting = condition}), alone({.setting = condition}));
    EXPECT_EQ(counts.in_setting(condition).sum(), alone({.setting = condition}));
    EXPECT_EQ(counts.in_setting(condition).worlds_in(0), counts.worlds_in(condition));
    for (std::size_t world = 0; std::cmp_less(world, worlds); ++world)
      EXPECT_EQ(counts.worlds_in(condition)[world], alone({condition, world}));
  }
  EXPECT_TRUE(counts.is_valid(trials, moves));
  EXPECT_FALSE(counts.is_valid(trials + 1, moves));
}

TEST_EACH_SEED(CountsInCells, PartsAddUpToTheWhole) {
  const std::int64_t cut = draws.integer(0, trials);
  CellCounts sum = counted(0, cut);
  sum += counted(cut, trials);
  EXPECT_EQ(state_of(sum).whole, state_of(counted()).whole);
  EXPECT_EQ(state_of(sum).real, state_of(counted()).real);
}

TEST_EACH_SEED(CountsInCells, AreRestoredFromAnArchiveOfTheirShape) {
  const statistics::State state = state_of(counted());
  const CellCounts same = restored(state, shape);
  EXPECT_EQ(same.sum(), counted().sum());
  EXPECT_EQ(same.by_world(), counted().by_world());
  EXPECT_EQ(state_of(same).whole, state.whole);
  EXPECT_EQ(state_of(same).real, state.real);
  Shape other = shape;
  other.settings = conditions == 0 ? 2 : 0;
  EXPECT_THROW(restored(state, other), Failure);
}

// Sums that contradict each other are found: all but the number of trials where nothing else counts them.
TEST_EACH_SEED(CountsInCells, ContradictoryCountsAreRefused) {
  const statistics::State state = state_of(counted());
  const bool only_one_cell = machines == 0 && worlds == 0 && conditions == 0;
  for (std::size_t i = 0; i < state.whole.size(); ++i) {
    constexpr std::size_t number_of_trials = 2;
    if (only_one_cell && i == number_of_trials) continue;
    statistics::State damaged = state;
    ++damaged.whole[i];
    const auto is_accepted = [&] {
      try {
        return restored(damaged, shape).is_valid(trials, moves);
      } catch (const Failure&) {
        return false;
      }
    };
    EXPECT_FALSE(is_accepted()) << "number " << i;
  }
}

}  // namespace
}  // namespace zerocount::measures
