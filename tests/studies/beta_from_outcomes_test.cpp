// beta-from-outcomes: the default of β is the one at which the five gains behave as the paper reports
// (section 4). The proportions are those of moves that arrived and stayed within one count.
#include <string>

#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t beta_trials = 250;

std::int64_t stable_moves_at(const std::string& gain, const std::string& beta,
                             const std::string& delay = "0") {
  const study::Study study = shipped_study("beta-from-outcomes");
  const std::string point = gain + ", friction.beta=" + beta + ", controller.delay=" + delay;
  return moves_with(outcomes_of(study, point, beta_trials),
                    [](const trial::MoveOutcome& move) { return move.stable; });
}

TEST(BetaFromOutcomes, AtTheDefaultAllFiveGainsBehaveAsThePaperSaw) {
  const std::string beta = "100000";
  EXPECT_TRUE(share_above(0.97, stable_moves_at("a", beta), beta_trials)) << "stable in all tests";
  EXPECT_TRUE(share_above(0.20, stable_moves_at("b", beta), beta_trials)) << "stable in some cases";
  EXPECT_TRUE(share_below(0.50, stable_moves_at("b", beta), beta_trials)) << "but is unstable in most cases";
  EXPECT_TRUE(share_above(0.97, stable_moves_at("b-with-kp", beta), beta_trials))
      << "stable in all the cases we tested";
  EXPECT_TRUE(share_below(0.16, stable_moves_at("c", beta), beta_trials)) << "only remains stable once";
  EXPECT_TRUE(share_below(0.07, stable_moves_at("above-upper", beta), beta_trials))
      << "unstable in all the tests";
}

TEST(BetaFromOutcomes, ASpringThatSoftensLaterIsTooStable) {
  EXPECT_TRUE(share_above(0.55, stable_moves_at("b", "50000"), beta_trials))
      << "the paper: unstable in most cases";
}

TEST(BetaFromOutcomes, ASpringThatSoftensSoonerIsTooUnstable) {
  EXPECT_TRUE(share_below(0.92, stable_moves_at("b-with-kp", "200000"), beta_trials))
      << "the paper: stable in all the cases we tested";
}

// With half a sample of delay or more, no β makes gain b unstable in most moves and keeps the gain with kp.
TEST(BetaFromOutcomes, NoBetaAgreesWithADelayOfASample) {
  EXPECT_TRUE(share_below(0.95, stable_moves_at("b-with-kp", "50000", "1"), beta_trials));
  EXPECT_TRUE(share_above(0.80, stable_moves_at("b", "25000", "1"), beta_trials))
      << "a smaller β is no way out";
  EXPECT_TRUE(share_above(0.93, stable_moves_at("b-with-kp", "70000", "0.3"), beta_trials));
  EXPECT_TRUE(share_below(0.95, stable_moves_at("b-with-kp", "100000", "0.3"), beta_trials));
}

TEST(BetaFromOutcomes, TheDefaultIsTheInferredValue) {
  const study::Study study = shipped_study("paper-fig7");
  EXPECT_EQ(trial_of(study, "command.targets.0=1", 0).friction.uniform.beta, 1.0e5);
}

// What breaks the gain with kp at a large β is sampling: the loop that is unstable at 2 kHz is stable at
// 20 kHz, and a contact that cannot break away does not help it.
TEST(BetaFromOutcomes, TheGainWithKpFailsAtALargeBetaBecauseOfSampling) {
  const auto stable_with = [](const std::string& setting, const std::string& gains) {
    const study::Study study = shipped_study(
        "beta-from-outcomes", {setting, "sweep={cases: {b-with-kp: " + gains + "}}", "observed={}",
                               "friction.beta=2.0e+5", "command.hold=0.5", "verdict.stop=false"});
    return moves_with(outcomes_of(study, "b-with-kp", 150),
                      [](const trial::MoveOutcome& move) { return move.stable; });
  };
  const std::string at_2_kHz = "{controller.ki: 9.45e-5, controller.kp: 6.21e-4}";
  const std::string at_20_kHz = "{controller.ki: 9.45e-6, controller.kp: 6.21e-4}";
  EXPECT_TRUE(share_below(0.95, stable_with("friction.breakaway=9", at_2_kHz), 150));
  EXPECT_TRUE(share_above(0.95, stable_with("controller.sample_rate=20000", at_20_kHz), 150));
}

}  // namespace
}  // namespace zerocount::testing
