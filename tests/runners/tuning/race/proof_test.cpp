// Claims of a proof hold, however the finalists were found; the rate of the best of a search does not.
#include "runners/tuning/race/proof.hpp"

#include "runners/tuning/race/candidate.hpp"
#include "runners/tuning/race/search.hpp"
#include "tests/runners/tuning/race/made_up_problem.hpp"
#include "tests/support/test.hpp"

namespace zerocount::tuning {
namespace {

GoalCounts counts_of(const MadeUpProblem& truth, const Values& at, std::uint64_t first,
                     std::int64_t machines) {
  measures::CellCounts counts;
  for (std::int64_t i = 0; i < machines; ++i) {
    const ClaimResult machine = truth.result(at, first + static_cast<std::uint64_t>(i)).claims.front();
    counts.add(i, machine.moves, machine.met);
  }
  return {counts};
}

AttemptResult result_of(const study::Goal& goal, const Attempt& attempt, GoalCounts counts) {
  goal::Verdict verdict = goal::judge_goals({&goal, 1}, counts, correction_of(attempt.number));
  return {std::move(counts), std::move(verdict)};
}

struct ProvenSearch {
  SearchResult found;
  ProvenFinalist proven;
};

/// A search with 256 machines, and the proof of its result with at most 6000 machines.
ProvenSearch searched_and_proven(const MadeUpProblem& truth) {
  const SearchProblem searched = truth.problem(256);
  ProvenSearch both{search(searched, {.seed = truth.seed, .generations = 4}), {}};
  ProofProblem problem;
  for (const RateEstimate& one : both.found.estimates) {
    problem.may_meet.push_back(may_meet(searched.aim, one));
    problem.margins.push_back(one.margin);
  }
  problem.first_machines = [](std::size_t, std::size_t) { return std::int64_t{2000}; };
  problem.more_machines = [](const GoalCounts&, std::size_t) { return std::int64_t{6000}; };
  problem.run = [&](const Attempt& attempt) -> std::optional<AttemptResult> {
    const auto first = static_cast<std::uint64_t>(attempt.number) << 16U;
    return result_of(
        truth.goal, attempt,
        counts_of(truth, both.found.finalists[attempt.finalist].values, first, attempt.machines));
  };
  problem.rejects = [](const Attempt&) { return false; };
  problem.goes_on = [] { return true; };
  both.proven = prove(problem).value();
  return both;
}

TEST(Proof, ClaimsOfTheProofHoldAndThoseOfTheSearchDoNot) {
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
TEST(Proof, AGoalIsMissedOnlyIfNoFinalistMayMeetIt) {
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

TEST(Proof, AttemptsDivideTheErrorProbability) {
  double sum = 0.0;
  for (int attempt = 1; attempt <= max_attempts; ++attempt)
    sum += 1.0 / static_cast<double>(correction_of(attempt));
  EXPECT_DOUBLE_EQ(sum, 1.0);
}

TEST(Proof, TriesTheNextFinalistAfterAMissAndMoreUnitsIfUndecided) {
  std::vector<Attempt> attempts;
  const study::Goal goal{.within = 1.0, .moves = 0.95};
  ProofProblem problem;
  problem.may_meet = {true, true};
  problem.margins = {0.1, 0.1};
  problem.first_machines = [](std::size_t, std::size_t) { return std::int64_t{1000}; };
  problem.more_machines = [](const GoalCounts&, std::size_t) { return std::int64_t{4000}; };
  problem.goes_on = [] { return true; };
  problem.rejects = [](const Attempt&) { return false; };
  problem.run = [&](const Attempt& attempt) -> std::optional<AttemptResult> {
    attempts.push_back(attempt);
    const double rate = attempt.finalist == 0 ? 0.8 : attempt.machines == 1000 ? 0.955 : 0.97;
    measures::CellCounts counts;
    for (std::int64_t i = 0; i < attempt.machines; ++i) {
      const bool met = static_cast<double>(i) < rate * static_cast<double>(attempt.machines);
      counts.add(i, 1, met ? 1 : 0);
    }
    return result_of(goal, attempt, {counts});
  };
  const ProvenFinalist proven = prove(problem).value();
  ASSERT_EQ(attempts.size(), 3U);
  EXPECT_EQ(attempts[1].finalist, 1U);
  EXPECT_EQ(attempts[2].finalist, 1U);
  EXPECT_EQ(attempts[2].machines, 4000);
  EXPECT_EQ(proven.verdict.status, goal::Status::met);
}

// Such as margins of the sliding loop, where only the proof slides.
TEST(Proof, TriesTheNextFinalistIfItRejectsOneThatMeetsTheGoal) {
  const study::Goal goal{.within = 1.0, .moves = 0.95};
  ProofProblem problem;
  problem.may_meet = {true, true};
  problem.margins = {0.1, 0.1};
  problem.first_machines = [](std::size_t, std::size_t) { return std::int64_t{1000}; };
  problem.goes_on = [] { return true; };
  problem.run = [&](const Attempt& attempt) -> std::optional<AttemptResult> {
    measures::CellCounts counts;
    for (std::int64_t i = 0; i < attempt.machines; ++i) counts.add(i, 1, 1);
    return result_of(goal, attempt, {counts});
  };
  problem.rejects = [](const Attempt& attempt) { return attempt.finalist == 0; };
  const ProvenFinalist proven = prove(problem).value();
  EXPECT_EQ(proven.attempt.finalist, 1U);
  EXPECT_EQ(proven.verdict.status, goal::Status::met);
  EXPECT_TRUE(proven.keeps_margins);
  problem.may_meet = {true};
  const ProvenFinalist rejected = prove(problem).value();
  EXPECT_FALSE(rejected.keeps_margins);
  EXPECT_EQ(rejected.verdict.status, goal::Status::met) << "the verdict is that of its moves";
}

// Estimates and comparison of candidates.

constexpr double never = std::numeric_limits<double>::infinity();

/// A candidate of the search that is judged by one claim.
/// @param results [machine] results
Candidate candidate_of(const std::vector<ClaimResult>& results) {
  Candidate candidate;
  for (const ClaimResult& one : results) candidate.machines.push_back({.claims = {one}});
  return candidate;
}

/// The aim of a search: one claim, and the quantile of the settling time to be minimised.
Aim aim_with(const study::Goal& claim, double quantile = 0.95) {
  return {.claims = {claim}, .quantile = quantile};
}

TEST(Candidate, RateCountsMovesOrMachines) {
  const Candidate candidate = candidate_of({{10, 10, {}}, {10, 9, {}}, {10, 5, {}}, {10, 10, {}}});
  EXPECT_DOUBLE_EQ(estimate_of(aim_with({.moves = 0.9}), candidate.machines, 4).rate, 34.0 / 40.0);
  EXPECT_DOUBLE_EQ(estimate_of(aim_with({.moves = 0.9, .machines = 0.7}), candidate.machines, 4).rate, 0.75);
  EXPECT_DOUBLE_EQ(estimate_of(aim_with({.moves = 0.9}), candidate.machines, 2).rate, 19.0 / 20.0);
}

// The product over the moves in their order, whatever is computed once for those that are alike.
TEST(Candidate, EvidenceIsTheMeanCapitalOfTheBets) {
  std::mt19937_64 random(4);
  for (const int kinds : {1, 2, 7, 1000}) {
    std::vector<double> differences;
    for (int i = 0; i < 300; ++i)
      differences.push_back(2.0 * static_cast<double>(random() % static_cast<unsigned>(kinds)) / kinds - 1.0);
    double expected = 0.0;
    for (const double bet : {0.02, 0.05, 0.12, 0.3, 0.6, 0.9}) {
      double log_wealth = 0.0;
      for (const double d : differences) log_wealth += std::log1p(bet * d);
      expected += std::exp(std::min(log_wealth, 500.0)) / 6.0;
    }
    EXPECT_EQ(evidence_of_increase(differences), expected) << kinds;
  }
}

TEST(Candidate, CriterionCountsMovesThatNeverSettleAsLate) {
  std::vector<ClaimResult> machines;
  for (int i = 1; i <= 100; ++i) machines.push_back({1, 1, {i > 96 ? never : static_cast<double>(i)}});
  const Candidate candidate = candidate_of(machines);
  EXPECT_EQ(estimate_of(aim_with({}, 0.95), candidate.machines, 100).criterion, 95.0);
  EXPECT_EQ(estimate_of(aim_with({}, 0.5), candidate.machines, 100).criterion, 50.0);
  EXPECT_EQ(estimate_of(aim_with({}, 0.97), candidate.machines, 100).criterion, never);
}

TEST(Candidate, OneThatMeetsTheGoalIsBetterThanAFasterOne) {
  const Aim aim = aim_with({.moves = 0.9});
  /// The estimate from 1000 moves that all settle at the time `time`; `met` of them meet the goal.
  const auto estimate = [&](int met, double time) {
    std::vector<ClaimResult> machines;
    for (int i = 0; i < 1000; ++i) machines.push_back({1, i < met ? 1 : 0, {time}});
    return estimate_of(aim, candidate_of(machines).machines, 1000);
  };
  const RateEstimate fast = estimate(850, 0.01);
  const RateEstimate good = estimate(950, 0.05);
  const RateEstimate better = estimate(930, 0.04);
  EXPECT_TRUE(is_better(aim, good, fast));
  EXPECT_TRUE(is_better(aim, better, good));
  EXPECT_FALSE(is_better(aim, good, better));
}

/// A made-up claim (a goal under a condition) of a candidate: the proportion of moves that meet it, and their
/// settling time.
struct MadeUpClaim {
  double rate{1.0};
  double time{0.0};
};
Candidate candidate_with(const std::vector<MadeUpClaim>& claims, int machines = 400) {
  Candidate candidate;
  for (int i = 0; i < machines; ++i) {
    MachineResult& machine = candidate.machines.emplace_back();
    for (const MadeUpClaim& one : claims)
      machine.claims.push_back({1, i < one.rate * machines ? 1 : 0, {one.time}});
  }
  return candidate;
}
const Aim two_goals{.claims = {{.moves = 0.9}, {.moves = 0.9}, {.moves = 0.6}, {.moves = 0.6}},
                    .settings = 2};

TEST(Candidate, TheWorstOfSeveralClaimsDecides) {
  const Candidate lacking = candidate_with({{0.99, 0.1}, {0.95, 0.2}, {0.99, 0.3}, {0.62, 0.4}});
  const RateEstimate estimate = estimate_of(two_goals, lacking.machines, 400);
  EXPECT_EQ(estimate.worst, 3U) << "62 % of 60 % is nearer to the goal than 95 % of 90 %";
  EXPECT_DOUBLE_EQ(estimate.rate, 0.62);
  EXPECT_DOUBLE_EQ(estimate.criterion, 0.4) << "the largest of all claims";
  EXPECT_EQ(estimate.missing, 1);
  EXPECT_FALSE(seems_to_meet(estimate));
  EXPECT_TRUE(reaches(two_goals, estimate)) << "with nothing to spare";
}

TEST(Candidate, RanksByGoalsMetThenByTheWorstClaim) {
  const auto estimate = [](const std::vector<MadeUpClaim>& claims) {
    return estimate_of(two_goals, candidate_with(claims).machines, 400);
  };
  const RateEstimate none = estimate({{0.89, 0.1}, {0.89, 0.1}, {0.59, 0.1}, {0.59, 0.1}});
  const RateEstimate one = estimate({{0.99, 0.1}, {0.99, 0.1}, {0.3, 0.1}, {0.9, 0.1}});
  const RateEstimate one_nearer = estimate({{0.99, 0.9}, {0.99, 0.9}, {0.5, 0.9}, {0.5, 0.9}});
  const RateEstimate all = estimate({{0.99, 0.9}, {0.99, 0.9}, {0.9, 0.9}, {0.9, 0.9}});
  EXPECT_TRUE(is_better(two_goals, one, none));
  EXPECT_TRUE(is_better(two_goals, one_nearer, one));
  EXPECT_TRUE(is_better(two_goals, all, one_nearer));
}

// One claim that is missed, or late, drops a candidate; one that is only near its limit does not.
TEST(Candidate, IsDroppedByTheClaimThatItMisses) {
  const Candidate reliable = candidate_with({{1.0, 0.2}, {1.0, 0.2}, {1.0, 0.2}, {1.0, 0.4}});
  EXPECT_TRUE(surely_meets(two_goals, reliable, 0.01));
  for (std::size_t claim = 0; claim < 4; ++claim) {
    std::vector<MadeUpClaim> claims(4, {1.0, 0.2});
    claims[claim].rate = 0.4;
    const Candidate missing = candidate_with(claims);
    EXPECT_FALSE(surely_meets(two_goals, missing, 0.01)) << claim;
    EXPECT_TRUE(surely_misses(two_goals, missing, reliable, 0.01)) << claim;
    claims[claim] = {1.0, 0.5};
    EXPECT_TRUE(is_significantly_later(two_goals, candidate_with(claims), reliable, 0.01)) << claim;
    claims[claim] = {1.0, 0.3};  // later than `reliable` in this claim, not than its latest
    EXPECT_FALSE(is_significantly_later(two_goals, candidate_with(claims), reliable, 0.01)) << claim;
  }
  EXPECT_FALSE(surely_misses(two_goals, reliable, reliable, 0.01));
}

// The criterion is the largest of all claims: a claim with 3 % beyond the limit is as early as the latest of
// `best`, of which 4 % are beyond it.
TEST(Candidate, IsNotSlowerByAClaimThatIsFasterThanTheSlowestOfTheBest) {
  constexpr int machines = 2000;
  Candidate best = candidate_with({{1.0, 0.2}, {1.0, 0.2}, {1.0, 0.2}, {1.0, 0.4}}, machines);
  for (int i = 0; i < machines; i += 25) best.machines[static_cast<std::size_t>(i)].claims[3].values = {0.9};
  Candidate other = best;
  for (int i = 0; i < machines; i += 33) other.machines[static_cast<std::size_t>(i)].claims[0].values = {0.9};
  EXPECT_FALSE(is_significantly_later(two_goals, other, best, 0.01));
  for (int i = 0; i < machines; i += 5) other.machines[static_cast<std::size_t>(i)].claims[0].values = {0.9};
  EXPECT_TRUE(is_significantly_later(two_goals, other, best, 0.01));
}

// The error probability holds for all numbers of machines together, for differences of any shape.
TEST(Candidate, EvidenceSeldomDropsAnEqualCandidate) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  constexpr int sequences = 600;
  constexpr double alpha = 0.05;
  int accused = 0;
  for (int i = 0; i < sequences; ++i) {
    const double rare = i % 2 == 0 ? 0.5 : 0.02;  // +1 and −1 with equal probability, otherwise 0
    std::vector<double> differences;
    bool shown = false;
    for (int n = 1; n <= 1024; ++n) {
      const double u = uniform(random);
      differences.push_back(u < rare ? 1.0 : u < 2.0 * rare ? -1.0 : 0.0);
      if ((n & (n - 1)) == 0) shown = shown || evidence_of_increase(differences) > 1.0 / alpha;
    }
    accused += shown ? 1 : 0;
  }
  EXPECT_LE(accused, alpha * sequences);
}

TEST(Candidate, EvidenceFindsASlowerCandidateSoon) {
  std::vector<double> differences;
  for (int i = 0; i < 256; ++i) differences.push_back(i % 10 == 0 ? 1.0 : 0.0);  // 10 % more misses
  EXPECT_GT(evidence_of_increase(differences), 100.0);
}

TEST(Candidate, ASlowerCandidateIsDistinguishedFromAFasterOne) {
  std::vector<ClaimResult> fast;
  std::vector<ClaimResult> slow;
  for (int i = 0; i < 128; ++i) {
    fast.push_back({1, 1, {0.01 + 1e-4 * (i % 16)}});
    slow.push_back({1, 1, {0.03}});
  }
  const Aim aim = aim_with({.moves = 0.9});
  EXPECT_TRUE(is_significantly_later(aim, candidate_of(slow), candidate_of(fast), 0.01));
  EXPECT_FALSE(is_significantly_later(aim, candidate_of(fast), candidate_of(slow), 0.01));
}

// The size of a search follows its effort.

TEST(SearchSize, FirstGenerationTakesAtMostHalfOfTheEffort) {
  for (std::size_t free = 1; free <= 6; ++free) {
    for (const std::int64_t worlds : {0, 7, 30}) {
      const SearchScope scope{free, free / 2, 2048, worlds};
      const std::int64_t least = first_race_machines(smallest_search(scope), scope.faces);
      for (std::int64_t machines = 2 * least; machines < 1'000'000; machines = machines * 5 / 4) {
        const SearchSize size = search_size(scope, machines);
        EXPECT_LE(first_race_machines(size, scope.faces), machines / 2);
        EXPECT_GE(size.max_machines, size.first_machines);
        EXPECT_EQ(size.max_machines % std::max<std::int64_t>(worlds, 1), 0);
        EXPECT_GE(size.max_machines, 4 * worlds) << "each world has some machines";
      }
    }
  }
}

TEST(SearchSize, GrowsWithTheEffort) {
  const SearchScope scope{3, 3, 2048, 0};
  SearchSize last = smallest_search(scope);
  int sizes = 1;
  for (std::int64_t machines = 500; machines < 500'000; machines = machines * 6 / 5) {
    const SearchSize size = search_size(scope, machines);
    EXPECT_GE(size.first_candidates, last.first_candidates);
    EXPECT_GE(size.max_machines, last.max_machines);
    sizes += size.first_candidates > last.first_candidates ? 1 : 0;
    last = size;
  }
  EXPECT_GT(sizes, 8) << "small efforts differ too";
  EXPECT_EQ(last.max_machines, 2048);
}

// The frontier between success and speed. Rates that led a search show that a goal is out of reach; a rate of
// 0 nearly everywhere does not.

const Aim aim{.claims = {{.moves = 0.9}}};

TriedPoint point(double rate, std::int64_t machines = 64) {
  TriedPoint tried;
  tried.estimate.rate = tried.estimate.moves = rate;
  tried.estimate.machines = machines;
  return tried;
}

/// Points over the range of one parameter, at which this is the rate.
template <class Rate>
Landscape landscape(Rate rate, int points = 400) {
  std::vector<TriedPoint> tried;
  for (int i = 0; i < points; ++i) tried.push_back(point(rate((i + 0.5) / points)));
  return landscape_of(aim, tried);
}

TEST(Landscape, LeadsToTheHighestRate) {
  EXPECT_TRUE(landscape([](double x) { return 0.6 * std::exp(-8.0 * (x - 0.4) * (x - 0.4)); }).leads());
  // A narrow peak that the search refined: one point in ten lies on it.
  EXPECT_TRUE(landscape([](double x) { return std::max(0.0, 0.7 - 20.0 * std::abs(x - 0.3)); }).leads());
}

TEST(Landscape, LeadsNowhereIfHardlyAnyMoveMeetsTheGoal) {
  EXPECT_FALSE(landscape([](double) { return 0.0; }).leads());
  // Half of the moves are trivial, and meet it everywhere.
  EXPECT_FALSE(landscape([](double) { return 0.5; }).leads());
  // By chance: one move in 64, wherever one looks.
  EXPECT_FALSE(landscape([](double) { return 1.0 / 64.0; }).leads());
  // A needle that two points met, and that is no slope.
  EXPECT_FALSE(landscape([](double x) { return std::abs(x - 0.08) < 0.003 ? 1.0 : 0.0; }).leads());
  EXPECT_FALSE(landscape([](double x) { return 0.8 * x; }, 5).leads()) << "too few points";
}

// A goal for machines may be met by none where many moves meet it: these lead.
TEST(Landscape, FollowsTheMovesOfAGoalForMachines) {
  const Aim of_machines{.claims = {{.moves = 0.99, .machines = 0.95}}};
  std::vector<TriedPoint> tried;
  for (int i = 0; i < 100; ++i) tried.push_back(point(0.009 * i));
  for (TriedPoint& one : tried) one.estimate.rate = 0.0;
  EXPECT_TRUE(landscape_of(of_machines, tried).leads());
}

TEST(Frontier, HasThePointsThatNoOtherDominates) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> number(0, 30);
  for (int round = 0; round < 50; ++round) {
    std::vector<TriedPoint> tried;
    for (int i = 0; i < 60; ++i) {
      TriedPoint point{{double(i)}, {}};
      point.estimate = {number(random) / 30.0, 0.0, number(random) * 0.01, number(random) < 25 ? 512 : 64};
      tried.push_back(point);
    }
    const std::vector<TriedPoint> frontier = frontier_of(tried, 512);
    const auto is_on_frontier = [&](const TriedPoint& one) {
      return std::ranges::any_of(frontier, [&](const TriedPoint& other) {
        return other.estimate.rate == one.estimate.rate && other.estimate.criterion == one.estimate.criterion;
      });
    };
    for (const TriedPoint& one : tried) {
      if (one.estimate.machines < 512) continue;
      const bool beaten = std::ranges::any_of(tried, [&](const TriedPoint& other) {
        return other.estimate.machines >= 512 && other.estimate.rate >= one.estimate.rate &&
               other.estimate.criterion <= one.estimate.criterion &&
               (other.estimate.rate > one.estimate.rate || other.estimate.criterion < one.estimate.criterion);
      });
      EXPECT_EQ(is_on_frontier(one), !beaten);
    }
  }
}

}  // namespace
}  // namespace zerocount::tuning
