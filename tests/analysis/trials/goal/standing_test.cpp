// Which of several claims, conditions or design points is the worst.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/trials/goal/question.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/each_seed.hpp"

namespace zerocount::goal {
namespace {

double log_odds(double p) {
  return std::log(p / (1.0 - p));
}

/// The numbers by which verdicts on goals are ranked, computed from the definition; number 0 is compared
/// first.
std::vector<double> places_of(const ClaimVerdict& claim, const study::Goal& goal) {
  const double status = claim.status == Status::missed ? 0.0 : claim.status == Status::undecided ? 1.0 : 2.0;
  const BoundedProportion& claimed = goal.machines ? claim.machines : claim.moves;
  const double wanted = study::demanded_proportion(goal);
  return {status, log_odds(claimed.low) - log_odds(wanted), log_odds(claimed.value) - log_odds(wanted),
          log_odds(claim.moves.low) - log_odds(goal.moves),
          log_odds(claim.moves.value) - log_odds(goal.moves)};
}

/// One or two goals on a few random machines under several conditions, some of which have nearly the same
/// results.
struct FewMachines {
  static constexpr unsigned seeds = 300;

  explicit FewMachines(unsigned seed) : draws(seed) {
    const std::int64_t number = draws.integer(1, 2);
    for (std::int64_t i = 0; i < number; ++i) {
      goals.push_back({.within = 0.05, .moves = draws.chance(0.5) ? 0.8 : 0.9, .machines = {}});
      if (draws.chance(0.5)) goals.back().machines = 0.9;
      measures::CellCounts& of_goal = counts.emplace_back(measures::Shape{machines, 0, conditions});
      for (std::int64_t c = 0; c < conditions; ++c) {
        const double rate = draws.chance(0.3) ? 1.0 : draws.uniform(0.5, 1.0);
        for (std::int64_t machine = 0; machine < machines; ++machine) {
          std::int64_t met = 0;
          for (std::int64_t move = 0; move < moves; ++move) met += draws.chance(rate) ? 1 : 0;
          of_goal.add_machine(static_cast<std::size_t>(machine), static_cast<std::size_t>(c),
                              {moves, moves, met});
        }
      }
    }
  }

  testing::Draws draws;
  std::int64_t machines{draws.integer(2, 8)};
  std::int64_t conditions{draws.integer(2, 4)};
  std::int64_t moves{draws.integer(5, 40)};
  std::vector<study::Goal> goals;
  std::vector<measures::CellCounts> counts;
};

TEST_EACH_SEED(FewMachines, EqualBoundsAreRankedByTheObservedProportions) {
  const Verdict verdict = judge_goals(goals, counts, 1);
  std::vector<std::vector<double>> places;
  for (const ClaimVerdict& claim : verdict.claims) places.push_back(places_of(claim, goals[claim.goal]));
  const auto worst = static_cast<std::size_t>(std::ranges::min_element(places) - places.begin());
  EXPECT_EQ(verdict.goal, verdict.claims[worst].goal);
  EXPECT_EQ(verdict.setting, verdict.claims[worst].setting);
  for (std::size_t c = 0; c < static_cast<std::size_t>(conditions); ++c) {
    const ClaimVerdict& under =
        worst_where(verdict, [c](const ClaimVerdict& claim) { return claim.setting == c; });
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (verdict.claims[i].setting == c) {
        EXPECT_LE(places_of(under, goals[under.goal]), places[i]);
      }
    }
  }
}

// A study of few machines shows nothing of a proportion of machines: its bounds are 0 under every condition.
TEST(Standing, ObservedMachinesRankClaimsWithEqualBounds) {
  const study::Goal goal{.within = 0.05, .moves = 0.9, .machines = 0.9};
  measures::CellCounts counts({.machines = 3, .settings = 3});
  const std::vector<std::vector<std::int64_t>> met{{5, 5, 5}, {5, 5, 4}, {5, 5, 5}};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t machine = 0; machine < 3; ++machine)
      counts.add_machine(machine, c, {5, 5, met[c][machine]});
  }
  const Verdict verdict = judge_goal(goal, counts, 1);
  for (const ClaimVerdict& claim : verdict.claims) ASSERT_EQ(claim.machines.low, 0.0);
  EXPECT_EQ(verdict.setting, 1U);
}

/// [condition] made-up settling times of the moves: 95 % of the moves need this fraction of the time that is
/// allowed.
std::vector<measures::SettlingTimes> settling_after(const std::vector<double>& parts_of_time) {
  std::vector<measures::SettlingTimes> all;
  for (const double part : parts_of_time) {
    measures::SettlingTimes& one = all.emplace_back();
    one.allowed = 0.05;
    one.time_ratio = part;
  }
  return all;
}

/// A design point with five machines. `met` of 100 moves of each machine meet a goal, 95 % of them within the
/// fraction `part_of_time` of the allowed time.
measures::PointSummary point_with(std::int64_t met, double part_of_time) {
  measures::PointSummary point;
  measures::CellCounts counts({.machines = 5});
  for (std::size_t machine = 0; machine < 5; ++machine) counts.add_machine(machine, 0, {100, 100, met});
  point.goals = {counts};
  point.goal_settling = {settling_after({part_of_time})};
  return point;
}

Question question_of_goal() {
  Question question;
  question.parts.front().goal = study::Goal{.within = 0.05, .moves = 0.95};
  return question;
}

// The bounds of points without a miss are equal, and then the faster one is the better. No miss makes a point
// better.
TEST(Standing, ObservedProportionsRankPointsBeforeTimes) {
  Question question = question_of_goal();
  const auto is_better = [&](const measures::PointSummary& a, const measures::PointSummary& b) {
    return merits_of(question, a) > merits_of(question, b);
  };
  for (std::int64_t met = 50; met < 100; ++met)
    EXPECT_TRUE(is_better(point_with(met + 1, 0.9), point_with(met, 0.1))) << met;
  EXPECT_TRUE(is_better(point_with(100, 0.2), point_with(100, 0.3)));
  question.parts.front().goal->machines = 0.9;
  EXPECT_TRUE(is_better(point_with(60, 0.9), point_with(50, 0.1))) << "of machines none meets it in either";
}

// Of conditions that are alike in all proportions the slowest is the worst: the time beside them is its own.
TEST(Standing, TheLaterOfEqualConditionsCountsAsTheWorst) {
  Question question = question_of_goal();
  question.settings.conditions = {"empty", "loaded", "cold"};
  measures::PointSummary point;
  measures::CellCounts counts({.machines = 5, .settings = 3});
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t machine = 0; machine < 5; ++machine) counts.add_machine(machine, c, {20, 20, 20});
  }
  point.goals = {counts};
  point.goal_settling = {settling_after({0.4, std::numeric_limits<double>::infinity(), 0.6})};
  EXPECT_EQ(verdict_on(question, point).setting, 1U);
  EXPECT_EQ(&settling_of(question, point), &point.goal_settling[0][1].times);
  point.goal_settling[0][1].time_ratio = 0.5;
  EXPECT_EQ(verdict_on(question, point).setting, 2U);
}

}  // namespace
}  // namespace zerocount::goal
