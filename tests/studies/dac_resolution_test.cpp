// dac-resolution: what a coarse converter costs, beside the paper's condition Δu < k1·Δx (practical issue 4).
#include <string>

#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t dac_trials = 200;

bool reaches_zero_counts(const trial::MoveOutcome& move) {
  return move.outcome == trial::Outcome::zero_count;
}

std::string with_step(const char* resolution) {
  return std::string("dac.resolution=") + resolution;
}

TEST(DacResolution, UpToTheConditionAllMovesAreStableAndAllJerksAreOfCreep) {
  const study::Study study = shipped_study("dac-resolution");
  for (const char* resolution : {"4.27e-05", "0.000107", "0.000213"}) {
    const auto outcomes = outcomes_of(study, with_step(resolution), dac_trials);
    EXPECT_TRUE(
        share_above(0.96, moves_with(outcomes, [](const auto& move) { return move.stable; }), dac_trials));
    EXPECT_TRUE(share_above(0.86, moves_with(outcomes, reaches_zero_counts), dac_trials));
    const auto jerks = moves_with(outcomes, [](const auto& move) { return move.jerk_count > 0; });
    EXPECT_TRUE(share_above(0.3, jerks, dac_trials)) << "otherwise nothing is said of them";
    EXPECT_EQ(jerks, moves_with(outcomes, [](const auto& move) { return move.jerk_agreement == 1.0; }))
        << resolution << ": the way of the holding torque";
  }
}

TEST(DacResolution, ThreeTimesAsCoarseIsStillEnoughBecauseReversalsAreStiff) {
  const auto outcomes = outcomes_of(shipped_study("dac-resolution"), with_step("0.00128"), dac_trials);
  EXPECT_TRUE(share_above(0.93, moves_with(outcomes, reaches_zero_counts), dac_trials));
  // What the condition rules out is there: jerks that creep did not make.
  const auto against = [](const auto& move) { return move.jerk_count > 0 && move.jerk_agreement < 1.0; };
  EXPECT_TRUE(share_above(0.02, moves_with(outcomes, against), dac_trials));
}

TEST(DacResolution, TenTimesAsCoarseFailsInHalfOfTheMoves) {
  const auto outcomes = outcomes_of(shipped_study("dac-resolution"), with_step("0.00427"), dac_trials);
  EXPECT_TRUE(share_below(0.65, moves_with(outcomes, reaches_zero_counts), dac_trials));
}

// Without a stiff reversal, a step of the torque moves the rotor by Δu/k1, and beyond that by its overshoot.
TEST(DacResolution, OnASpringOfOneStiffnessTheConditionIsNecessary) {
  const auto successes = [](const char* resolution) {
    const study::Study study =
        shipped_study("dac-resolution", {"friction.k1=110", "friction.k2=0", "friction.beta=1.0e+5",
                                         "friction.alpha=0", "controller.ki=1.0e-5", "command.hold=2",
                                         "sweep={}", std::string("dac.resolution=") + resolution});
    return moves_with(outcomes_of(study, "all", dac_trials), reaches_zero_counts);
  };
  EXPECT_TRUE(share_above(0.96, successes("2.0e-4"), dac_trials)) << "0.47·k1·Δx";
  EXPECT_TRUE(share_below(0.95, successes("4.0e-4"), dac_trials)) << "0.94·k1·Δx: not sufficient";
  EXPECT_TRUE(share_below(0.60, successes("8.5e-4"), dac_trials)) << "2·k1·Δx";
}

}  // namespace
}  // namespace zerocount::testing
