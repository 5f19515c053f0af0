// Bounds of the proportion of rigs that meet a requirement in a proportion of their moves.
#include "analysis/statistics/clusters/rig_proportion.hpp"

#include "analysis/statistics/distributions.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

// If all rigs pass, only the highest mark can show so much, and has all of the error.
TEST(RigProportion, OfRigsThatAllPassIsThatOfWilksLessWhatFewMovesHide) {
  // 100 moves: P(B ≥ 57) = 0.0966 ≤ 0.1 for B binomial (100, ½).
  const std::vector<RigMoves> rigs(300, {100, 100, 100});
  const RigProportion found = rig_proportion(rigs, {0.5, 0.95, 0.95});
  const double all_pass = std::pow(0.05, 1.0 / 300.0);
  const double wrong = binomial_upper_tail(100, 0.5, 56);
  EXPECT_LE(wrong, 0.1);
  EXPECT_EQ(found.meeting, 300);
  EXPECT_NEAR(found.low, (all_pass - wrong) / (1.0 - wrong), 1e-12);
  EXPECT_EQ(found.high, 1.0);
  // Five moves hardly tell a rig at 99 % from one at 98 %.
  EXPECT_LT(rig_proportion(std::vector<RigMoves>(300, {5, 5, 5}), {0.99, 0.95, 0.95}).low, 0.9);
  // Wilks: 59 rigs show 95 %, 58 do not.
  EXPECT_GE(rig_proportion(std::vector<RigMoves>(59, {4000, 4000, 4000}), {0.9, 0.95, 0.95}).low, 0.95);
  EXPECT_LT(rig_proportion(std::vector<RigMoves>(58, {4000, 4000, 4000}), {0.9, 0.95, 0.95}).low, 0.95);
}

TEST(RigProportion, OfRigsThatAllFailIsSmall) {
  const RigProportion found = rig_proportion(std::vector<RigMoves>(100, {200, 200, 20}), {0.9, 0.9, 0.95});
  EXPECT_EQ(found.meeting, 0);
  EXPECT_EQ(found.low, 0.0);
  EXPECT_NEAR(found.high, 1.0 - std::pow(0.05, 1.0 / 100.0), 4e-3);
}

// Where rigs are well above the requirement and miss at times, a bound by those without a miss is poor.
TEST(RigProportion, IsSharperThanThatOfOneMark) {
  std::mt19937_64 random(3);
  const auto median_low = [&](double good, double bad, std::int64_t rigs, std::int64_t moves) {
    std::vector<double> found;
    for (int study = 0; study < 51; ++study) {
      std::vector<RigMoves> drawn;
      for (std::int64_t rig = 0; rig < rigs; ++rig) {
        std::binomial_distribution<std::int64_t> met(moves, rig % 10 == 0 ? bad : good);
        drawn.push_back({moves, moves, met(random)});
      }
      found.push_back(rig_proportion(drawn, {0.95, 0.9, 0.95}).low);
    }
    std::ranges::sort(found);
    return found[25];
  };
  EXPECT_GT(median_low(0.99, 0.99, 100, 30), 0.72);    // by those without a miss 0.57
  EXPECT_GT(median_low(0.975, 0.975, 300, 100), 0.8);  // 0.62
  EXPECT_GT(median_low(0.99, 0.8, 300, 100), 0.75);    // of 0.9
}

// Of rigs of which half are far below, the bound is of those in question.
TEST(RigProportion, OfHalfOfTheRigsLeavesTheOthersOut) {
  std::vector<RigMoves> rigs(200, {20, 20, 20});
  for (std::size_t rig = 0; rig < rigs.size(); rig += 2) rigs[rig].met = 4;
  const RigProportion found = rig_proportion(rigs, {0.9, 0.95, 0.95});
  // The proportion of those that may be at the requirement, 0.5, by a Clopper–Pearson bound at 99.75 %, and
  // that of those that pass.
  EXPECT_GT(found.low, 0.36);
  EXPECT_LT(found.low, 0.5);
  EXPECT_GT(found.high, 0.5);
}

TEST(RigProportion, OfNoRigIsUnknown) {
  const RigProportion none = rig_proportion({}, {0.9, 0.9, 0.95});
  EXPECT_EQ(none.meeting, 0);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_EQ(none.high, 1.0);
}

/// Studies of rigs drawn at random, half of them with moves of a trial that are all alike.
struct Population {
  double meeting;       ///< proportion of rigs at or above the requirement
  double above, below;  ///< proportions of moves of those, and of the others
};

class RigProportionCoverage : public ::testing::TestWithParam<Population> {};

TEST_P(RigProportionCoverage, BoundsHold) {
  constexpr double proportion = 0.95, wanted = 0.9, confidence = 0.95;
  constexpr int studies = 600;
  const Population population = GetParam();
  std::mt19937_64 random(36);
  for (const int moves_of_trial : {1, 4}) {
    for (const int trials : {10, 100}) {
      int too_high = 0, too_low = 0;
      for (int study = 0; study < studies; ++study) {
        std::vector<RigMoves> rigs;
        for (int rig = 0; rig < 80; ++rig) {
          const bool meets = std::bernoulli_distribution(population.meeting)(random);
          std::binomial_distribution<std::int64_t> met(trials, meets ? population.above : population.below);
          rigs.push_back({trials, trials * moves_of_trial, met(random) * moves_of_trial});
        }
        const RigProportion found = rig_proportion(rigs, {proportion, wanted, confidence});
        EXPECT_LE(found.low, found.high);
        too_high += found.low > population.meeting;
        too_low += found.high < population.meeting;
      }
      const double limit = (1.0 - confidence) * studies + 3.0 * std::sqrt(0.05 * 0.95 * studies);
      EXPECT_LE(too_high, limit) << moves_of_trial << " moves of " << trials << " trials";
      EXPECT_LE(too_low, limit) << moves_of_trial << " moves of " << trials << " trials";
    }
  }
}

// Rigs just below and just on the requirement are the hardest to tell apart.
INSTANTIATE_TEST_SUITE_P(, RigProportionCoverage,
                         ::testing::Values(Population{0.9, 0.95, 0.949}, Population{0.0, 1.0, 0.9499},
                                           Population{1.0, 0.95, 0.0}, Population{0.8, 0.99, 0.9},
                                           Population{0.95, 1.0, 0.5}));

}  // namespace
}  // namespace zerocount::statistics
