// The settling times of the moves that a goal asks, under each condition.
#include "analysis/trials/measures/goal_settling.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/basis/statistics/sums/state.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/each_seed.hpp"

namespace zerocount::measures {
namespace {

/// Random trials, one in five of whose moves never settles, and a goal that judges some of the moves.
struct GoalSettlingTimes {
  static constexpr unsigned seeds = 100;

  explicit GoalSettlingTimes(unsigned seed) : draws(seed) {
    goal.settling = Settling::in_band;
    for (std::int64_t move = 0; move < moves; ++move)
      if (draws.chance(0.5)) goal.on.push_back(move);
    if (goal.on.empty()) goal.on.push_back(0);
    goal.within = {draws.uniform(0.01, 0.2), draws.chance(0.5)};
    for (std::int64_t trial = 0; trial < trials; ++trial) {
      std::vector<trial::MoveOutcome>& outcomes = of_trials.emplace_back(moves);
      for (std::int64_t move = 0; move < moves; ++move) {
        trial::MoveOutcome& outcome = outcomes[static_cast<std::size_t>(move)];
        outcome.number = move;
        outcome.travel_time = draws.uniform(0.0, 0.3);
        outcome.bands[0].settling_time = draws.chance(0.2) ? std::numeric_limits<double>::quiet_NaN()
                                                           : 0.01 * static_cast<double>(draws.integer(0, 20));
      }
    }
  }

  double allowed(const trial::MoveOutcome& move) const {
    return goal.within.after_profile ? move.travel_time + goal.within.time : goal.within.time;
  }

  /// The sorted settling times (s) of the judged moves under a condition, each divided by `scale` of its
  /// move; infinite for a move that never settles.
  template <class Scale>
  std::vector<double> times_under(std::int64_t condition, Scale scale) const {
    const study::TrialIndices indices{.machines = std::max<std::int64_t>(machines, 1),
                                      .settings = {.conditions = conditions}};
    std::vector<double> times;
    for (std::int64_t trial = 0; trial < trials; ++trial) {
      if (indices.setting_of(trial) != condition) continue;
      for (const std::int64_t move : goal.on) {
        const trial::MoveOutcome& outcome =
            of_trials[static_cast<std::size_t>(trial)][static_cast<std::size_t>(move)];
        const double time = outcome.bands[0].settling_time / scale(outcome);
        times.push_back(std::isnan(time) ? std::numeric_limits<double>::infinity() : time);
      }
    }
    std::ranges::sort(times);
    return times;
  }

  GoalSettling of(std::int64_t first, std::int64_t end) const {
    GoalSettling settling(goal, {.machines = machines, .settings = conditions});
    for (std::int64_t trial = first; trial < end; ++trial)
      settling.add(trial, goal, of_trials[static_cast<std::size_t>(trial)]);
    return settling;
  }

  testing::Draws draws;
  std::int64_t conditions{draws.integer(1, 3)};
  std::int64_t machines{draws.chance(0.5) ? 0 : draws.integer(2, 6)};
  std::int64_t trials{std::max<std::int64_t>(machines, 1) * conditions * draws.integer(4, 20)};
  std::int64_t moves{draws.integer(1, 4)};
  MoveCriterion goal;
  std::vector<std::vector<trial::MoveOutcome>> of_trials;
};

/// The quantile of sorted settling times; NaN if it is infinite.
double quantile_of(const std::vector<double>& times, double probability) {
  const auto rank =
      static_cast<std::size_t>(std::ceil(probability * static_cast<double>(times.size()) - 1e-9));
  const double time = times[std::max<std::size_t>(rank, 1) - 1];
  return std::isinf(time) ? std::numeric_limits<double>::quiet_NaN() : time;
}

void expect_same(double found, double expected) {
  if (std::isnan(expected)) {
    EXPECT_TRUE(std::isnan(found)) << found;
  } else {
    EXPECT_EQ(found, expected);
  }
}

TEST_EACH_SEED(GoalSettlingTimes, CoverTheJudgedMovesUnderEachCondition) {
  const std::vector<SettlingTimes> found = of(0, trials).statistics(0.95);
  ASSERT_EQ(std::ssize(found), conditions);
  for (std::int64_t condition = 0; condition < conditions; ++condition) {
    const std::vector<double> times = times_under(condition, [](const auto&) { return 1.0; });
    const MeasureStatistics& one = found[static_cast<std::size_t>(condition)].times;
    EXPECT_EQ(one.moves, std::ssize(times));
    EXPECT_EQ(one.n, std::ranges::count_if(times, [](double time) { return std::isfinite(time); }));
    expect_same(one.median.value, quantile_of(times, 0.5));
    expect_same(one.p95.value, quantile_of(times, 0.95));
    const std::vector<double> ratios =
        times_under(condition, [&](const trial::MoveOutcome& move) { return allowed(move); });
    const double ratio = quantile_of(ratios, 0.95);
    EXPECT_DOUBLE_EQ(found[static_cast<std::size_t>(condition)].time_ratio,
                     std::isnan(ratio) ? std::numeric_limits<double>::infinity() : ratio);
    double longest = goal.within.after_profile ? 0.0 : goal.within.time;
    const study::TrialIndices indices{.machines = std::max<std::int64_t>(machines, 1),
                                      .settings = {.conditions = conditions}};
    for (std::int64_t trial = 0; trial < trials; ++trial)
      for (const std::int64_t move : goal.on)
        if (indices.setting_of(trial) == condition)
          longest = std::max(
              longest, allowed(of_trials[static_cast<std::size_t>(trial)][static_cast<std::size_t>(move)]));
    EXPECT_EQ(found[static_cast<std::size_t>(condition)].allowed, longest);
  }
}

TEST_EACH_SEED(GoalSettlingTimes, DoNotDependOnTheDivisionOfTheTrials) {
  const GoalSettling whole = of(0, trials);
  GoalSettling parts = of(0, trials / 3);
  parts += of(trials / 3, trials);
  statistics::State state;
  statistics::StateWriter writer(state);
  GoalSettling::transfer(parts, writer);
  GoalSettling restored(goal, {.machines = machines, .settings = conditions});
  statistics::StateReader reader(state.whole, state.real);
  GoalSettling::transfer(restored, reader);
  EXPECT_TRUE(restored.is_valid(trials * asked_moves(goal, moves)));
  EXPECT_FALSE(restored.is_valid(trials * asked_moves(goal, moves) + 1));
  const auto expected = whole.statistics(0.95), found = restored.statistics(0.95);
  for (std::size_t condition = 0; condition < expected.size(); ++condition) {
    expect_same(found[condition].times.p95.value, expected[condition].times.p95.value);
    expect_same(found[condition].times.p95.low, expected[condition].times.p95.low);
    expect_same(found[condition].times.max, expected[condition].times.max);
    EXPECT_EQ(found[condition].time_ratio, expected[condition].time_ratio);
    EXPECT_EQ(found[condition].allowed, expected[condition].allowed);
  }
}

TEST(GoalSettling, CollectsNothingIfTheBandIsMeasuredForAllMoves) {
  EXPECT_TRUE(GoalSettling(MoveCriterion{.settling = Settling::in_band}, Shape{}).statistics(0.95).empty());
}

}  // namespace
}  // namespace zerocount::measures
