#include "analysis/trials/jerks/jerk_statistics.hpp"

#include "analysis/basis/statistics/mean_bounds.hpp"
#include "core/failure/failure.hpp"
#include "tests/support/test.hpp"

namespace zerocount::jerks {
namespace {

using Runs = std::vector<std::pair<std::int64_t, std::int64_t>>;

std::vector<std::pair<std::int64_t, std::int64_t>> runs_of(const ObservedMove& move) {
  std::vector<std::pair<std::int64_t, std::int64_t>> runs;
  for_each_run_at_risk(move, [&](std::int64_t first, std::int64_t end) { runs.emplace_back(first, end); });
  return runs;
}

ObservedMove move_with(std::vector<SampledJerk> jerks) {
  return {.trial = 0,
          .cluster = 0,
          .arrived = true,
          .lost = false,
          .sample_time = 5e-4,
          .dwell = 100,
          .end = 200,
          .jerks = std::move(jerks)};
}

TEST(ObservedMove, IsAtRiskFromItsDwellToItsEnd) {
  EXPECT_EQ(runs_of(move_with({})), (Runs{{100, 200}}));
}

TEST(ObservedMove, IsNotAtRiskDuringAJerkAndAtItsLastSample) {
  // Samples 120 to 122 have errors, 123 is back at 0: the next jerk could begin at 124.
  EXPECT_EQ(runs_of(move_with({{120, 3, 1, true}})), (Runs{{100, 121}, {124, 200}}));
  EXPECT_EQ(runs_of(move_with({{100, 1, 1, true}, {102, 5, 1, true}})),
            (Runs{{100, 101}, {102, 103}, {108, 200}}));
}

TEST(ObservedMove, IsNoLongerAtRiskAfterAJerkThatLastsToItsEnd) {
  EXPECT_EQ(runs_of(move_with({{150, 50, 2, false}})), (Runs{{100, 151}}));
  EXPECT_EQ(runs_of(move_with({{199, 1, 1, true}})), (Runs{{100, 200}}));
}

/// SciPy 1.10: chi2.ppf(tail, 2k)/2 and chi2.isf(tail, 2k + 2)/2.
TEST(PoissonBounds, MatchSciPy) {
  struct {
    double events, confidence, low, high;
  } const scipy[] = {
      {0, 0.95, 0.0, 3.6888794541139354},
      {0, 0.99, 0.0, 5.298317366548036},
      {1, 0.9, 0.05129329438755053, 4.743864518390578},
      {1, 0.95, 0.025317807984289897, 5.571643390938898},
      {2, 0.99, 0.10349454674809108, 9.273792089255544},
      {5, 0.9, 1.97014956805953, 10.513034908741536},
      {5, 0.95, 1.623486390118421, 11.66833207932267},
      {20, 0.95, 12.216519585403946, 30.8883779026746},
      {100, 0.95, 81.36399125092315, 121.62679379242638},
      {1000, 0.99, 920.4240461633592, 1084.3728680643892},
  };
  for (const auto& [events, confidence, low, high] : scipy) {
    const statistics::ConfidenceInterval bounds = statistics::poisson_bounds(events, confidence);
    EXPECT_NEAR(bounds.low, low, 1e-10 * high) << events;
    EXPECT_NEAR(bounds.high, high, 1e-10 * high) << events;
  }
}

TEST(PoissonBounds, CoverEveryMeanWithAtLeastTheStatedConfidence) {
  for (double mean = 0.05; mean < 40.0; mean *= 1.13) {
    double covered = 0.0;
    for (int events = 0; events < 150; ++events) {
      const statistics::ConfidenceInterval bounds = statistics::poisson_bounds(events);
      if (mean < bounds.low || mean > bounds.high) continue;
      covered += std::exp(events * std::log(mean) - mean - std::lgamma(events + 1.0));
    }
    EXPECT_GE(covered, 0.95 - 1e-9) << mean;
  }
}

TEST(PoissonBounds, FractionalCountsLieBetweenWholeOnes) {
  EXPECT_GT(statistics::poisson_bounds(2.5).low, statistics::poisson_bounds(2).low);
  EXPECT_LT(statistics::poisson_bounds(2.5).high, statistics::poisson_bounds(3).high);
}

TEST(PoissonBounds, ImpossibleNumbersAreRefused) {
  EXPECT_THROW(statistics::poisson_bounds(-1.0), Failure);
  EXPECT_THROW(statistics::poisson_bounds(std::nan("")), Failure);
  EXPECT_THROW(statistics::poisson_bounds(1.0, 1.0), Failure);
}

/// A random move in which each sample that can begin a jerk does so with the probability rate(time since
/// arrival, s)·T, T the sample time.
template <typename Rate>
ObservedMove random_move(std::int64_t trial, std::int64_t end, std::mt19937_64& random, const Rate& rate) {
  std::uniform_real_distribution<double> uniform;
  ObservedMove move{.trial = trial,
                    .cluster = trial,
                    .arrived = true,
                    .lost = false,
                    .sample_time = 1e-3,
                    .dwell = 50,
                    .end = end,
                    .jerks = {}};
  for (std::int64_t k = move.dwell; k < end; ++k) {
    if (uniform(random) >= rate(1e-3 * static_cast<double>(k)) * move.sample_time) continue;
    const std::int64_t length = std::min<std::int64_t>(1 + static_cast<std::int64_t>(random() % 5), end - k);
    move.jerks.push_back({k, length, 1, true});
    k += length;  // the sample after the jerk has no error, and could not begin one
  }
  return move;
}

/// [sample of the move] whether a jerk could begin at it, decided sample by sample from the definition.
std::vector<bool> risk_by_sample(const ObservedMove& move) {
  std::vector<bool> error(static_cast<std::size_t>(move.end) + 1, false), at_risk(error.size(), false);
  for (const SampledJerk& jerk : move.jerks) {
    for (std::int64_t k = jerk.onset; k < jerk.onset + jerk.length; ++k)
      error[static_cast<std::size_t>(k)] = true;
  }
  for (std::int64_t k = move.dwell; k < move.end; ++k)
    at_risk[static_cast<std::size_t>(k)] = !error[static_cast<std::size_t>(k) - 1];
  return at_risk;
}

TEST(JerkRates, CountEveryJerkAndEverySampleAtRiskInItsRange) {
  std::mt19937_64 random(111);
  JerkRates rates;
  std::map<std::int64_t, std::pair<double, std::int64_t>> expected;  // exposure (s) and jerks by range
  double exposure = 0.0;
  std::int64_t jerks = 0;
  for (std::int64_t trial = 0; trial < 40; ++trial) {
    const ObservedMove move = random_move(trial, 51 + static_cast<std::int64_t>(random() % 3000), random,
                                          [](double) { return 9.0; });
    rates.add(move);
    const std::vector<bool> at_risk = risk_by_sample(move);
    for (std::size_t k = 0; k < at_risk.size(); ++k) {
      if (!at_risk[k]) continue;
      // A tenth of a sample later, so that rounding at an edge does not matter: 0.1 s and 1 s are samples.
      const auto range = static_cast<std::int64_t>(
          std::floor(5.0 * std::log10(move.sample_time * (static_cast<double>(k) + 1e-6))));
      expected[range].first += move.sample_time;
      exposure += move.sample_time;
    }
    for (const SampledJerk& jerk : move.jerks) {
      const auto range = static_cast<std::int64_t>(
          std::floor(5.0 * std::log10(move.sample_time * (static_cast<double>(jerk.onset) + 1e-6))));
      ++expected[range].second;
      ++jerks;
    }
  }
  const std::vector<JerkRate> found = rates.rates(0.95);
  ASSERT_EQ(found.size(), expected.size());
  auto wanted = expected.begin();
  for (const JerkRate& rate : found) {
    EXPECT_NEAR(rate.exposure, wanted->second.first, 1e-9);
    EXPECT_EQ(rate.jerks, wanted->second.second);
    EXPECT_NEAR(rate.rate, static_cast<double>(rate.jerks) / rate.exposure, 1e-12);
    exposure -= rate.exposure;
    jerks -= rate.jerks;
    ++wanted;
  }
  EXPECT_NEAR(exposure, 0.0, 1e-9);
  EXPECT_EQ(jerks, 0);
  EXPECT_EQ(found.front().from, 0.05);
  EXPECT_EQ(found.front().moves, 40);
  for (std::size_t i = 1; i < found.size(); ++i) EXPECT_EQ(found[i].from, found[i - 1].to);
}

/// How often two kinds of bounds cover the true jerk rate from 0.25 s to 0.4 s after arrival: Garwood's
/// bounds and the reported bounds.
struct RateCoverage {
  double poisson{0.0}, reported{0.0};
};

template <typename TrialRate>
RateCoverage coverage(double truth, const TrialRate& trial_rate) {
  std::mt19937_64 random(112);
  constexpr int rounds = 600;
  RateCoverage covered;
  for (int round = 0; round < rounds; ++round) {
    JerkRates rates;
    for (std::int64_t trial = 0; trial < 40; ++trial) {
      const double own = trial_rate(random);
      rates.add(random_move(trial, 400, random, [own](double) { return own; }));
    }
    const std::vector<JerkRate> all = rates.rates(0.95);
    const JerkRate& rate = all.at(all.size() - 2);  // the last one, to 0.4 s, has two samples
    covered.poisson += rate.poisson.low <= truth && truth <= rate.poisson.high;
    covered.reported += rate.bounds.low <= truth && truth <= rate.bounds.high;
  }
  return {covered.poisson / rounds, covered.reported / rounds};
}

TEST(JerkRates, BoundsCoverTheRateIfTrialsAreAlike) {
  const RateCoverage covered = coverage(5.0, [](auto&) { return 5.0; });
  EXPECT_GE(covered.poisson, 0.95 - 0.027);  // three standard errors
  EXPECT_GE(covered.reported, covered.poisson);
}

TEST(JerkRates, BoundsCoverTheMeanRateIfTrialsDiffer) {
  // Half the trials jerk, the others never do, as with creep that is strong or weak.
  const RateCoverage covered = coverage(10.0, [](auto& random) { return random() % 2 == 0 ? 20.0 : 0.0; });
  EXPECT_LT(covered.poisson, 0.9);
  EXPECT_GE(covered.reported, 0.925);
}

/// 400 moves on 40 machines, of which about half jerk: trial i runs on machine i mod 40.
std::vector<ObservedMove> moves_on_machines(std::mt19937_64& random) {
  constexpr std::int64_t machines = 40;
  std::vector<double> own(machines);
  for (double& rate : own) rate = random() % 2 == 0 ? 20.0 : 0.0;
  std::vector<ObservedMove> moves;
  for (std::int64_t trial = 0; trial < 10 * machines; ++trial) {
    const double rate = own[static_cast<std::size_t>(trial % machines)];
    moves.push_back(random_move(trial, 400, random, [rate](double) { return rate; }));
    moves.back().cluster = trial % machines;
  }
  return moves;
}

// All trials of a machine have its friction: there are 40 values, not 400.
TEST(JerkRates, BoundsCoverTheMeanRateIfMachinesDiffer) {
  constexpr double truth = 10.0;
  constexpr int rounds = 300;
  std::mt19937_64 random(113);
  double over_trials = 0.0, over_machines = 0.0;
  for (int round = 0; round < rounds; ++round) {
    JerkRates machines(true), trials;
    for (ObservedMove& move : moves_on_machines(random)) {
      machines.add(move);
      move.cluster = move.trial;
      trials.add(move);
    }
    const auto covers = [&](const JerkRates& rates) {
      const std::vector<JerkRate> all = rates.rates(0.95);
      const statistics::ConfidenceInterval& bounds = all.at(all.size() - 2).bounds;
      return bounds.low <= truth && truth <= bounds.high;
    };
    over_trials += covers(trials);
    over_machines += covers(machines);
  }
  EXPECT_LT(over_trials, 0.7 * rounds);
  EXPECT_GE(over_machines, (0.95 - 0.038) * rounds);  // three standard errors
}

// The machines come round again: in which order their moves come does not matter.
TEST(JerkRates, DoNotDependOnTheOrderOfTheMovesOfMachines) {
  std::mt19937_64 random(114);
  std::vector<ObservedMove> moves = moves_on_machines(random);
  JerkRates in_turn(true), machine_by_machine;
  for (const ObservedMove& move : moves) in_turn.add(move);
  std::stable_sort(moves.begin(), moves.end(),
                   [](const ObservedMove& a, const ObservedMove& b) { return a.cluster < b.cluster; });
  for (const ObservedMove& move : moves) machine_by_machine.add(move);
  const std::vector<JerkRate> found = in_turn.rates(0.95), expected = machine_by_machine.rates(0.95);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].jerks, expected[i].jerks);
    EXPECT_EQ(found[i].moves, expected[i].moves);
    EXPECT_NEAR(found[i].dispersion, expected[i].dispersion, 1e-9 * expected[i].dispersion);
    EXPECT_NEAR(found[i].bounds.low, expected[i].bounds.low, 1e-9);
    EXPECT_NEAR(found[i].bounds.high, expected[i].bounds.high, 1e-9);
  }
}

TEST(JerkRates, WithoutJerksHaveAnUpperBound) {
  JerkRates rates;
  ObservedMove still{.trial = 0,
                     .cluster = 0,
                     .arrived = true,
                     .lost = false,
                     .sample_time = 1e-3,
                     .dwell = 50,
                     .end = 1000,
                     .jerks = {}};
  for (; still.trial < 10; ++still.trial) rates.add(still);
  for (const JerkRate& rate : rates.rates(0.95)) {
    EXPECT_EQ(rate.rate, 0.0);
    EXPECT_EQ(rate.bounds.low, 0.0);
    EXPECT_NEAR(rate.bounds.high, 3.6888794541139354 / rate.exposure, 1e-9 * rate.bounds.high);
    EXPECT_EQ(rate.dispersion, 1.0);
  }
  EXPECT_TRUE(JerkRates().rates(0.95).empty());
  EXPECT_THROW(rates.rates(1.0), Failure);
}

}  // namespace
}  // namespace zerocount::jerks
