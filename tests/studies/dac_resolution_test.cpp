// dac-resolution: what a coarse converter costs, beside the paper's condition Δu < k1·Δx (practical issue 4).
#include <algorithm>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"
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

TEST(DacResolution, UpToTheConditionAllMovesAreStableAndAllJerksComeFromCreep) {
  const study::Study study = shipped_study("dac-resolution");
  for (const char* resolution : {"4.27e-05", "0.000107", "0.000213"}) {
    const auto outcomes = outcomes_of(study, with_step(resolution), dac_trials);
    EXPECT_TRUE(proportion_above(0.96, moves_with(outcomes, [](const auto& move) { return move.stable; }),
                                 dac_trials));
    EXPECT_TRUE(proportion_above(0.86, moves_with(outcomes, reaches_zero_counts), dac_trials));
    const auto jerks = moves_with(outcomes, [](const auto& move) { return move.jerk_count > 0; });
    EXPECT_TRUE(proportion_above(0.3, jerks, dac_trials)) << "otherwise nothing is said of them";
    EXPECT_EQ(jerks, moves_with(outcomes, [](const auto& move) { return move.jerk_agreement == 1.0; }))
        << resolution << ": the way of the holding torque";
  }
}

TEST(DacResolution, ThreeTimesAsCoarseIsStillEnoughBecauseReversalsAreStiff) {
  const auto outcomes = outcomes_of(shipped_study("dac-resolution"), with_step("0.00128"), dac_trials);
  EXPECT_TRUE(proportion_above(0.93, moves_with(outcomes, reaches_zero_counts), dac_trials));
  // What the condition rules out is there: jerks that creep did not make.
  const auto against = [](const auto& move) { return move.jerk_count > 0 && move.jerk_agreement < 1.0; };
  EXPECT_TRUE(proportion_above(0.02, moves_with(outcomes, against), dac_trials));
}

TEST(DacResolution, TenTimesAsCoarseFailsInHalfOfTheMoves) {
  const auto outcomes = outcomes_of(shipped_study("dac-resolution"), with_step("0.00427"), dac_trials);
  EXPECT_TRUE(proportion_below(0.65, moves_with(outcomes, reaches_zero_counts), dac_trials));
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
  EXPECT_TRUE(proportion_above(0.96, successes("2.0e-4"), dac_trials)) << "0.47·k1·Δx";
  EXPECT_TRUE(proportion_below(0.95, successes("4.0e-4"), dac_trials)) << "0.94·k1·Δx: not sufficient";
  EXPECT_TRUE(proportion_below(0.60, successes("8.5e-4"), dac_trials)) << "2·k1·Δx";
}

// encoder-resolution: a finer encoder helps until the converter is too coarse for it, or creep too slow.

constexpr std::int64_t encoder_trials = 150;

std::vector<trial::TrialOutcome> outcomes_with(const std::string& encoder, const std::string& converter) {
  return outcomes_of(shipped_study("encoder-resolution"), encoder + ", dac.resolution=" + converter,
                     encoder_trials);
}

std::int64_t zero_count_moves(const std::vector<trial::TrialOutcome>& outcomes) {
  return moves_with(
      outcomes, [](const trial::MoveOutcome& move) { return move.outcome == trial::Outcome::zero_count; });
}

std::int64_t stable_count(const std::vector<trial::TrialOutcome>& outcomes) {
  return moves_with(outcomes, [](const trial::MoveOutcome& move) { return move.stable; });
}

TEST(EncoderResolution, ThePapersConverterServesAnEncoderUpToFiveTimesAsFine) {
  EXPECT_TRUE(proportion_above(0.93, zero_count_moves(outcomes_with("tenth", "0.00024")), encoder_trials));
  EXPECT_TRUE(
      proportion_above(0.85, zero_count_moves(outcomes_with("five-times", "0.00024")), encoder_trials));
  EXPECT_TRUE(
      proportion_below(0.82, zero_count_moves(outcomes_with("ten-times", "0.00024")), encoder_trials));
}

TEST(EncoderResolution, AFinerConverterKeepsTheLoopStable) {
  EXPECT_TRUE(proportion_below(0.50, stable_count(outcomes_with("ten-times", "0.00024")), encoder_trials));
  EXPECT_TRUE(proportion_above(0.90, stable_count(outcomes_with("ten-times", "2.4e-05")), encoder_trials));
}

// A finer count is crossed by creep more often: without creep, all moves end in zero counts.
TEST(EncoderResolution, CreepIsTheRemainingErrorOfAFineEncoder) {
  EXPECT_TRUE(
      proportion_below(0.80, zero_count_moves(outcomes_with("ten-times", "2.4e-05")), encoder_trials));
  const study::Study study = shipped_study("encoder-resolution", {"friction.alpha=0"});
  EXPECT_TRUE(proportion_above(
      0.95, zero_count_moves(outcomes_of(study, "ten-times, dac.resolution=2.4e-05", encoder_trials)),
      encoder_trials));
}

// sample-rate: a slow loop costs the proportional gain its stability, and the integral alone next to nothing.

constexpr std::int64_t rate_trials = 200;

std::int64_t stable_at_rate(const std::string& label) {
  return moves_with(outcomes_of(shipped_study("sample-rate"), label, rate_trials),
                    [](const trial::MoveOutcome& move) { return move.stable; });
}

TEST(SampleRate, PureIntegralControlIsStableAtTwoAndAHalfTimesTheNaturalFrequency) {
  EXPECT_TRUE(proportion_above(0.96, stable_at_rate("integral, controller.sample_rate=500"), rate_trials));
}

TEST(SampleRate, TheProportionalGainNeedsTenTimesTheNaturalFrequency) {
  EXPECT_TRUE(proportion_below(0.65, stable_at_rate("with-kp, controller.sample_rate=500"), rate_trials));
  EXPECT_TRUE(proportion_below(0.90, stable_at_rate("with-kp, controller.sample_rate=1000"), rate_trials));
  EXPECT_TRUE(proportion_above(0.93, stable_at_rate("with-kp, controller.sample_rate=2000"), rate_trials))
      << "the paper's rate";
  EXPECT_TRUE(proportion_above(0.96, stable_at_rate("with-kp, controller.sample_rate=4000"), rate_trials));
}

// ki·Δx·T/2 and kp·Δx: the loops of all rates are one controller.
TEST(SampleRate, GainsDescribeOneContinuousController) {
  const study::Study study = shipped_study("sample-rate");
  for (const auto& [rate, factor] : {std::pair{"500", 4.0}, {"2000", 1.0}, {"20000", 0.1}}) {
    const trial::TrialParameters p =
        trial_of(study, std::string("with-kp, controller.sample_rate=") + rate, 0);
    EXPECT_NEAR(p.controller.ki / (9.45e-5 * factor), 1.0, 2e-3);
    EXPECT_NEAR(p.controller.kp / 6.21e-4, 1.0, 2e-3);
  }
}

// derivative: a derivative gain adds damping, as criterion (6) says, and chatters at the end of a move, as
// practical issue 5 of the paper warns.

constexpr std::int64_t derivative_trials = 150;

std::int64_t stable_moves(const study::Study& study, const std::string& label) {
  return moves_with(outcomes_of(study, label, derivative_trials),
                    [](const trial::MoveOutcome& move) { return move.stable; });
}

/// All jerks of the first `derivative_trials` trials at the design point with this label.
std::vector<trial::Jerk> jerks_at(const study::Study& study, const std::string& label) {
  std::vector<trial::Jerk> jerks;
  for (std::int64_t index = 0; index < derivative_trials; ++index) {
    const WatchedTrial trial = watched(trial_of(study, label, index));
    jerks.insert(jerks.end(), trial.jerks.begin(), trial.jerks.end());
  }
  return jerks;
}

TEST(Derivative, AddsTheDampingThatCriterion6Requires) {
  const study::Study study = shipped_study("derivative");
  EXPECT_TRUE(proportion_below(0.55, stable_moves(study, "b, controller.kd=0"), derivative_trials));
  EXPECT_TRUE(proportion_above(0.85, stable_moves(study, "b, controller.kd=0.0016"), derivative_trials));
  EXPECT_TRUE(proportion_above(0.95, stable_moves(study, "b, controller.kd=0.0032"), derivative_trials))
      << "(c + kd·T/Δx)·k1/J is above the gain";
}

TEST(Derivative, MakesMoreJerksOfASingleSample) {
  const study::Study study = shipped_study("derivative");
  const std::vector<trial::Jerk> without = jerks_at(study, "a, controller.kd=0");
  const std::vector<trial::Jerk> with = jerks_at(study, "a, controller.kd=0.0008");
  EXPECT_GT(with.size(), 3 * without.size() / 2);
  const auto single = [](const std::vector<trial::Jerk>& jerks) {
    return std::count_if(jerks.begin(), jerks.end(),
                         [](const trial::Jerk& jerk) { return jerk.duration < 0.75e-3; });
  };
  const auto count = [](const std::vector<trial::Jerk>& jerks) {
    return static_cast<std::int64_t>(jerks.size());
  };
  EXPECT_TRUE(proportion_below(0.3, single(without), count(without)));
  EXPECT_TRUE(proportion_above(0.7, single(with), count(with)));
}

TEST(Derivative, ChattersIfItsKickCrossesTheTargetCount) {
  const study::Study study = shipped_study("derivative");
  const auto outcomes = outcomes_of(study, "a, controller.kd=0.0128", derivative_trials);
  EXPECT_TRUE(proportion_below(0.85, moves_with(outcomes, [](const auto& move) { return move.stable; }),
                               derivative_trials));
  const auto chatters = [](const trial::MoveOutcome& move) {
    return move.outcome == trial::Outcome::one_count;
  };
  EXPECT_TRUE(proportion_above(0.3, moves_with(outcomes, chatters), derivative_trials))
      << "by one count, for ever";
}

}  // namespace
}  // namespace zerocount::testing
