// Estimates and comparison of candidates.
#include "runners/tuning/race/candidate.hpp"

#include "tests/support/test.hpp"

namespace zerocount::tuning {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// A candidate with one claim, [unit] its results.
Candidate candidate_of(const std::vector<ClaimResult>& results) {
  Candidate candidate;
  for (const ClaimResult& one : results) candidate.units.push_back({.claims = {one}});
  return candidate;
}

/// One claim, by the 95 % quantile or another.
Aim aim_with(const Claim& claim, double quantile = 0.95) {
  return {.claims = {claim}, .quantile = quantile};
}

TEST(Candidate, RateIsOfMovesOrOfMachines) {
  const Candidate candidate = candidate_of({{10, 10, {}}, {10, 9, {}}, {10, 5, {}}, {10, 10, {}}});
  EXPECT_DOUBLE_EQ(estimate_of(aim_with({.moves = 0.9}), candidate, 4).rate, 34.0 / 40.0);
  EXPECT_DOUBLE_EQ(estimate_of(aim_with({.moves = 0.9, .machines = 0.7}), candidate, 4).rate, 0.75);
  EXPECT_DOUBLE_EQ(estimate_of(aim_with({.moves = 0.9}), candidate, 2).rate, 19.0 / 20.0);
}

// The product over the moves in their order, whatever is computed once for those that are alike.
TEST(Candidate, EvidenceIsTheMeanWealthOfTheBets) {
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
  std::vector<ClaimResult> units;
  for (int i = 1; i <= 100; ++i) units.push_back({1, 1, {i > 96 ? never : static_cast<double>(i)}});
  const Candidate candidate = candidate_of(units);
  EXPECT_EQ(estimate_of(aim_with({}, 0.95), candidate, 100).criterion, 95.0);
  EXPECT_EQ(estimate_of(aim_with({}, 0.5), candidate, 100).criterion, 50.0);
  EXPECT_EQ(estimate_of(aim_with({}, 0.97), candidate, 100).criterion, never);
}

TEST(Candidate, OneThatMeetsTheGoalIsBetterThanAFasterOne) {
  const Aim aim = aim_with({.moves = 0.9});
  /// Of 1000 moves, all of which settle at this time.
  const auto estimate = [&](int met, double time) {
    std::vector<ClaimResult> units;
    for (int i = 0; i < 1000; ++i) units.push_back({1, i < met ? 1 : 0, {time}});
    return estimate_of(aim, candidate_of(units), 1000);
  };
  const Estimate fast = estimate(850, 0.01);
  const Estimate good = estimate(950, 0.05);
  const Estimate better = estimate(930, 0.04);
  EXPECT_TRUE(is_better(aim, good, fast));
  EXPECT_TRUE(is_better(aim, better, good));
  EXPECT_FALSE(is_better(aim, good, better));
}

/// Candidates of two goals under two conditions: [claim] the proportion of met moves, and their time.
struct MadeUpClaim {
  double rate{1.0};
  double time{0.0};
};
Candidate candidate_with(const std::vector<MadeUpClaim>& claims, int units = 400) {
  Candidate candidate;
  for (int i = 0; i < units; ++i) {
    UnitResult& unit = candidate.units.emplace_back();
    for (const MadeUpClaim& one : claims)
      unit.claims.push_back({1, i < one.rate * units ? 1 : 0, {one.time}});
  }
  return candidate;
}
const Aim two_goals{.claims = {{.moves = 0.9}, {.moves = 0.9}, {.moves = 0.6}, {.moves = 0.6}},
                    .conditions = 2};

TEST(Candidate, OfSeveralClaimsTheWorstDecides) {
  const Candidate lacking = candidate_with({{0.99, 0.1}, {0.95, 0.2}, {0.99, 0.3}, {0.62, 0.4}});
  const Estimate estimate = estimate_of(two_goals, lacking, 400);
  EXPECT_EQ(estimate.worst, 3U) << "62 % of 60 % is nearer to the goal than 95 % of 90 %";
  EXPECT_DOUBLE_EQ(estimate.rate, 0.62);
  EXPECT_DOUBLE_EQ(estimate.criterion, 0.4) << "the largest of all claims";
  EXPECT_EQ(estimate.missing, 1);
  EXPECT_FALSE(seems_to_meet(estimate));
  EXPECT_TRUE(reaches(two_goals, estimate)) << "with nothing to spare";
}

TEST(Candidate, OneThatMeetsMoreGoalsIsBetterThenTheOneWithTheBetterWorstClaim) {
  const auto estimate = [](const std::vector<MadeUpClaim>& claims) {
    return estimate_of(two_goals, candidate_with(claims), 400);
  };
  const Estimate none = estimate({{0.89, 0.1}, {0.89, 0.1}, {0.59, 0.1}, {0.59, 0.1}});
  const Estimate one = estimate({{0.99, 0.1}, {0.99, 0.1}, {0.3, 0.1}, {0.9, 0.1}});
  const Estimate one_nearer = estimate({{0.99, 0.9}, {0.99, 0.9}, {0.5, 0.9}, {0.5, 0.9}});
  const Estimate all = estimate({{0.99, 0.9}, {0.99, 0.9}, {0.9, 0.9}, {0.9, 0.9}});
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
TEST(Candidate, IsNotLaterByAClaimThatIsEarlierThanTheLatestOfTheBest) {
  constexpr int units = 2000;
  Candidate best = candidate_with({{1.0, 0.2}, {1.0, 0.2}, {1.0, 0.2}, {1.0, 0.4}}, units);
  for (int i = 0; i < units; i += 25) best.units[static_cast<std::size_t>(i)].claims[3].values = {0.9};
  Candidate other = best;
  for (int i = 0; i < units; i += 33) other.units[static_cast<std::size_t>(i)].claims[0].values = {0.9};
  EXPECT_FALSE(is_significantly_later(two_goals, other, best, 0.01));
  for (int i = 0; i < units; i += 5) other.units[static_cast<std::size_t>(i)].claims[0].values = {0.9};
  EXPECT_TRUE(is_significantly_later(two_goals, other, best, 0.01));
}

// The error probability holds for all numbers of units together, for differences of any shape.
TEST(Candidate, EvidenceRarelyAccusesTheInnocent) {
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

TEST(Candidate, EvidenceFindsAnIncreaseSoon) {
  std::vector<double> differences;
  for (int i = 0; i < 256; ++i) differences.push_back(i % 10 == 0 ? 1.0 : 0.0);  // 10 % more misses
  EXPECT_GT(evidence_of_increase(differences), 100.0);
}

TEST(Candidate, IsSurelyLaterThanAFasterOne) {
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

}  // namespace
}  // namespace zerocount::tuning
