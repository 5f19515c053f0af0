#include "analysis/basis/statistics/clusters/observed_test.hpp"

#include "core/failure/failure.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

using Random = std::mt19937_64;

TEST(ObservedTest, MatchesSciPy) {
  const testing::TemporaryFolder folder;
  std::ofstream cases(folder / "cases");
  Random random(151);
  constexpr int rounds = 200;
  for (int round = 0; round < rounds; ++round) {
    // Against all simulated trials, some of them many, and against machines.
    const auto n = static_cast<std::int64_t>(1 + random() % 40);
    const auto k = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(n + 1));
    const std::int64_t simulated =
        round % 3 == 0 ? 1'000'000 : static_cast<std::int64_t>(20 + random() % 500);
    const auto successes = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(simulated + 1));
    cases << fmt::format("{} {} {} {} {}", fisher_test({k, n}, {successes, simulated}).p, k, n, successes,
                         simulated);
    std::vector<std::int64_t> of_machines;
    for (int machine = 0; machine < 5 + round % 60; ++machine)
      of_machines.push_back(static_cast<std::int64_t>(random() % 61));
    cases << fmt::format(" {} 60", machine_rank_test({k, n}, of_machines, 60).p);
    for (const std::int64_t each : of_machines) cases << ' ' << each;
    cases << '\n';
  }
  cases.close();
  const std::string command =
      fmt::format("{} {} observed {} > {} 2>&1", ZEROCOUNT_PYTHON, ZEROCOUNT_STATISTICS_JUDGE,
                  (folder / "cases").string(), (folder / "out").string());
  EXPECT_EQ(std::system(command.c_str()), 0) << folder.read("out");
  EXPECT_EQ(folder.read("out"), fmt::format("{} samples\n", rounds));
}

// Neither the order of the two samples nor the name of success matters. With up to 100 000 trials, terms that
// each took a library's factorials would take minutes.
TEST(ObservedTest, IsSymmetric) {
  Random random(154);
  for (int round = 0; round < 100; ++round) {
    const auto up_to = [&](std::int64_t most) {
      return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(most + 1));
    };
    const std::int64_t n = 1 + up_to(round % 2 == 0 ? 50 : 2000);
    const std::int64_t m = 1 + up_to(round % 4 < 2 ? 300 : 100'000);
    const double rate = static_cast<double>(up_to(1000)) / 1000.0;
    const std::int64_t k = std::binomial_distribution<std::int64_t>(n, rate)(random);
    const std::int64_t successes = std::binomial_distribution<std::int64_t>(m, rate)(random);
    const double p = fisher_test({k, n}, {successes, m}).p;
    EXPECT_GT(p, 0.0);
    EXPECT_NEAR(fisher_test({successes, m}, {k, n}).p / p, 1.0, 1e-9) << k << ' ' << n;
    EXPECT_NEAR(fisher_test({n - k, n}, {m - successes, m}).p / p, 1.0, 1e-9) << successes << ' ' << m;
  }
}

TEST(ObservedTest, RaisesFalseAlarmsNoMoreOftenThanStated) {
  Random random(152);
  constexpr int rounds = 4000;
  int fisher = 0;
  for (int round = 0; round < rounds; ++round) {
    std::binomial_distribution<std::int64_t> real(12, 0.8), simulated(300, 0.8);
    fisher += fisher_test({real(random), 12}, {simulated(random), 300}).p <= 0.05;
  }
  EXPECT_LE(fisher, 0.05 * rounds + 3.0 * std::sqrt(0.0475 * rounds));
  EXPECT_GE(fisher, 0.005 * rounds);
  std::cout << "Fisher: " << 100.0 * fisher / rounds << " % false alarms\n";
}

/// The random success probability of a machine: most machines are good, some are not.
double of_a_machine(Random& random) {
  return random() % 5 == 0 ? 0.3 : 0.95;
}

// The real machine is one more of these machines. Taken for independent trials of all of them, its own would
// differ far too often.
TEST(ObservedTest, AllowsForDifferencesBetweenMachines) {
  Random random(153);
  constexpr int rounds = 3000;
  int ranks = 0, fisher = 0;
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::int64_t> of_machines;
    std::int64_t all = 0;
    for (int machine = 0; machine < 100; ++machine) {
      of_machines.push_back(std::binomial_distribution<std::int64_t>(20, of_a_machine(random))(random));
      all += of_machines.back();
    }
    const std::int64_t real = std::binomial_distribution<std::int64_t>(15, of_a_machine(random))(random);
    ranks += machine_rank_test({real, 15}, of_machines, 20).p <= 0.05;
    fisher += fisher_test({real, 15}, {all, 2000}).p <= 0.05;
  }
  EXPECT_LE(ranks, 0.05 * rounds + 3.0 * std::sqrt(0.0475 * rounds));
  EXPECT_GE(fisher, 0.15 * rounds);
  std::cout << "rank among machines: " << 100.0 * ranks / rounds << " % false alarms, Fisher on them "
            << 100.0 * fisher / rounds << " %\n";
}

TEST(ObservedTest, RejectsAMachineOutsideThePopulation) {
  std::vector<std::int64_t> of_machines;
  for (int machine = 0; machine < 100; ++machine) of_machines.push_back(18 + machine % 3);
  EXPECT_LE(machine_rank_test({4, 15}, of_machines, 20).p, 0.02);
  EXPECT_GT(machine_rank_test({14, 15}, of_machines, 20).p, 0.3);
  EXPECT_LT(fisher_test({2, 10}, {980, 1000}).p, 1e-6);
}

TEST(ObservedTest, ReportsTheSmallestPossiblePValue) {
  EXPECT_GT(fisher_test({2, 2}, {50, 100}).lowest_p, 0.05);
  EXPECT_LT(fisher_test({2, 2}, {98, 100}).lowest_p, 0.05);
  const std::vector<std::int64_t> few(20, 10);
  EXPECT_DOUBLE_EQ(machine_rank_test({0, 20}, few, 20).lowest_p, 2.0 / 21.0);
  EXPECT_THROW(machine_rank_test({1, 21}, few, 20), Failure);
  EXPECT_THROW(fisher_test({3, 2}, {1, 2}), Failure);
}

}  // namespace
}  // namespace zerocount::statistics
