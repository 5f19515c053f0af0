// The search, on problems with a known truth.
#include "analysis/tuning/search.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/analysis/tuning/made_up_problem.hpp"

namespace zerocount::tuning {
namespace {

/// The smallest time of a dense grid among the points whose rate reaches the goal.
double best_time(const MadeUpProblem& truth) {
  double best = 1.0;
  constexpr int steps = 400;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      const Values at{static_cast<double>(i) / steps, static_cast<double>(j) / steps};
      if (truth.rate(at) >= truth.goal.moves) best = std::min(best, truth.typical_time(at));
    }
  }
  return best;
}

TEST(Search, FindsTheFastestPointThatMeetsTheGoal) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const MadeUpProblem truth{.seed = seed};
    const SearchResult result = search(truth.problem(2048), {.seed = seed, .max_trials = 200'000});
    ASSERT_FALSE(result.finalists.empty());
    const Values& best = result.finalists.front().values;
    found += truth.typical_time(best) <= 1.3 * best_time(truth) && truth.rate(best) >= 0.944 ? 1 : 0;
  }
  EXPECT_GE(found, 17);
}

TEST(Search, RunsMostTrialsWhereTheDecisionIsOpen) {
  const MadeUpProblem truth;
  const SearchResult result = search(truth.problem(2048), {.seed = 1});
  EXPECT_LT(result.trials, result.points * 2048 / 2);
}

TEST(Search, DependsOnTheSeedAlone) {
  const MadeUpProblem truth;
  const SearchResult a = search(truth.problem(512), {.seed = 5, .max_trials = 50'000});
  const SearchResult b = search(truth.problem(512), {.seed = 5, .max_trials = 50'000});
  const SearchResult c = search(truth.problem(512), {.seed = 6, .max_trials = 50'000});
  EXPECT_EQ(a.finalists.front().values, b.finalists.front().values);
  EXPECT_EQ(a.trials, b.trials);
  EXPECT_NE(a.finalists.front().values, c.finalists.front().values);
}

// A condition that only the leading candidates are held against, as the margins of all machines are.
TEST(Search, KeepsConditionsThatAreCostlyToExamine) {
  const MadeUpProblem truth;
  SearchProblem problem = truth.problem(512);
  problem.verified = [](const Candidate& one) { return one.values[0] <= 0.4; };
  const SearchResult result = search(problem, {.seed = 2, .max_trials = 100'000});
  ASSERT_FALSE(result.finalists.empty());
  for (const Candidate& one : result.finalists) EXPECT_LE(one.values[0], 0.4);
}

TEST(Search, WithoutAnAdmissiblePointFindsNothing) {
  const MadeUpProblem truth;
  SearchProblem problem = truth.problem(512);
  problem.admissible = [](std::span<const Candidate> candidates) {
    return std::vector<bool>(candidates.size(), false);
  };
  EXPECT_TRUE(search(problem, {.seed = 2}).finalists.empty());
}

TEST(SearchSpace, ValuesHaveFourDigitsAndStayInTheirRanges) {
  const std::vector<study::FreeParameter> free{{.name = "a", .low = 1e-6, .high = 1e-3, .logarithmic = true},
                                               {.name = "b", .low = 0.0, .high = 12.0, .whole = true}};
  for (std::int64_t i = 0; i < 200; ++i) {
    const Values values = values_at(free, spread_place(std::vector<double>{0.1, 0.2}, i));
    EXPECT_GE(values[0], 1e-6);
    EXPECT_LE(values[0], 1e-3);
    EXPECT_EQ(values[1], std::round(values[1]));
    EXPECT_EQ(values_at(free, place_of(free, values)), values);
  }
  EXPECT_EQ(values_at(free, {0.0, 1.0}), (Values{1e-6, 12.0}));
}

}  // namespace
}  // namespace zerocount::tuning
