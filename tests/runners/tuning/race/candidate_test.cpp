// Estimates and comparison of candidates.
#include "runners/tuning/race/candidate.hpp"

#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace zerocount::tuning {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

Candidate candidate_of(std::vector<UnitResult> units) {
  return {{}, {}, std::move(units)};
}

TEST(Candidate, RateIsOfMovesOrOfMachines) {
  const Candidate candidate = candidate_of({{10, 10, {}}, {10, 9, {}}, {10, 5, {}}, {10, 10, {}}});
  EXPECT_DOUBLE_EQ(estimate_of({.moves = 0.9}, candidate, 4).rate, 34.0 / 40.0);
  EXPECT_DOUBLE_EQ(estimate_of({.moves = 0.9, .machines = 0.7}, candidate, 4).rate, 0.75);
  EXPECT_DOUBLE_EQ(estimate_of({.moves = 0.9}, candidate, 2).rate, 19.0 / 20.0);
}

TEST(Candidate, CriterionCountsMovesThatNeverSettleAsLate) {
  std::vector<UnitResult> units;
  for (int i = 1; i <= 100; ++i) units.push_back({1, 1, {i > 96 ? never : static_cast<double>(i)}});
  const Candidate candidate = candidate_of(units);
  EXPECT_EQ(estimate_of({.quantile = 0.95}, candidate, 100).criterion, 95.0);
  EXPECT_EQ(estimate_of({.quantile = 0.5}, candidate, 100).criterion, 50.0);
  EXPECT_EQ(estimate_of({.quantile = 0.97}, candidate, 100).criterion, never);
}

TEST(Candidate, OneThatMeetsTheGoalIsBetterThanAFasterOne) {
  const Aim aim{.moves = 0.9};
  const Estimate fast{.rate = 0.85, .moves = 0.85, .criterion = 0.01, .units = 1000};
  const Estimate good{.rate = 0.95, .moves = 0.95, .criterion = 0.05, .units = 1000};
  const Estimate better{.rate = 0.93, .moves = 0.93, .criterion = 0.04, .units = 1000};
  EXPECT_TRUE(is_better(aim, good, fast));
  EXPECT_TRUE(is_better(aim, better, good));
  EXPECT_FALSE(is_better(aim, good, better));
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
  std::vector<UnitResult> fast;
  std::vector<UnitResult> slow;
  for (int i = 0; i < 128; ++i) {
    fast.push_back({1, 1, {0.01 + 1e-4 * (i % 16)}});
    slow.push_back({1, 1, {0.03}});
  }
  const Aim aim{.moves = 0.9};
  EXPECT_TRUE(is_significantly_later(aim, candidate_of(slow), candidate_of(fast), 0.01));
  EXPECT_FALSE(is_significantly_later(aim, candidate_of(fast), candidate_of(slow), 0.01));
}

}  // namespace
}  // namespace zerocount::tuning
