// Measured machines beside simulated ones.
#include "analysis/basis/statistics/clusters/observed_test.hpp"
#include "analysis/machine/acceptance/acceptance.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using acceptance::Agreement;
using acceptance::agreement_of;
using statistics::MachineMoves;

/// Random machines whose proportions of moves that meet a goal are uniformly distributed around a centre.
class Machines {
 public:
  Machines(std::uint64_t seed, double centre, double spread)
      : draws_(seed), centre_(centre), spread_(spread) {}

  std::int64_t met_of(std::int64_t moves) {
    const double rate = draws_.uniform(centre_ - spread_, centre_ + spread_);
    std::int64_t met = 0;
    for (std::int64_t i = 0; i < moves; ++i) met += draws_.uniform(0.0, 1.0) < rate ? 1 : 0;
    return met;
  }
  std::vector<MachineMoves> simulated(int count, std::int64_t moves) {
    std::vector<MachineMoves> machines;
    for (int i = 0; i < count; ++i)
      machines.push_back({.trials = moves, .moves = moves, .met = met_of(moves)});
    return machines;
  }

 private:
  Draws draws_;
  double centre_, spread_;
};

// For one machine the exact rank test is known.
TEST(Agreement, ForOneMachineEqualsTheRankTest) {
  Machines machines(1, 0.8, 0.15);
  for (int i = 0; i < 10; ++i) {
    const std::vector<MachineMoves> simulated = machines.simulated(50, 60);
    const std::vector<std::int64_t> met{machines.met_of(40)};
    std::vector<std::int64_t> successes;
    for (const MachineMoves& machine : simulated) successes.push_back(machine.met);
    const double exact = statistics::machine_rank_test({met[0], 40}, successes, 60).p;
    const Agreement agreement = agreement_of(met, 40, simulated, 1);
    EXPECT_EQ(agreement.p, exact) << i;
    // One more machine, of another number of moves, calls for the permutation test.
    std::vector<MachineMoves> uneven = simulated;
    uneven.push_back({.trials = 61, .moves = 61, .met = 48});
    EXPECT_NEAR(agreement_of(met, 40, uneven, 1).p, exact, 5.0 * std::sqrt(exact / 9999.0) + 0.04) << i;
    EXPECT_NEAR(agreement.lowest_p, 2.0 / 51.0, 1e-12);
  }
}

TEST(Agreement, IsSeldomRejectedForMachinesOfTheSimulatedPopulation) {
  Machines machines(2, 0.85, 0.1);
  constexpr int studies = 120;
  int refused = 0;
  for (int i = 0; i < studies; ++i) {
    const std::vector<MachineMoves> simulated = machines.simulated(20, 50);
    const std::vector<std::int64_t> met{machines.met_of(30), machines.met_of(30), machines.met_of(30)};
    refused += agreement_of(met, 30, simulated, static_cast<std::uint64_t>(i)).p <= 0.05 ? 1 : 0;
  }
  EXPECT_LE(refused, 0.05 * studies + 3.1 * std::sqrt(0.05 * studies));
  EXPECT_GE(refused, 1);
}

TEST(Agreement, IsRejectedForWorseMachines) {
  Machines built(3, 0.6, 0.05);
  Machines simulated(4, 0.9, 0.05);
  const std::vector<std::int64_t> met{built.met_of(100), built.met_of(100), built.met_of(100)};
  const Agreement agreement = agreement_of(met, 100, simulated.simulated(40, 200), 1);
  EXPECT_LE(agreement.p, 0.001);
  EXPECT_TRUE(agreement.is_lower);
  EXPECT_GT(agreement.predicted.low, 0.8);
  EXPECT_LT(agreement.predicted.high, 1.0);
  EXPECT_EQ(agreement.met, met[0] + met[1] + met[2]);
}

// Of machines that are the simulated ones about 95 % are in the interval.
TEST(Agreement, PredictionIntervalHolds95PercentOfFutureMachines) {
  Machines machines(5, 0.85, 0.1);
  const Agreement agreement =
      agreement_of(std::vector<std::int64_t>{40, 40}, 50, machines.simulated(300, 50), 1);
  int inside = 0;
  constexpr int pairs = 2000;
  for (int i = 0; i < pairs; ++i) {
    const double rate = static_cast<double>(machines.met_of(50) + machines.met_of(50)) / 100.0;
    inside += rate >= agreement.predicted.low && rate <= agreement.predicted.high ? 1 : 0;
  }
  EXPECT_GE(inside, 0.93 * pairs);
  EXPECT_LE(inside, 0.98 * pairs);
}

}  // namespace
}  // namespace zerocount::testing
