#include "analysis/basis/statistics/sample_size.hpp"

#include "analysis/basis/statistics/clusters/machine_statistics.hpp"
#include "analysis/basis/statistics/mean_bounds.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "core/failure/failure.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

TEST(SampleSize, MatchesTheTablesOfWilks) {
  const std::int64_t of_95[] = {59, 93, 124, 153, 181};
  const std::int64_t of_99[] = {299, 473, 628, 773, 913};
  for (std::int64_t failures = 0; failures < 5; ++failures) {
    EXPECT_EQ(trials_for_claim(0.95, 0.95, failures), of_95[failures]);
    EXPECT_EQ(trials_for_claim(0.99, 0.95, failures), of_99[failures]);
  }
  EXPECT_EQ(trials_for_claim(0.999, 0.95, 0), 2995);
  EXPECT_EQ(trials_for_claim(0.5, 0.5, 0), 1);
}

TEST(SampleSize, WithoutFailuresHasTheClosedForm) {
  for (const double success : {0.3, 0.9, 0.999, 0.999999}) {
    for (const double confidence : {0.5, 0.9, 0.999})
      EXPECT_EQ(trials_for_claim(success, confidence, 0),
                static_cast<std::int64_t>(std::ceil(std::log(1.0 - confidence) / std::log(success) - 1e-9)));
  }
}

TEST(SampleSize, IsTheSmallestThatAllowsTheClaim) {
  for (const double success : {0.8, 0.99, 0.9995}) {
    for (const std::int64_t failures : {0, 1, 4, 30}) {
      const std::int64_t n = trials_for_claim(success, 0.95, failures);
      EXPECT_GE(proportion_at_least(n - failures, n, 0.95), success);
      EXPECT_LT(proportion_at_least(n - 1 - failures, n - 1, 0.95), success);
    }
  }
}

TEST(SampleSize, PowerIsTheProbabilityOfTheClaim) {
  std::mt19937_64 random(97);
  constexpr int rounds = 4000;
  for (const std::int64_t failures : {0, 3}) {
    const std::int64_t n = trials_for_claim(0.97, 0.9, failures);
    std::binomial_distribution<std::int64_t> failing(n, 0.01);
    int made = 0;
    for (int round = 0; round < rounds; ++round) {
      const std::int64_t successes = n - failing(random);
      made += proportion_at_least(successes, n, 0.9) >= 0.97;
    }
    const double chance = chance_of_claim(n, failures, 0.99);
    EXPECT_NEAR(made, chance * rounds, 4.0 * std::sqrt(rounds * chance * (1.0 - chance)));
  }
  EXPECT_EQ(chance_of_claim(5, 5, 0.1), 1.0);
}

TEST(SampleSize, FalseClaimsAreAsRareAsTheConfidenceRequires) {
  for (const double success : {0.9, 0.999}) {
    for (const std::int64_t failures : {0, 2, 10})
      EXPECT_LE(chance_of_claim(trials_for_claim(success, 0.95, failures), failures, success), 0.05);
  }
}

TEST(SampleSize, PlanIsTheSmallestWithThePower) {
  for (const double power : {0.05, 0.5, 0.9}) {
    const ClaimPlan plan = plan_with_power(0.98, 0.95, 0.99, power);
    EXPECT_EQ(plan.trials, trials_for_claim(0.98, 0.95, plan.failures));
    EXPECT_GE(chance_of_claim(plan.trials, plan.failures, 0.99), power);
    for (std::int64_t fewer = 0; fewer < plan.failures; ++fewer)
      EXPECT_LT(chance_of_claim(trials_for_claim(0.98, 0.95, fewer), fewer, 0.99), power);
  }
}

TEST(SampleSize, TheIntervalHasThePlannedHalfwidth) {
  for (const double rate : {0.5, 0.9}) {
    for (const double halfwidth : {0.1, 0.01}) {
      const std::int64_t n = trials_for_halfwidth(halfwidth, 0.95, rate);
      for (const auto& [trials, shorter] : {std::pair{n, true}, {9 * n / 10, false}}) {
        const ConfidenceInterval bounds =
            clopper_pearson(std::llround(rate * static_cast<double>(trials)), trials);
        const double found = 0.5 * (bounds.high - bounds.low);
        EXPECT_EQ(found <= halfwidth * 1.01, shorter) << found << " with " << trials << " for " << halfwidth;
      }
    }
  }
  // One half is the worst case: no outcome has a longer interval.
  const std::int64_t n = trials_for_halfwidth(0.05, 0.95, 0.5);
  for (std::int64_t k = 0; k <= n; ++k) {
    const ConfidenceInterval bounds = clopper_pearson(k, n);
    EXPECT_LE(0.5 * (bounds.high - bounds.low), 0.05 + 1e-6);
  }
}

// By simulation: studies with this rate, looked at after every block, end at about the stated number.
TEST(SampleSize, StoppingByTheOutcomesNeedsTheForecastNumberOfTrials) {
  std::mt19937_64 random(165);
  constexpr std::int64_t block = 50;
  for (const double rate : {0.5, 0.9}) {
    const SequentialCost cost = sequential_cost(0.05, 0.95, rate, block);
    EXPECT_EQ(cost.fixed, trials_for_halfwidth(0.05, 0.95, rate));
    EXPECT_GT(cost.ratio(), 2.0);
    EXPECT_LT(cost.ratio(), 4.0);
    std::binomial_distribution<std::int64_t> of_block(block, rate);
    double total = 0.0;
    constexpr int studies = 200;
    for (int i = 0; i < studies; ++i) {
      std::int64_t trials = 0, successes = 0;
      ConfidenceInterval bounds{0.0, 1.0};
      while (bounds.high - bounds.low > 0.1) {
        trials += block;
        successes += of_block(random);
        bounds = confidence_sequence_bounds(successes, trials, 0.95);
      }
      total += static_cast<double>(trials);
    }
    EXPECT_NEAR(total / studies, static_cast<double>(cost.sequential),
                0.15 * static_cast<double>(cost.sequential))
        << rate;
  }
}

TEST(SampleSize, ClaimsThatNoNumberOfTrialsCanShowAreRefused) {
  EXPECT_THROW(plan_with_power(0.99, 0.95, 0.99, 0.8), Failure);
  EXPECT_THROW(plan_with_power(0.99, 0.95, 0.98, 0.8), Failure);
  EXPECT_THROW(trials_for_claim(1.0, 0.95, 0), Failure);
  EXPECT_THROW(trials_for_claim(0.9, 0.95, -1), Failure);
  EXPECT_THROW(trials_for_claim(1.0 - 1e-14, 0.95, 0), Failure);  // more than 10¹² trials
  EXPECT_THROW(trials_for_halfwidth(0.5, 0.95, 0.5), Failure);
  EXPECT_THROW(trials_for_halfwidth(0.1, 1.0, 0.5), Failure);
}

TEST(MachinePlan, WithOneTrialPerMachineEqualsThePlanForIndependentTrials) {
  for (const double sd : {0.01, 0.2}) {
    EXPECT_NEAR(static_cast<double>(machines_for_halfwidth(0.05, 0.95, 0.8, sd, 1)),
                static_cast<double>(trials_for_halfwidth(0.05, 0.95, 0.8)), 2.0);
  }
}

TEST(MachinePlan, WithManyTrialsOnlyDifferencesBetweenMachinesRemain) {
  // ±z·s/√R; Student's t, Clopper–Pearson and the limit by the number of machines take a little more.
  const auto machines = static_cast<double>(machines_for_halfwidth(0.05, 0.95, 0.8, 0.2, 100'000));
  EXPECT_NEAR(machines, std::pow(1.96 * 0.2 / 0.05, 2), 0.12 * machines);
  // Machines that differ less may hide some that always fail, which limits the lower bound to p·α^(1/R).
  const auto alike = static_cast<double>(machines_for_halfwidth(0.02, 0.95, 0.8, 0.1, 100'000));
  const double below = 0.8 * (1.0 - std::pow(0.025, 1.0 / alike));
  EXPECT_NEAR(0.5 * (below + 1.96 * 0.1 / std::sqrt(alike)), 0.02, 0.0005);
  EXPECT_GT(machines_for_halfwidth(0.02, 0.95, 0.8, 0.1, 10),
            machines_for_halfwidth(0.02, 0.95, 0.8, 0.1, 100));
  EXPECT_THROW(machines_for_halfwidth(0.02, 0.95, 0.9, 0.31, 10), Failure);  // s² > p(1 − p)
  EXPECT_THROW(machines_for_halfwidth(0.6, 0.95, 0.9, 0.1, 10), Failure);
}

TEST(MachinePlan, IsTheSmallestNumberOfTrialsThatShowsTheTolerance) {
  const auto shown = [](std::int64_t machines, std::int64_t trials) {
    const MachineTrials flawless{trials, trials, trials, trials};
    return machine_tolerance(std::vector<MachineTrials>(static_cast<std::size_t>(machines), flawless), 0.9,
                             0.95)
        .zero_at_least;
  };
  for (const std::int64_t machines : {29, 40, 100, 250}) {
    const MachinePlan plan = plan_tolerance(0.9, 0.97, 0.95, machines);
    EXPECT_EQ(plan.machines, machines);
    EXPECT_GE(shown(machines, plan.trials_per_machine), 0.97 * (1.0 - 1e-12));
    EXPECT_LT(shown(machines, plan.trials_per_machine - 1), 0.97);
  }
  EXPECT_GE(plan_tolerance(0.9, 0.97, 0.95).machines, 29);
  EXPECT_THROW(plan_tolerance(0.9, 0.97, 0.95, 28), Failure);
}

}  // namespace
}  // namespace zerocount::statistics
