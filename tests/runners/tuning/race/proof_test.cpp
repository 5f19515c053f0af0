// Claims of a proof hold, however the finalists were found; the rate of the best of a search does not.
#include "runners/tuning/race/proof.hpp"

#include "runners/tuning/race/search.hpp"
#include "tests/runners/tuning/race/made_up_problem.hpp"
#include "tests/support/test.hpp"

namespace zerocount::tuning {
namespace {

GoalCounts counts_of(const MadeUpProblem& truth, const Values& at, std::uint64_t first, std::int64_t units) {
  measures::CellCounts counts;
  for (std::int64_t i = 0; i < units; ++i) {
    const ClaimResult unit = truth.result(at, first + static_cast<std::uint64_t>(i)).claims.front();
    counts.add(i, unit.moves, unit.met);
  }
  return {counts};
}

struct ProvenSearch {
  SearchResult found;
  ProvenFinalist proven;
};

/// A search on 256 units, and a proof on at most 6000.
ProvenSearch searched_and_proven(const MadeUpProblem& truth) {
  const SearchProblem searched = truth.problem(256);
  ProvenSearch both{search(searched, {.seed = truth.seed, .generations = 4}), {}};
  ProofProblem problem;
  problem.goals = {truth.goal};
  for (const Estimate& one : both.found.estimates) {
    problem.may_meet.push_back(may_meet(searched.aim, one));
    problem.margins.push_back(one.margin);
  }
  problem.first_units = [](std::size_t, std::size_t) { return std::int64_t{2000}; };
  problem.more_units = [](const GoalCounts&, std::size_t) { return std::int64_t{6000}; };
  problem.run = [&](const Attempt& attempt) -> std::optional<GoalCounts> {
    const auto first = static_cast<std::uint64_t>(attempt.number) << 16U;
    return counts_of(truth, both.found.finalists[attempt.finalist].values, first, attempt.units);
  };
  problem.rejects = [](const Attempt&) { return false; };
  problem.goes_on = [] { return true; };
  both.proven = prove(problem).value();
  return both;
}

TEST(Proof, ItsClaimsHoldAndThoseOfTheSearchDoNot) {
  constexpr int repetitions = 80;
  int wrong_claims = 0;
  int wrong_bounds = 0;
  int wrong_bounds_of_search = 0;
  int claims = 0;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    // The rate is nearly the same everywhere, about what the goal asks for: the search picks lucky points.
    const auto seed = static_cast<std::uint64_t>(repetition + 1);
    const MadeUpProblem truth{.seed = seed, .highest_rate = 0.94 + 0.000375 * repetition, .fall = 0.01};
    const auto [found, proven] = searched_and_proven(truth);
    const Values& at = found.finalists[proven.attempt.finalist].values;
    claims += proven.verdict.status == goal::Status::met ? 1 : 0;
    wrong_claims += proven.verdict.status == goal::Status::met && truth.rate(at) < truth.goal.moves ? 1 : 0;
    wrong_bounds += proven.verdict.moves.low > truth.rate(at) ? 1 : 0;

    const Values& best = found.finalists.front().values;
    const goal::Verdict of_search = goal::judge_goals({&truth.goal, 1}, counts_of(truth, best, 0, 256), 1);
    wrong_bounds_of_search += of_search.moves.low > truth.rate(best) ? 1 : 0;
  }
  std::cout << claims << " claims, " << wrong_claims << " of them wrong; bounds wrong: " << wrong_bounds
            << " of the proof, " << wrong_bounds_of_search << " of the best of the search\n";
  EXPECT_GT(claims, repetitions / 4);
  EXPECT_LE(wrong_claims, repetitions / 20);
  EXPECT_LE(wrong_bounds, repetitions / 20);
  EXPECT_GT(wrong_bounds_of_search, repetitions / 10);
}

// Of values that lie just within a goal, a proof may miss the best by chance.
TEST(Proof, MissesAGoalForGoodOnlyWhereNoFinalistMayMeetIt) {
  const auto lost = [](double highest_rate) {
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const MadeUpProblem truth{
          .seed = seed, .highest_rate = highest_rate, .fall = 1.0, .reliable = {0.3}, .fast = {0.7}};
      const ProvenFinalist proven = searched_and_proven(truth).proven;
      count += proven.verdict.status == goal::Status::missed && proven.all_tried ? 1 : 0;
    }
    return count;
  };
  EXPECT_LE(lost(0.956), 2);
  EXPECT_GE(lost(0.85), 38);
}

TEST(Proof, AttemptsShareTheErrorProbability) {
  double sum = 0.0;
  for (int attempt = 1; attempt <= max_attempts; ++attempt)
    sum += 1.0 / static_cast<double>(correction_of(attempt));
  EXPECT_DOUBLE_EQ(sum, 1.0);
}

TEST(Proof, GoesOnToTheNextFinalistAfterAMissAndToMoreUnitsWhenUndecided) {
  std::vector<Attempt> attempts;
  ProofProblem problem;
  problem.goals = {{.within = 1.0, .moves = 0.95}};
  problem.may_meet = {true, true};
  problem.margins = {0.1, 0.1};
  problem.first_units = [](std::size_t, std::size_t) { return std::int64_t{1000}; };
  problem.more_units = [](const GoalCounts&, std::size_t) { return std::int64_t{4000}; };
  problem.goes_on = [] { return true; };
  problem.rejects = [](const Attempt&) { return false; };
  problem.run = [&](const Attempt& attempt) -> std::optional<GoalCounts> {
    attempts.push_back(attempt);
    const double rate = attempt.finalist == 0 ? 0.8 : attempt.units == 1000 ? 0.955 : 0.97;
    measures::CellCounts counts;
    for (std::int64_t i = 0; i < attempt.units; ++i) {
      const bool met = static_cast<double>(i) < rate * static_cast<double>(attempt.units);
      counts.add(i, 1, met ? 1 : 0);
    }
    return GoalCounts{counts};
  };
  const ProvenFinalist proven = prove(problem).value();
  ASSERT_EQ(attempts.size(), 3U);
  EXPECT_EQ(attempts[1].finalist, 1U);
  EXPECT_EQ(attempts[2].finalist, 1U);
  EXPECT_EQ(attempts[2].units, 4000);
  EXPECT_EQ(proven.verdict.status, goal::Status::met);
}

// Such as margins of the sliding loop, where only the proof slides.
TEST(Proof, GoesOnToTheNextFinalistWhereItRejectsOneThatMeetsTheGoal) {
  ProofProblem problem;
  problem.goals = {{.within = 1.0, .moves = 0.95}};
  problem.may_meet = {true, true};
  problem.margins = {0.1, 0.1};
  problem.first_units = [](std::size_t, std::size_t) { return std::int64_t{1000}; };
  problem.goes_on = [] { return true; };
  problem.run = [](const Attempt& attempt) -> std::optional<GoalCounts> {
    measures::CellCounts counts;
    for (std::int64_t i = 0; i < attempt.units; ++i) counts.add(i, 1, 1);
    return GoalCounts{counts};
  };
  problem.rejects = [](const Attempt& attempt) { return attempt.finalist == 0; };
  const ProvenFinalist proven = prove(problem).value();
  EXPECT_EQ(proven.attempt.finalist, 1U);
  EXPECT_EQ(proven.verdict.status, goal::Status::met);
  problem.may_meet = {true};
  EXPECT_EQ(prove(problem).value().verdict.status, goal::Status::missed);
}

}  // namespace
}  // namespace zerocount::tuning
