// paper-gains: the five gains of section 4 behave as the paper reports, on axes whose friction differs. The
// bounds are wider than those of a few tests: "all" is 98 % or more, "most" is 50 to 80 %.
#include <set>
#include <string>
#include <vector>

#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

std::int64_t stable_at_gain(const std::string& gain, std::int64_t trials) {
  return moves_with(outcomes_of(shipped_study("paper-gains"), gain, trials),
                    [](const trial::MoveOutcome& move) { return move.stable; });
}

TEST(PaperGains, GainAIsStableInAllTests) {
  EXPECT_TRUE(share_above(0.995, stable_at_gain("a", 1500), 1500));
}

TEST(PaperGains, GainBIsStableInSomeAndUnstableInMost) {
  const std::int64_t stable = stable_at_gain("b", 600);
  EXPECT_TRUE(share_above(0.20, stable, 600));
  EXPECT_TRUE(share_below(0.50, stable, 600));
}

TEST(PaperGains, AProportionalGainMakesItStable) {
  EXPECT_TRUE(share_above(0.98, stable_at_gain("b-with-kp", 10000), 10000));
}

TEST(PaperGains, GainCIsSeldomStable) {
  const std::int64_t stable = stable_at_gain("c", 2000);
  EXPECT_TRUE(share_above(0.02, stable, 2000));
  EXPECT_TRUE(share_below(0.12, stable, 2000));
}

TEST(PaperGains, AboveTheUpperBoundHardlyAnyMoveIsStable) {
  EXPECT_TRUE(share_below(0.03, stable_at_gain("above-upper", 1000), 1000));
}

// Early decision saves time, and changes no verdict.
TEST(PaperGains, TheTrialsThatAreStoppedWouldNotHaveComeBack) {
  const study::Study stopped = shipped_study("paper-gains");
  const study::Study run_on = shipped_study("paper-gains", {"verdict.stop=false"});
  for (const char* gain : {"b", "c", "above-upper"}) {
    const auto early = outcomes_of(stopped, gain, 60);
    const auto late = outcomes_of(run_on, gain, 60);
    for (std::size_t i = 0; i < early.size(); ++i) {
      EXPECT_EQ(early[i].moves[0].stable, late[i].moves[0].stable) << gain << " " << i;
      EXPECT_EQ(early[i].moves[0].outcome, late[i].moves[0].outcome) << gain << " " << i;
    }
  }
}

TEST(PaperGains, EveryAxisHasAFrictionOfItsOwnAndEveryMoveAStartOfItsOwn) {
  const study::Study study = shipped_study("paper-gains", {"rigs=500"});
  std::set<double> k1, k2, beta, exponent, preload;
  for (std::int64_t index = 0; index < 2 * study.rigs; ++index) {
    const trial::TrialParameters p = trial_of(study, "a", index);
    k1.insert(friction::friction_at(p.friction, p.initial.position).k1);
    k2.insert(p.friction.uniform.k2);
    beta.insert(p.friction.uniform.beta);
    exponent.insert(p.friction.uniform.n);
    preload.insert(p.initial.preload);
  }
  const auto rigs = static_cast<std::size_t>(study.rigs);
  for (const auto& values : {k2, beta, exponent}) EXPECT_EQ(values.size(), rigs);
  EXPECT_EQ(k1.size(), 2 * rigs) << "by place on the rotor";
  EXPECT_EQ(preload.size(), 2 * rigs);
}

}  // namespace
}  // namespace zerocount::testing
