#include "analysis/basis/statistics/clusters/machine_statistics.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/random/beta_distribution.hpp>

#include "analysis/basis/statistics/clusters/machine_proportion.hpp"
#include "analysis/basis/statistics/clusters/trial_clusters.hpp"
#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/basis/statistics/sums/state.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "core/failure/failure.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

MachineTrials machine_with(std::int64_t trials, std::int64_t successes, std::int64_t moves = 1) {
  return {trials, successes, trials * moves, successes * moves};
}

std::vector<MachineTrials> machines_with(std::int64_t trials, const std::vector<std::int64_t>& successes) {
  std::vector<MachineTrials> machines;
  for (const std::int64_t k : successes) machines.push_back(machine_with(trials, k));
  return machines;
}

TEST(MachineStatistics, CountsTheMachinesWithoutFailureAndTheWorst) {
  std::vector<std::int64_t> successes(40, 10);
  successes[3] = 4;
  successes[17] = 1;
  successes[30] = 9;
  const MachineStatistics found = machine_statistics(machines_with(10, successes));
  EXPECT_EQ(found.n, 40);
  EXPECT_NEAR(found.without_failure, 37.0 / 40.0, 1e-15);
  EXPECT_EQ(found.without_failure_bounds.low, clopper_pearson(37, 40).low);
  EXPECT_EQ(found.without_failure_bounds.high, clopper_pearson(37, 40).high);
  EXPECT_NEAR(found.worst_5_percent, 0.5 * (0.1 + 0.4), 1e-15);  // 2 of 40
  EXPECT_NEAR(machine_statistics(machines_with(10, {3, 8, 10})).worst_5_percent, 0.3,
              1e-15);  // 1 of fewer than 20
  EXPECT_EQ(machine_statistics({}).n, 0);
  EXPECT_THROW(machine_statistics(machines_with(10, successes), 1.0), Failure);
}

/// A beta-binomial sample has the standard deviation of its beta distribution, whatever the number of trials.
TEST(MachineStatistics, StandardDeviationEstimatesThatOfTheProbabilities) {
  std::mt19937_64 random(61);
  for (const double sd : {0.0, 0.1, 0.3}) {
    for (const std::int64_t trials : {2, 10, 100}) {
      constexpr double mean = 0.7;
      const double size = sd > 0.0 ? mean * (1.0 - mean) / (sd * sd) - 1.0 : 0.0;
      std::vector<std::int64_t> successes;
      for (int machine = 0; machine < 4000; ++machine) {
        const double p =
            sd > 0.0 ? boost::random::beta_distribution<double>(mean * size, (1.0 - mean) * size)(random)
                     : mean;
        successes.push_back(std::binomial_distribution<std::int64_t>(trials, p)(random));
      }
      const double found = machine_statistics(machines_with(trials, successes)).success_sd;
      // Of nothing, the estimated variance errs by its standard error to either side, or is cut off at 0.
      EXPECT_NEAR(found * found, sd * sd, 0.02 / static_cast<double>(trials) + 0.005) << sd << " " << trials;
    }
  }
  EXPECT_TRUE(std::isnan(machine_statistics(machines_with(1, {1, 0, 1})).success_sd));
  EXPECT_EQ(machine_statistics(machines_with(10, {5, 5, 5, 5})).success_sd, 0.0);
}

TEST(MachineTolerance, WithoutFailuresIsTheBoundOfOneMachine) {
  // 29 machines are the fewest that show a content of 90 % with 95 % confidence: 0.9^29 < 0.05.
  const MachineTolerance few =
      machine_tolerance(machines_with(100, std::vector<std::int64_t>(28, 100)), 0.9, 0.95);
  EXPECT_TRUE(std::isnan(few.zero_at_least));
  EXPECT_EQ(few.min_machines, 29);
  EXPECT_EQ(tolerance_sentence(few),
            "with 95 % confidence, it takes 29 machines to say in how many moves 90 % of machines hold zero");
  // With 40 machines, those below the worst are at most p = 1 − 0.05^(1/40) = 7.2 % of all; a machine that
  // shows no failure in 100 trials with a probability of δ = 1 − p/10 % = 28 % holds zero in δ^(1/100) = 98.7
  // %.
  const MachineTolerance all =
      machine_tolerance(machines_with(100, std::vector<std::int64_t>(40, 100)), 0.9, 0.95);
  const double p = 1.0 - std::pow(0.05, 1.0 / 40.0);
  EXPECT_NEAR(all.zero_at_least, std::pow(1.0 - p / 0.1, 1.0 / 100.0), 1e-9);
  EXPECT_EQ(tolerance_sentence(all),
            "with 95 % confidence at least 90 % of machines hold zero in at least 98.7 % of moves");
}

TEST(MachineTolerance, MovesOfATrialCountAsOneObservation) {
  // Without a failure, ten moves a trial show no more than one does.
  std::vector<MachineTrials> one, ten;
  for (int machine = 0; machine < 60; ++machine) {
    one.push_back(machine_with(50, 50));
    ten.push_back(machine_with(50, 50, 10));
  }
  EXPECT_NEAR(machine_tolerance(ten, 0.9, 0.95).zero_at_least,
              machine_tolerance(one, 0.9, 0.95).zero_at_least, 1e-9);
  // With failures the bound for moves that may be alike is below that for trials of one move.
  for (MachineTrials& machine : one) machine = machine_with(50, 45);
  for (MachineTrials& machine : ten) machine = machine_with(50, 45, 10);
  EXPECT_LT(machine_tolerance(ten, 0.9, 0.95).zero_at_least, machine_tolerance(one, 0.9, 0.95).zero_at_least);
  EXPECT_GT(machine_tolerance(ten, 0.9, 0.95).zero_at_least, 0.7);
  for (MachineTrials& machine : ten) machine = machine_with(50, 0, 10);
  EXPECT_EQ(machine_tolerance(ten, 0.9, 0.95).zero_at_least, 0.0);
}

TEST(MachineTolerance, OmitsAsManyMachinesAsItsRankAllows) {
  // Of 100 machines the third worst counts: two that always fail cost nothing.
  std::vector<std::int64_t> successes(100, 200);
  const double best = machine_tolerance(machines_with(200, successes), 0.9, 0.95).zero_at_least;
  successes[1] = successes[7] = 0;
  EXPECT_EQ(machine_tolerance(machines_with(200, successes), 0.9, 0.95).zero_at_least, best);
  successes[9] = 0;
  EXPECT_EQ(machine_tolerance(machines_with(200, successes), 0.9, 0.95).zero_at_least, 0.0);
}

// Bounds of the proportion of machines that meet a requirement in a proportion of their moves.

// If all machines pass, only the highest mark can show so much, and has all of the error.
TEST(MachineProportion, AllPassingGivesWilksBoundLessTheErrorOfFewMoves) {
  // 100 moves: P(B ≥ 57) = 0.0966 ≤ 0.1 for B binomial (100, ½).
  const std::vector<MachineMoves> machines(300, {100, 100, 100});
  const MachineProportion found = machine_proportion(machines, {0.5, 0.95, 0.95});
  const double all_pass = std::pow(0.05, 1.0 / 300.0);
  const double wrong = binomial_upper_tail(100, 0.5, 56);
  EXPECT_LE(wrong, 0.1);
  EXPECT_EQ(found.meeting, 300);
  EXPECT_NEAR(found.low, (all_pass - wrong) / (1.0 - wrong), 1e-12);
  EXPECT_EQ(found.high, 1.0);
  // Five moves hardly tell a machine at 99 % from one at 98 %.
  EXPECT_LT(machine_proportion(std::vector<MachineMoves>(300, {5, 5, 5}), {0.99, 0.95, 0.95}).low, 0.9);
  // Wilks: 59 machines show 95 %, 58 do not.
  EXPECT_GE(machine_proportion(std::vector<MachineMoves>(59, {4000, 4000, 4000}), {0.9, 0.95, 0.95}).low,
            0.95);
  EXPECT_LT(machine_proportion(std::vector<MachineMoves>(58, {4000, 4000, 4000}), {0.9, 0.95, 0.95}).low,
            0.95);
}

TEST(MachineProportion, AllFailingGivesASmallUpperBound) {
  const MachineProportion found =
      machine_proportion(std::vector<MachineMoves>(100, {200, 200, 20}), {0.9, 0.9, 0.95});
  EXPECT_EQ(found.meeting, 0);
  EXPECT_EQ(found.low, 0.0);
  EXPECT_NEAR(found.high, 1.0 - std::pow(0.05, 1.0 / 100.0), 4e-3);
}

// Where machines are well above the requirement and miss at times, a bound by those without a miss is poor.
TEST(MachineProportion, SeveralThresholdsGiveASharperBoundThanOne) {
  std::mt19937_64 random(3);
  const auto median_low = [&](double good, double bad, std::int64_t machines, std::int64_t moves) {
    std::vector<double> found;
    for (int study = 0; study < 51; ++study) {
      std::vector<MachineMoves> drawn;
      for (std::int64_t machine = 0; machine < machines; ++machine) {
        std::binomial_distribution<std::int64_t> met(moves, machine % 10 == 0 ? bad : good);
        drawn.push_back({moves, moves, met(random)});
      }
      found.push_back(machine_proportion(drawn, {0.95, 0.9, 0.95}).low);
    }
    std::ranges::sort(found);
    return found[25];
  };
  EXPECT_GT(median_low(0.99, 0.99, 100, 30), 0.72);    // by those without a miss 0.57
  EXPECT_GT(median_low(0.975, 0.975, 300, 100), 0.8);  // 0.62
  EXPECT_GT(median_low(0.99, 0.8, 300, 100), 0.75);    // of 0.9
}

// Half of the machines hold far fewer moves than the claim asks for: the bound on the proportion stays near
// one half.
TEST(MachineProportion, HalfOfTheMachinesFailingBoundsTheProportionNearOneHalf) {
  std::vector<MachineMoves> machines(200, {20, 20, 20});
  for (std::size_t machine = 0; machine < machines.size(); machine += 2) machines[machine].met = 4;
  const MachineProportion found = machine_proportion(machines, {0.9, 0.95, 0.95});
  // The proportion of those that may be at the requirement, 0.5, by a Clopper–Pearson bound at 99.75 %, and
  // that of those that pass.
  EXPECT_GT(found.low, 0.36);
  EXPECT_LT(found.low, 0.5);
  EXPECT_GT(found.high, 0.5);
}

TEST(MachineProportion, IsUnknownWithoutMachines) {
  const MachineProportion none = machine_proportion({}, {0.9, 0.9, 0.95});
  EXPECT_EQ(none.meeting, 0);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_EQ(none.high, 1.0);
}

/// A population of random machines, on which studies are simulated. In half of the studies the moves of a
/// trial all have the same result.
struct Population {
  double meeting;  ///< proportion of machines whose proportion of good moves is at or above the requirement
  /// Proportions of good moves of a machine at or above the requirement, and of a machine below it.
  double above, below;
};

class MachineProportionCoverage : public ::testing::TestWithParam<Population> {};

TEST_P(MachineProportionCoverage, BoundsHold) {
  constexpr double proportion = 0.95, wanted = 0.9, confidence = 0.95;
  constexpr int studies = 600;
  const Population population = GetParam();
  std::mt19937_64 random(36);
  for (const int moves_of_trial : {1, 4}) {
    for (const int trials : {10, 100}) {
      int too_high = 0, too_low = 0;
      for (int study = 0; study < studies; ++study) {
        std::vector<MachineMoves> machines;
        for (int machine = 0; machine < 80; ++machine) {
          const bool meets = std::bernoulli_distribution(population.meeting)(random);
          std::binomial_distribution<std::int64_t> met(trials, meets ? population.above : population.below);
          machines.push_back({trials, trials * moves_of_trial, met(random) * moves_of_trial});
        }
        const MachineProportion found = machine_proportion(machines, {proportion, wanted, confidence});
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

// Machines just below and just on the requirement are the hardest to tell apart.
INSTANTIATE_TEST_SUITE_P(, MachineProportionCoverage,
                         ::testing::Values(Population{0.9, 0.95, 0.949}, Population{0.0, 1.0, 0.9499},
                                           Population{1.0, 0.95, 0.0}, Population{0.8, 0.99, 0.9},
                                           Population{0.95, 1.0, 0.5}));

constexpr std::int64_t moves = 3;

/// The measured values of a trial that are not censored (cut off by the end of the move): few distinct ones,
/// so there are ties.
std::vector<double> values_of(std::int64_t trial) {
  std::mt19937_64 random(static_cast<std::uint64_t>(trial));
  std::vector<double> values;
  for (std::int64_t move = 0; move < moves; ++move) {
    if (random() % 5 != 0) values.push_back(static_cast<double>(random() % 20));
  }
  return values;
}

TrialClusters clusters_of(std::int64_t machines, std::int64_t first, std::int64_t end) {
  TrialClusters clusters(machines);
  for (std::int64_t trial = first; trial < end; ++trial) {
    std::vector<double> values = values_of(trial);
    clusters.add_trial(trial, values, moves);
  }
  return clusters;
}

State state_of(const TrialClusters& clusters) {
  State state;
  StateWriter writer(state);
  writer(clusters);
  return state;
}

class TrialClustersByMachineCount : public ::testing::TestWithParam<std::int64_t> {};

TEST_P(TrialClustersByMachineCount, MomentsEqualThoseOfTheValuesOfEachMachine) {
  const std::int64_t machines = GetParam();
  constexpr std::int64_t trials = 700;
  std::vector<std::vector<double>> by_machine(static_cast<std::size_t>(machines));
  for (std::int64_t trial = 0; trial < trials; ++trial) {
    const std::vector<double> values = values_of(trial);
    std::vector<double>& machine = by_machine[static_cast<std::size_t>(trial % machines)];
    machine.insert(machine.end(), values.begin(), values.end());
  }
  const ClusteredSample sample = clusters_of(machines, 0, trials).sample();
  EXPECT_EQ(sample.size(), moves * trials);
  for (const double x : {-1.0, 4.0, 11.5, 30.0}) {
    ClusterSums expected;
    for (std::int64_t machine = 0; machine < machines; ++machine) {
      const std::vector<double>& values = by_machine[static_cast<std::size_t>(machine)];
      const auto hits = std::count_if(values.begin(), values.end(), [&](double value) { return value <= x; });
      expected.add(hits, moves * ((trials - machine + machines - 1) / machines));
    }
    const ClusterSums found = sample.at_most(x);
    EXPECT_EQ(found.clusters, std::min(machines, trials));
    EXPECT_EQ(found.hits, expected.hits);
    EXPECT_EQ(found.events, moves * trials);
    EXPECT_EQ(found.hits_squared, expected.hits_squared);
    EXPECT_EQ(found.hits_by_events, expected.hits_by_events);
    EXPECT_EQ(found.events_squared, expected.events_squared);
  }
}

TEST_P(TrialClustersByMachineCount, BlocksMergeInAnyOrder) {
  const std::int64_t machines = GetParam();
  constexpr std::int64_t trials = 700;
  const State whole = state_of(clusters_of(machines, 0, trials));
  std::mt19937_64 random(7);
  for (int order = 0; order < 20; ++order) {
    std::vector<TrialClusters> blocks;
    for (std::int64_t first = 0; first < trials;) {
      const std::int64_t end =
          std::min<std::int64_t>(trials, first + 1 + static_cast<std::int64_t>(random() % 90));
      blocks.push_back(clusters_of(machines, first, end));
      first = end;
    }
    std::shuffle(blocks.begin(), blocks.end(), random);
    TrialClusters sum(machines);
    for (const TrialClusters& block : blocks) sum += block;
    const State state = state_of(sum);
    EXPECT_EQ(state.whole, whole.whole);
    EXPECT_EQ(state.real, whole.real);
    TrialClusters again(machines);
    StateReader reader(state.whole, state.real);
    reader(again);
    reader.require_end();
    again += clusters_of(machines, trials, trials + 50);
    EXPECT_EQ(state_of(again).whole, state_of(clusters_of(machines, 0, trials + 50)).whole);
  }
}

TEST(TrialClusters, AddingAColumnEqualsAddingItsTrials) {
  std::mt19937_64 random(9);
  for (const std::int64_t machines : {0, 0, 7}) {
    TrialClusters one_by_one(machines), by_column(machines);
    for (std::int64_t trial = 0; trial < 3000;) {
      // Single values before and after trials of several; columns of repeated and of different values.
      const std::size_t of_trial = random() % 4 == 0 ? 1 + random() % 3 : 1;
      const bool nan_is_late = random() % 2 == 0;
      const std::uint64_t distinct = random() % 2 == 0 ? 20 : 1'000'000;
      const auto trials = static_cast<std::int64_t>(1 + random() % 400);
      std::vector<double> column;
      for (std::int64_t i = 0; i < trials; ++i) {
        std::vector<double> observed;
        for (std::size_t j = 0; j < of_trial; ++j) {
          column.push_back(random() % 5 == 0 ? unknown : static_cast<double>(random() % distinct));
          if (column.back() == column.back()) observed.push_back(column.back());
        }
        const auto size = static_cast<std::int64_t>(nan_is_late ? of_trial : observed.size());
        one_by_one.add_trial(trial + i, observed, size);
      }
      by_column.add_trials(trial, column, of_trial, nan_is_late);
      trial += trials;
      EXPECT_EQ(by_column.size(), one_by_one.size());
    }
    EXPECT_EQ(state_of(by_column).whole, state_of(one_by_one).whole);
    EXPECT_EQ(state_of(by_column).real, state_of(one_by_one).real);
  }
}

// Few machines with many trials, about as many, and machines without a trial.
INSTANTIATE_TEST_SUITE_P(Machines, TrialClustersByMachineCount, ::testing::Values(1, 7, 64, 699, 5000));

}  // namespace
}  // namespace zerocount::statistics
