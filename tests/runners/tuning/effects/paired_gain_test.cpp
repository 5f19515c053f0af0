// A cause is shown where more machines gain by it than chance explains.
#include "runners/tuning/effects/effects.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::tuning {
namespace {

/// Results of machines with `moves` moves each; met[machine] of the moves meet the goal.
std::vector<MachineResult> machines(const std::vector<int>& met, int moves) {
  std::vector<MachineResult> machines;
  for (const int one : met) machines.push_back({.claims = {{moves, one, {}}}});
  return machines;
}

double tail(int differing, int gained) {
  double sum = 0.0;
  for (int k = gained; k <= differing; ++k)
    sum += std::exp(std::lgamma(differing + 1) - std::lgamma(k + 1) - std::lgamma(differing - k + 1) -
                    differing * std::log(2.0));
  return sum;
}

TEST(PairedGain, IsTheExactSignTestOfTheMachinesThatDiffer) {
  std::vector<int> before(40, 0);
  std::vector<int> after(40, 0);
  for (std::size_t i = 0; i < 14; ++i) (i < 11 ? after : before)[i] = 1 + static_cast<int>(i % 3);
  const PairedGain gain = paired_gain({}, 0, machines(before, 4), machines(after, 4), 1);
  EXPECT_EQ(gain.gained, 11);
  EXPECT_EQ(gain.lost, 3);
  EXPECT_EQ(gain.machines, 40);
  EXPECT_NEAR(gain.p_value, tail(14, 11), 1e-12);
  EXPECT_FALSE(gain.shown) << "0.029 is above 0.05/2";
  EXPECT_TRUE(paired_gain({}, 0, machines(std::vector(40, 0), 4), machines(std::vector(40, 1), 4), 20).shown);
}

// Three moves of 400 are chance.
TEST(PairedGain, AFewChangedMovesAreNotSignificant) {
  std::vector<int> before(400, 0);
  std::vector<int> after = before;
  for (std::size_t i = 0; i < 3; ++i) after[100 * i] = 1;
  EXPECT_FALSE(paired_gain({}, 0, machines(before, 1), machines(after, 1), 1).shown);
}

// The moves of a machine depend on each other: a machine that gains all its moves counts once.
TEST(PairedGain, CountsMachinesRatherThanTheirMoves) {
  const PairedGain gain =
      paired_gain({}, 0, machines({0, 0, 0, 0, 0}, 100), machines({90, 80, 95, 70, 99}, 100), 10);
  EXPECT_NEAR(gain.p_value, 1.0 / 32.0, 1e-12);
  EXPECT_FALSE(gain.shown);
  EXPECT_EQ(machines_to_show_a_gain(10), 9);  // 2⁻⁹ ≤ 0.025/10 < 2⁻⁸
}

// Of a claim about machines those count that meet it in as many of their moves as it asks.
TEST(PairedGain, ForMachinesEqualsMcNemarsTest) {
  const study::Goal claim{.moves = 0.5, .machines = 0.9};
  const PairedGain gain = paired_gain(claim, 0, machines({1, 1, 4, 9}, 10), machines({4, 5, 5, 4}, 10), 1);
  EXPECT_EQ(gain.gained, 2);
  EXPECT_EQ(gain.lost, 1);
}

// If no cause matters, one of a list is named with 2.5 % at most.
TEST(PairedGain, AllowsForTheNumberOfCauses) {
  constexpr int causes = 12;
  constexpr int studies = 2000;
  int named = 0;
  for (int study = 0; study < studies; ++study) {
    testing::Draws draws(static_cast<std::uint64_t>(study) + 1);
    std::vector<int> before;
    for (int machine = 0; machine < 60; ++machine) before.push_back(draws.chance(0.5) ? 1 : 0);
    bool any = false;
    for (int cause = 0; cause < causes; ++cause) {
      std::vector<int> after;
      for (int machine = 0; machine < 60; ++machine) after.push_back(draws.chance(0.5) ? 1 : 0);
      any = any || paired_gain({}, 0, machines(before, 1), machines(after, 1), causes).shown;
    }
    named += any ? 1 : 0;
  }
  EXPECT_LE(named, 65);  // 50 and two standard deviations
}

}  // namespace
}  // namespace zerocount::tuning
