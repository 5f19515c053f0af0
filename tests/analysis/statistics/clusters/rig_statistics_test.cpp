#include "analysis/statistics/clusters/rig_statistics.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/random/beta_distribution.hpp>

#include "core/failure/failure.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

RigTrials rig_with(std::int64_t trials, std::int64_t successes, std::int64_t moves = 1) {
  return {trials, successes, trials * moves, successes * moves};
}

std::vector<RigTrials> rigs_with(std::int64_t trials, const std::vector<std::int64_t>& successes) {
  std::vector<RigTrials> rigs;
  for (const std::int64_t k : successes) rigs.push_back(rig_with(trials, k));
  return rigs;
}

TEST(RigStatistics, CountsTheRigsWithoutFailureAndTheWorst) {
  std::vector<std::int64_t> successes(40, 10);
  successes[3] = 4;
  successes[17] = 1;
  successes[30] = 9;
  const RigStatistics found = rig_statistics(rigs_with(10, successes));
  EXPECT_EQ(found.n, 40);
  EXPECT_NEAR(found.without_failure, 37.0 / 40.0, 1e-15);
  EXPECT_EQ(found.without_failure_bounds.low, clopper_pearson(37, 40).low);
  EXPECT_EQ(found.without_failure_bounds.high, clopper_pearson(37, 40).high);
  EXPECT_NEAR(found.worst_5_percent, 0.5 * (0.1 + 0.4), 1e-15);                        // 2 of 40
  EXPECT_NEAR(rig_statistics(rigs_with(10, {3, 8, 10})).worst_5_percent, 0.3, 1e-15);  // 1 of fewer than 20
  EXPECT_EQ(rig_statistics({}).n, 0);
  EXPECT_THROW(rig_statistics(rigs_with(10, successes), 1.0), Failure);
}

/// A beta-binomial sample has the standard deviation of its beta distribution, whatever the number of trials.
TEST(RigStatistics, StandardDeviationIsThatOfTheProbabilities) {
  std::mt19937_64 random(61);
  for (const double sd : {0.0, 0.1, 0.3}) {
    for (const std::int64_t trials : {2, 10, 100}) {
      constexpr double mean = 0.7;
      const double size = sd > 0.0 ? mean * (1.0 - mean) / (sd * sd) - 1.0 : 0.0;
      std::vector<std::int64_t> successes;
      for (int rig = 0; rig < 4000; ++rig) {
        const double p =
            sd > 0.0 ? boost::random::beta_distribution<double>(mean * size, (1.0 - mean) * size)(random)
                     : mean;
        successes.push_back(std::binomial_distribution<std::int64_t>(trials, p)(random));
      }
      const double found = rig_statistics(rigs_with(trials, successes)).success_sd;
      // Of nothing, the estimated variance errs by its standard error to either side, or is cut off at 0.
      EXPECT_NEAR(found * found, sd * sd, 0.02 / static_cast<double>(trials) + 0.005) << sd << " " << trials;
    }
  }
  EXPECT_TRUE(std::isnan(rig_statistics(rigs_with(1, {1, 0, 1})).success_sd));
  EXPECT_EQ(rig_statistics(rigs_with(10, {5, 5, 5, 5})).success_sd, 0.0);
}

TEST(RigTolerance, WithoutAFailureIsTheBoundOfTheTrialsOfOneRig) {
  // 29 rigs are the fewest that show a content of 90 % with 95 % confidence: 0.9^29 < 0.05.
  const RigTolerance few = rig_tolerance(rigs_with(100, std::vector<std::int64_t>(28, 100)), 0.9, 0.95);
  EXPECT_TRUE(std::isnan(few.zero_at_least));
  EXPECT_EQ(few.min_rigs, 29);
  EXPECT_EQ(tolerance_sentence(few),
            "with 95 % confidence, it takes 29 rigs to say in how many moves 90 % of rigs hold zero");
  // With 40 rigs, those below the worst are at most p = 1 − 0.05^(1/40) = 7.2 % of all; a rig that shows no
  // failure in 100 trials with a probability of δ = 1 − p/10 % = 28 % holds zero in δ^(1/100) = 98.7 %.
  const RigTolerance all = rig_tolerance(rigs_with(100, std::vector<std::int64_t>(40, 100)), 0.9, 0.95);
  const double p = 1.0 - std::pow(0.05, 1.0 / 40.0);
  EXPECT_NEAR(all.zero_at_least, std::pow(1.0 - p / 0.1, 1.0 / 100.0), 1e-9);
  EXPECT_EQ(tolerance_sentence(all),
            "with 95 % confidence at least 90 % of rigs hold zero in at least 98.7 % of moves");
}

TEST(RigTolerance, MovesOfOneTrialMayAllBeAlike) {
  // Without a failure, ten moves a trial show no more than one does.
  std::vector<RigTrials> one, ten;
  for (int rig = 0; rig < 60; ++rig) {
    one.push_back(rig_with(50, 50));
    ten.push_back(rig_with(50, 50, 10));
  }
  EXPECT_NEAR(rig_tolerance(ten, 0.9, 0.95).zero_at_least, rig_tolerance(one, 0.9, 0.95).zero_at_least, 1e-9);
  // With failures the bound for moves that may be alike is below that for trials of one move.
  for (RigTrials& rig : one) rig = rig_with(50, 45);
  for (RigTrials& rig : ten) rig = rig_with(50, 45, 10);
  EXPECT_LT(rig_tolerance(ten, 0.9, 0.95).zero_at_least, rig_tolerance(one, 0.9, 0.95).zero_at_least);
  EXPECT_GT(rig_tolerance(ten, 0.9, 0.95).zero_at_least, 0.7);
  for (RigTrials& rig : ten) rig = rig_with(50, 0, 10);
  EXPECT_EQ(rig_tolerance(ten, 0.9, 0.95).zero_at_least, 0.0);
}

TEST(RigTolerance, LeavesOutAsManyRigsAsItsRankAllows) {
  // Of 100 rigs the third worst counts: two that always fail cost nothing.
  std::vector<std::int64_t> successes(100, 200);
  const double best = rig_tolerance(rigs_with(200, successes), 0.9, 0.95).zero_at_least;
  successes[1] = successes[7] = 0;
  EXPECT_EQ(rig_tolerance(rigs_with(200, successes), 0.9, 0.95).zero_at_least, best);
  successes[9] = 0;
  EXPECT_EQ(rig_tolerance(rigs_with(200, successes), 0.9, 0.95).zero_at_least, 0.0);
}

}  // namespace
}  // namespace zerocount::statistics
